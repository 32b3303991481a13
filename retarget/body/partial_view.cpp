#include "retarget/body/partial_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace understudy {
namespace {

// Of the image in which the nearest hides what is behind it, and how much deeper still counts as the same
// surface: parts of leg length.
constexpr float kCell = 0.035f, kDepth = 0.06f;
constexpr size_t kLeast = 256;

}  // namespace

void see_from_one_side(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng) {
  const float leg = leg_length(truth.joints), turn = rng.uniform(-kPi, kPi), rise = rng.uniform(-0.2f, 0.6f);
  const Vec3 from(std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn));
  const Vec3 right = from.unitOrthogonal(), up = from.cross(right);
  using Cell = std::pair<int, int>;
  std::map<Cell, float> nearest;
  const auto cell_of = [&](const Vec3& x) {
    return Cell{static_cast<int>(std::floor(x.dot(right) / (kCell * leg))),
                static_cast<int>(std::floor(x.dot(up) / (kCell * leg)))};
  };
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const Vec3 x = cloud.points.row(i);
    const auto [at, is_new] = nearest.emplace(cell_of(x), x.dot(from));
    if (!is_new) at->second = std::max(at->second, x.dot(from));
  }
  std::vector<int> kept;
  for (int i = 0; i < cloud.points.rows(); ++i) {
    const Vec3 x = cloud.points.row(i);
    const Cell cell = cell_of(x);
    float hidden_behind = nearest[cell];
    for (const Cell& beside : {Cell{-1, 0}, Cell{1, 0}, Cell{0, -1}, Cell{0, 1}}) {
      const auto at = nearest.find({cell.first + beside.first, cell.second + beside.second});
      if (at != nearest.end()) hidden_behind = std::max(hidden_behind, at->second - 0.5f * kDepth * leg);
    }
    if (x.dot(from) > hidden_behind - kDepth * leg) kept.push_back(i);
  }
  if (kept.size() >= kLeast) keep_rows(cloud, kept);
}

void lose_limb(LabelledPoints& cloud, Rng& rng) {
  constexpr std::array<int, 8> kFirst = {LeftElbow, RightElbow, LeftWrist, RightWrist,
                                         LeftKnee,  RightKnee,  LeftAnkle, RightAnkle};
  std::array<bool, kJointCount + 1> lost{};
  lost[kFirst[rng.below(kFirst.size())]] = true;
  for (size_t j = 1; j < kJointCount; ++j) lost[j] = lost[j] || lost[kParents[j]];
  std::vector<int> kept;
  for (size_t i = 0; i < cloud.parts.size(); ++i)
    if (!lost[cloud.parts[i]]) kept.push_back(i);
  if (kept.size() >= kLeast) keep_rows(cloud, kept);
}

}  // namespace understudy
