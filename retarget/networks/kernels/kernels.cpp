#include "retarget/networks/kernels/kernels.hpp"

namespace understudy::nn {

const Kernels& kernels() {
#if defined(__x86_64__)
  const bool narrow = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (narrow && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && avx512_kernels())
    return *avx512_kernels();
  if (narrow && avx2_kernels()) return *avx2_kernels();
#endif
  return plain_kernels();
}

}  // namespace understudy::nn
