// Parts of a training's checkpoint in LibTorch's archives.
#pragma once

#include <torch/torch.h>

#include <string>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"

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

/// Written beside the path, then renamed. Throws Error when it cannot be; nothing is left beside it then.
inline void save_archive(torch::serialize::OutputArchive& archive, const std::string& path) {
  PartFile file(path);
  try {
    archive.save_to(file.part());
  } catch (const c10::Error&) {
    throw Error(path + ": cannot be written");
  }
  file.finish();
}

/// read(archive) takes the parts, which come to `device`, or to the one that they were saved from. Throws
/// Error naming the file when it is no such checkpoint.
template <class Read>
void read_archive(const std::string& path, const c10::optional<torch::Device>& device, Read read) {
  check_file(path);
  try {
    torch::serialize::InputArchive archive;
    archive.load_from(path, device);
    read(archive);
  } catch (const c10::Error&) {
    throw Error(path + ": not a checkpoint of this network's training");
  }
}

/// How far a training has come.
struct TrainingProgress {
  int64_t step = 0, samples = 0;
  double seconds = 0;  ///< spent so far, over all runs
};

/// A network, the running mean of its weights, their optimizer, and how far it has come.
template <class Net, class Optimizer>
void put_training(torch::serialize::OutputArchive& archive, const Net& net, const Net& average,
                  const Optimizer& optimizer, const TrainingProgress& progress) {
  put(archive, "net", net);
  put(archive, "average", average);
  put(archive, "optimizer", optimizer);
  archive.write("progress", torch::tensor({static_cast<double>(progress.step),
                                           static_cast<double>(progress.samples), progress.seconds},
                                          torch::kFloat64));
}

template <class Net, class Optimizer>
TrainingProgress take_training(torch::serialize::InputArchive& archive, Net& net, Net& average,
                               Optimizer& optimizer) {
  take(archive, "net", net);
  take(archive, "average", average);
  take(archive, "optimizer", optimizer);
  const torch::Tensor numbers = number_from(archive, "progress");
  TORCH_CHECK(numbers.numel() == 3 && numbers.scalar_type() == torch::kFloat64);
  const auto* n = numbers.data_ptr<double>();
  return {static_cast<int64_t>(n[0]), static_cast<int64_t>(n[1]), n[2]};
}

}  // namespace understudy::training
