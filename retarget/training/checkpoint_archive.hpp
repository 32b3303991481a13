// Parts of a training's checkpoint in LibTorch's archives.
#pragma once

#include <torch/torch.h>

#include <cstdio>
#include <string>

#include "retarget/base/error.hpp"

namespace understudy::training {

/// A module or an optimizer under a name.
template <class Part>
void put(torch::serialize::OutputArchive& archive, const char* key, const Part& part) {
  torch::serialize::OutputArchive inner;
  part.save(inner);
  archive.write(key, inner);
}

template <class Part>
void take(torch::serialize::InputArchive& archive, const char* key, Part& part) {
  torch::serialize::InputArchive inner;
  archive.read(key, inner);
  part.load(inner);
}

inline torch::Tensor number(double value) {
  return torch::full({1}, value, torch::kFloat64);
}

inline torch::Tensor number_from(torch::serialize::InputArchive& archive, const char* key) {
  torch::Tensor value;
  archive.read(key, value);
  return value;
}

/// Written beside the path, then renamed. Throws Error when it cannot be.
inline void save_archive(torch::serialize::OutputArchive& archive, const std::string& path) {
  const std::string part = path + ".part";
  try {
    archive.save_to(part);
  } catch (const c10::Error&) {
    throw Error(path + ": the checkpoint cannot be written");
  }
  US_CHECK(std::rename(part.c_str(), path.c_str()) == 0, path, ": the checkpoint cannot be written");
}

}  // namespace understudy::training
