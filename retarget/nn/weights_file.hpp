// Trained weights on disk: named tensors and a header.
#pragma once

#include <torch/torch.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace understudy::nn {

/// A weights file's header.
struct WeightsHeader {
  std::string kind;                            ///< "skeleton", "part", "motion" or "deformation"
  int version = 0;                             ///< of the network's form; another version is refused
  std::map<std::string, double> numbers;       ///< sizes and training figures
  std::map<std::string, std::string> texts{};  ///< "licence", "attribution" ...
  std::vector<std::string> lacking{};  ///< of a file that was loaded: tensors that it has not, and may lack
};

/// Writes the module's parameters and buffers as float16 (half = true) or float32, beside the path, then
/// renamed.
void save_weights(const std::string& path, const WeightsHeader& header, const torch::nn::Module& module,
                  bool half = true);
/// Only the header. Throws Error when the file is missing, damaged, or no weights file.
WeightsHeader read_weights_header(const std::string& path);
/// A size of the network from the header of `path`, or `usual` where the header has none. Throws Error naming
/// the file when it is no whole number from 1 to `most`.
int64_t header_size(const std::string& path, const WeightsHeader& header, const char* key, int64_t usual,
                    int64_t most);
using TensorCheck = std::function<bool(const std::string& name)>;
/// Fills the module. Throws Error naming the file when kind or version differ, or a tensor is missing or of
/// another shape. Tensors of which `may_lack` says so may be missing, as files from before they existed lack
/// them: they stay as they are, and the header names them.
WeightsHeader load_weights(const std::string& path, const std::string& kind, int version,
                           torch::nn::Module& module, const TensorCheck& may_lack = {});

}  // namespace understudy::nn
