// Parts of a training's checkpoint in LibTorch's archives.
#pragma once

#include <torch/torch.h>

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

/// The state of a random number generator, by whose number the next batch is made.
inline void put_random(torch::serialize::OutputArchive& archive, uint64_t state) {
  archive.write("random", torch::tensor(static_cast<int64_t>(state), torch::kLong));
}

inline uint64_t take_random(torch::serialize::InputArchive& archive) {
  torch::Tensor state;
  archive.read("random", state);
  return static_cast<uint64_t>(state.item<int64_t>());
}

}  // namespace understudy::training
