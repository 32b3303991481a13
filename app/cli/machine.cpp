#include "app/cli/machine.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

/// A line "Key:  1234 kB" of /proc/self/status, in MB.
double status_mb(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (starts_with(line, key)) return std::stod(line.substr(key.size() + 1)) * 1024 / 1e6;
  return 0;
}

}  // namespace

double resident_mb() {
  return status_mb("VmRSS");
}
double peak_resident_mb() {
  return status_mb("VmHWM");
}

double seconds_since_start() {
  std::ifstream stat("/proc/self/stat"), uptime("/proc/uptime");
  std::string text;
  std::getline(stat, text);
  // The name in brackets may hold blanks; starttime is the 20th field after it, in clock ticks since boot.
  std::istringstream fields(text.substr(std::min(text.rfind(')') + 1, text.size())));
  std::string field;
  for (int i = 0; i < 20; ++i) fields >> field;
  double now = 0;
  if (field.empty() || !(uptime >> now)) return 0;
  return now - std::stod(field) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string name = "unknown processor";
  for (std::string line; std::getline(info, line);)
    if (starts_with(line, "model name")) {
      name = line.substr(line.find(':') + 2);
      break;
    }
  return name + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads";
}

double gemm_gflops() {
  using Sgemm =
      void (*)(const char*, const char*, const int*, const int*, const int*, const float*, const float*,
               const int*, const float*, const int*, const float*, float*, const int*);
  void* blas = dlopen("libblas.so.3", RTLD_NOW);
  const auto sgemm = blas ? reinterpret_cast<Sgemm>(dlsym(blas, "sgemm_")) : nullptr;
  if (!sgemm) return 0;
  constexpr int n = 768;
  const float one = 1, zero = 0;
  const std::vector<float> a(n * n, 0.5f), b(n * n, 0.25f);
  std::vector<float> c(n * n);
  double best = 1e9;
  const auto began = std::chrono::steady_clock::now();
  const auto seconds = [](auto from) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  };
  while (seconds(began) < 1.0) {
    const auto start = std::chrono::steady_clock::now();
    sgemm("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n);
    best = std::min(best, seconds(start));
  }
  return 2.0 * n * n * n / best / 1e9;
}

}  // namespace understudy::app
