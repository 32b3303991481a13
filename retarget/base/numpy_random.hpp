// The random numbers of NumPy's default generator: the same seed gives the same draws.
#pragma once

#include <cstdint>
#include <vector>

namespace understudy {

/// numpy.random.default_rng(seed): PCG64 (O'Neill 2014, XSL-RR 128/64) seeded through SeedSequence, with
/// NumPy's own ways to draw (Lemire's bounded integers, the ziggurat of 256 layers). Draws are bit for bit
/// NumPy 1.24's but for the last digit of a normal number in a hundred.
class NumpyRandom {
 public:
  explicit NumpyRandom(uint32_t seed);
  /// In [0, 1): random().
  double random();
  double uniform(double low, double high) { return low + (high - low) * random(); }
  /// Standard normal: normal().
  double normal();
  /// In low .. high - 1; low < high: integers(low, high).
  int64_t integers(int64_t low, int64_t high);
  /// 0 .. count - 1 in random order: permutation(count).
  std::vector<int64_t> permutation(int64_t count);

 private:
  uint64_t next64();
  uint32_t next32();
  uint32_t bounded(uint32_t last);

  unsigned __int128 state_ = 0, increment_ = 0;
  bool has_half_ = false;
  uint32_t half_ = 0;  // of the last next64() that next32() asked for
};

}  // namespace understudy
