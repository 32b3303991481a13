#include "retarget/base/numpy_random.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace understudy {
namespace {

using Wide = unsigned __int128;

Wide wide(uint64_t high, uint64_t low) {
  return (static_cast<Wide>(high) << 64) | low;
}

const Wide kMultiplier = wide(2549297995355413924ull, 4865540595714422341ull);

/// SeedSequence(seed).generate_state(4, uint64): O'Neill's seed_seq over a pool of four words.
std::array<uint64_t, 4> seed_words(uint32_t seed) {
  uint32_t hash = 0x43b0d7e5u;
  const auto hashed = [&hash](uint32_t value) {
    value ^= hash;
    hash *= 0x931e8875u;
    value *= hash;
    return value ^ (value >> 16);
  };
  const auto mixed = [](uint32_t x, uint32_t y) {
    const uint32_t z = x * 0xca01f9ddu - y * 0x4973f715u;
    return z ^ (z >> 16);
  };
  std::array<uint32_t, 4> pool;
  for (int i = 0; i < 4; ++i) pool[i] = hashed(i == 0 ? seed : 0);
  for (int from = 0; from < 4; ++from)
    for (int to = 0; to < 4; ++to)
      if (from != to) pool[to] = mixed(pool[to], hashed(pool[from]));

  std::array<uint32_t, 8> words;
  uint32_t state = 0x8b51f9ddu;
  for (int i = 0; i < 8; ++i) {
    uint32_t value = pool[i % 4] ^ state;
    state *= 0x58f38dedu;
    value *= state;
    words[i] = value ^ (value >> 16);
  }
  std::array<uint64_t, 4> result;
  for (int i = 0; i < 4; ++i) result[i] = words[2 * i] | (static_cast<uint64_t>(words[2 * i + 1]) << 32);
  return result;
}

/// The layers of the normal distribution's ziggurat (Marsaglia and Tsang 2000) for 52-bit numbers.
struct Ziggurat {
  static constexpr double kEdge = 3.6541528853610087963519472518;
  static constexpr double kScale = 4503599627370496.0;  // 2^52
  std::array<uint64_t, 256> inside;                     // a number below this is surely under the curve
  std::array<double, 256> width, height;

  Ziggurat() {
    double x = kEdge, before = x;
    const double area =
        x * std::exp(-0.5 * x * x) + std::sqrt(std::acos(0.0)) * std::erfc(x / std::sqrt(2.0));
    const double base = area / std::exp(-0.5 * x * x);
    inside[0] = static_cast<uint64_t>(x / base * kScale);
    inside[1] = 0;
    width[0] = base / kScale;
    width[255] = x / kScale;
    height[0] = 1;
    height[255] = std::exp(-0.5 * x * x);
    for (int i = 254; i >= 1; --i) {
      x = std::sqrt(-2 * std::log(area / x + std::exp(-0.5 * x * x)));
      inside[i + 1] = static_cast<uint64_t>(x / before * kScale);
      before = x;
      height[i] = std::exp(-0.5 * x * x);
      width[i] = x / kScale;
    }
  }
};

}  // namespace

NumpyRandom::NumpyRandom(uint32_t seed) {
  const auto words = seed_words(seed);
  increment_ = (wide(words[2], words[3]) << 1) | 1;
  state_ = increment_;  // one step from 0
  state_ += wide(words[0], words[1]);
  state_ = state_ * kMultiplier + increment_;
}

uint64_t NumpyRandom::next64() {
  state_ = state_ * kMultiplier + increment_;
  const uint64_t folded = static_cast<uint64_t>(state_ >> 64) ^ static_cast<uint64_t>(state_);
  const int turn = static_cast<int>(state_ >> 122);
  return (folded >> turn) | (folded << ((64 - turn) & 63));
}

uint32_t NumpyRandom::next32() {
  if (has_half_) {
    has_half_ = false;
    return half_;
  }
  const uint64_t drawn = next64();
  has_half_ = true;
  half_ = static_cast<uint32_t>(drawn >> 32);
  return static_cast<uint32_t>(drawn);
}

double NumpyRandom::random() {
  return static_cast<double>(next64() >> 11) * (1.0 / 9007199254740992.0);
}

double NumpyRandom::normal() {
  static const Ziggurat table;
  while (true) {
    uint64_t drawn = next64();
    const size_t layer = drawn & 0xff;
    drawn >>= 8;
    const uint64_t size = (drawn >> 1) & 0x000fffffffffffffull;
    const double x = (drawn & 1 ? -1.0 : 1.0) * static_cast<double>(size) * table.width[layer];
    if (size < table.inside[layer]) return x;
    if (layer == 0) {
      while (true) {
        const double tail = -std::log1p(-random()) / Ziggurat::kEdge, under = -std::log1p(-random());
        if (under + under <= tail * tail) continue;
        return (size >> 8) & 1 ? -(Ziggurat::kEdge + tail) : Ziggurat::kEdge + tail;
      }
    }
    const double above = table.height[layer - 1] - table.height[layer];
    if (above * random() + table.height[layer] < std::exp(-0.5 * x * x)) return x;
  }
}

uint32_t NumpyRandom::bounded(uint32_t last) {
  if (last == 0) return 0;
  const uint32_t count = last + 1;
  uint64_t product = static_cast<uint64_t>(next32()) * count;
  if (static_cast<uint32_t>(product) < count) {
    const uint32_t threshold = (0xffffffffu - last) % count;
    while (static_cast<uint32_t>(product) < threshold) product = static_cast<uint64_t>(next32()) * count;
  }
  return static_cast<uint32_t>(product >> 32);
}

int64_t NumpyRandom::integers(int64_t low, int64_t high) {
  return low + bounded(static_cast<uint32_t>(high - low - 1));
}

std::vector<int64_t> NumpyRandom::permutation(int64_t count) {
  std::vector<int64_t> order(count);
  for (int64_t i = 0; i < count; ++i) order[i] = i;
  uint32_t mask = 0;
  while (mask < count - 1) mask = mask << 1 | 1;
  for (int64_t i = count - 1; i > 0; --i) {
    while ((mask >> 1) >= i) mask >>= 1;
    uint32_t drawn = next32() & mask;
    while (drawn > i) drawn = next32() & mask;
    std::swap(order[i], order[drawn]);
  }
  return order;
}

}  // namespace understudy
