// What this machine has and what this process takes of it.
#pragma once

#include <string>

namespace understudy::app {

/// Memory of this process now and at its highest, MB (10^6 bytes). 0 where the system does not report it.
double resident_mb();
double peak_resident_mb();

/// Seconds since this process was started.
double seconds_since_start();

/// The processor's name, "Intel Xeon ..., 2 threads".
std::string processor();

/// The best rate of a large single-precision matrix product on the BLAS that the networks use, GFLOP/s; 0
/// when no BLAS can be loaded. Takes about a second.
double gemm_gflops();

}  // namespace understudy::app
