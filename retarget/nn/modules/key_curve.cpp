#include "retarget/nn/modules/key_curve.hpp"

#include <array>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy::nn {
namespace {

/// Of each frame the key before the last one, the last one, the next one, the one after it: their numbers, or
/// -1.
struct KeysAboutFrames {
  explicit KeysAboutFrames(const torch::Tensor& known) {
    const int64_t batch = known.size(0), frames = known.size(1);
    for (auto& one : numbers) one = torch::full({batch, frames}, -1, torch::kLong);
    const auto is_known = known.accessor<bool, 2>();
    for (int64_t b = 0; b < batch; ++b) {
      std::vector<int64_t> keys;
      for (int64_t t = 0; t < frames; ++t)
        if (is_known[b][t]) keys.push_back(t);
      US_CHECK(!keys.empty() && keys.front() == 0, "the first frame is not known");
      const auto key = [&](int64_t k) {
        return k >= 0 && k < ssize(keys) ? keys[static_cast<size_t>(k)] : -1;
      };
      for (int64_t t = 0, next = 0; t < frames; ++t) {
        while (next < ssize(keys) && key(next) < t) ++next;
        for (int i = 0; i < 4; ++i) numbers[static_cast<size_t>(i)][b][t] = key(next - 2 + i);
      }
    }
  }
  std::array<torch::Tensor, 4> numbers;
};

}  // namespace

KeyCurve curve_through(const torch::Tensor& way, const torch::Tensor& known) {
  const KeysAboutFrames keys(known);
  const auto at = [&](int i) {
    const auto index = keys.numbers[static_cast<size_t>(i)].clamp_min(0).to(way.device());
    return way.gather(1, index.unsqueeze(-1).expand_as(way));
  };
  const auto frame = [&](int i) {
    return keys.numbers[static_cast<size_t>(i)].to(way.device(), way.scalar_type()).unsqueeze(-1);
  };
  const auto t = torch::arange(way.size(1), way.options()).view({1, -1, 1});
  const auto p = at(0), a = at(1), b = at(2), q = at(3);
  const auto has_p = frame(0) >= 0, has_a = frame(1) >= 0, has_b = frame(2) >= 0, has_q = frame(3) >= 0;
  const auto gap = (frame(2) - frame(1)).clamp_min(1), before = (frame(1) - frame(0)).clamp_min(1),
             after = (frame(3) - frame(2)).clamp_min(1);
  const auto chord = (b - a) / gap;  // a frame
  const auto parabola = [&](const torch::Tensor& next, const torch::Tensor& far) {
    return (next * gap + chord * far) / (gap + far);
  };
  auto from = parabola((a - p) / before, before), to = parabola((q - b) / after, after);
  const auto end_from = torch::where(has_q, 1.5 * chord - 0.5 * to, chord);
  const auto end_to = torch::where(has_p, 1.5 * chord - 0.5 * from, chord);
  from = torch::where(has_p, from, end_from);
  to = torch::where(has_q, to, end_to);
  const auto s = (t - frame(1)) / gap, u = 1 - s;
  const auto cubic =
      a * (u * u * (1 + 2 * s)) + b * (s * s * (3 - 2 * s)) + gap * (from * (s * u * u) - to * (s * s * u));
  return {torch::where(has_b, torch::where(has_a, cubic, b), a),
          torch::where(has_b, frame(2) - t, torch::full_like(t, -1))};
}

}  // namespace understudy::nn
