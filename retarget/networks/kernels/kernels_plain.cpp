// Compiled for any processor: see kernels.hpp.
#include "retarget/networks/kernels/kernels.hpp"

namespace {
constexpr int kLanes = 4, kRows = 4;
}

#include "retarget/networks/kernels/kernels.inl"

namespace understudy::nn {

const Kernels& plain_kernels() {
  static const Kernels own{"plain", multiply, layer_norm, softmax, silu};
  return own;
}

}  // namespace understudy::nn
