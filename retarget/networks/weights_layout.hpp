// The file format of trained weights, read without LibTorch.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace understudy::nn {

inline constexpr char kWeightsMagic[] = "USWEIGHT";

/// A tensor in the file.
struct StoredTensor {
  std::vector<int64_t> shape;
  bool half = false;       ///< two bytes a number, else four
  std::string_view bytes;  ///< exactly as many as the shape needs
};

/// "USWEIGHT", uint32 length of the JSON, the JSON (kind, version, numbers, texts, tensors: name, shape,
/// half, offset), then the tensors' bytes, little-endian.
struct StoredWeights {
  std::string kind;
  int version = 0;
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> texts;  ///< "licence", "attribution" ...; files from before have none
  std::map<std::string, StoredTensor> tensors;
};

/// The tensors point into `file`. Throws Error naming the path when it is no weights file, cut off or
/// damaged.
StoredWeights parse_weights(std::string_view file, const std::string& path);

}  // namespace understudy::nn
