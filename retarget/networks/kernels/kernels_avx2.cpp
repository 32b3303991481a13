// Compiled for its processors alone (CMakeLists.txt): see kernels.hpp.
#include "retarget/networks/kernels/kernels.hpp"

#if defined(__AVX2__)

namespace {
constexpr int kLanes = 8, kRows = 4;
}

#include "retarget/networks/kernels/kernels.inl"

namespace understudy::nn {

const Kernels* avx2_kernels() {
  static const Kernels own{"avx2", multiply, layer_norm, softmax, silu};
  return &own;
}

}  // namespace understudy::nn

#else

const understudy::nn::Kernels* understudy::nn::avx2_kernels() {
  return nullptr;
}

#endif
