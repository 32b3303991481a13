// Compiled for its processors alone (CMakeLists.txt): see kernels.hpp.
#include "retarget/networks/kernels/kernels.hpp"

#if defined(__AVX512F__)

namespace {
constexpr int kLanes = 16, kRows = 8;
}

#include "retarget/networks/kernels/kernels.inl"

namespace understudy::nn {

const Kernels* avx512_kernels() {
  static const Kernels own{"avx512", multiply, layer_norm, softmax, silu};
  return &own;
}

}  // namespace understudy::nn

#else

const understudy::nn::Kernels* understudy::nn::avx512_kernels() {
  return nullptr;
}

#endif
