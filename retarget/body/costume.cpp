#include "retarget/body/costume.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/body/cell_image.hpp"
#include "retarget/math/directions.hpp"

namespace understudy {
namespace {

constexpr int kRings = 12, kWays = 24;
constexpr float kTurn = 2 * kPi;
constexpr float kUnder = 0.01f;  // what pokes out of a skirt by so much is still under it, metres

Vec3 at(const PosedSkeleton& truth, int joint) {
  return truth.joints.row(joint).transpose();
}

bool is_under_skirt(int part) {
  return part == Pelvis || part == LeftHip || part == RightHip || part == LeftKnee || part == RightKnee ||
         part == LeftAnkle || part == RightAnkle;
}

/// Rings about an axis from the pelvis down the mean of the thighs.
class Skirt {
 public:
  Skirt(const LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng);
  bool fits() const { return fits_; }
  /// 0 at the waist, 1 at the hem.
  float down(const Vec3& x) const { return ((x - top_).dot(axis_)) / length_; }
  bool hides(const Vec3& x) const;
  void sample(LabelledPoints& cloud, const PosedSkeleton& truth, float per_square_metre, Rng& rng) const;

 private:
  float radius(float down, float turn) const;
  float turn_of(const Vec3& x) const { return std::atan2((x - top_).dot(side_), (x - top_).dot(front_)); }

  bool fits_ = false;
  Vec3 top_, axis_, front_, side_;
  float length_ = 0, fold_depth_ = 0, folds_ = 0, phase_ = 0;
  std::array<std::array<float, kWays>, kRings> reach_{};
};

Skirt::Skirt(const LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng) {
  const float leg = leg_length(truth.joints);
  const Vec3 knees = 0.5f * (at(truth, LeftKnee) + at(truth, RightKnee)), hips = at(truth, Pelvis);
  fits_ = (knees - hips).norm() > 0.38f * leg;
  if (!fits_) return;
  axis_ = (knees - hips).normalized();
  side_ = (at(truth, LeftHip) - at(truth, RightHip)).normalized();
  side_ = (side_ - side_.dot(axis_) * axis_).normalized();
  front_ = side_.cross(axis_);
  top_ = hips - rng.uniform(0.05f, 0.2f) * leg * axis_;
  length_ = leg * rng.uniform(0.5f, 1.25f);
  fold_depth_ = rng.chance(0.5f) ? rng.uniform(0.0f, 0.1f) : 0.0f;
  folds_ = static_cast<float>(4 + rng.below(10));
  phase_ = rng.uniform(0, kTurn);
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const Vec3 x = cloud.points.row(i);
    const float d = down(x);
    if (d < 0 || d >= 1 || !is_under_skirt(cloud.parts[i])) continue;
    auto& ring = reach_[d * kRings];
    for (size_t k = 0; k < kWays; ++k) {
      const float turn = kTurn * static_cast<float>(k) / kWays;
      ring[k] = std::max(ring[k], (x - top_).dot(std::cos(turn) * front_ + std::sin(turn) * side_));
    }
  }
  const float margin = rng.uniform(0.004f, 0.02f), wider = rng.uniform(0.0f, 0.45f) * length_ / kRings;
  for (size_t r = 0; r < kRings; ++r)
    for (size_t k = 0; k < kWays; ++k)
      reach_[r][k] = std::max(reach_[r][k] + margin, r > 0 ? reach_[r - 1][k] + wider : 0.05f * leg);
}

float Skirt::radius(float down, float turn) const {
  const float direction = (turn < 0 ? turn + kTurn : turn) / kTurn * kWays;
  const float height = std::clamp(down * kRings - 0.5f, 0.0f, kRings - 1.001f);
  const auto k = static_cast<size_t>(direction) % kWays, r = static_cast<size_t>(height);
  const float share = direction - std::floor(direction), lower = height - std::floor(height);
  const auto of_ring = [&](const auto& ring) {
    return (1 - share) * ring[k] + share * ring[(k + 1) % kWays];
  };
  const float even = (1 - lower) * of_ring(reach_[r]) + lower * of_ring(reach_[r + 1]);
  return even * (1 + fold_depth_ * down * (1 + std::cos(folds_ * turn + phase_)));
}

bool Skirt::hides(const Vec3& x) const {
  const float d = down(x);
  if (d < 0 || d > 1) return false;
  const Vec3 direction = x - top_;
  return (direction - direction.dot(axis_) * axis_).norm() < radius(d, turn_of(x)) + kUnder;
}

void Skirt::sample(LabelledPoints& cloud, const PosedSkeleton& truth, float per_square_metre,
                   Rng& rng) const {
  float widest = 0;
  for (size_t k = 0; k < kWays; ++k) widest = std::max(widest, reach_[kRings - 1][k] * (1 + 2 * fold_depth_));
  const int tries = static_cast<int>(per_square_metre * kTurn * widest * length_);
  std::vector<Vec3> points;
  for (int i = 0; i < tries; ++i) {
    const float d = rng.uniform(), turn = rng.uniform(-kPi, kPi), r = radius(d, turn);
    if (!rng.chance(r / widest)) continue;
    points.push_back(top_ + d * length_ * axis_ + r * (std::cos(turn) * front_ + std::sin(turn) * side_));
  }
  std::vector<int> parts = nearest_parts(rows_of(points), truth.joints);
  for (int& part : parts)
    if (!is_under_skirt(part)) part = Pelvis;
  append(cloud, points, parts);
}

bool is_coated(int part) {
  return part == Spine1 || part == Spine2 || part == Spine3 || part == LeftCollar || part == RightCollar ||
         part == LeftShoulder || part == RightShoulder || part == LeftElbow || part == RightElbow;
}

/// Points on a ball, drawn out along the columns of `axes`, as densely as on a round one of that volume.
void add_ball(std::vector<Vec3>& points, const Vec3& centre, const Mat3& axes, float per_square_metre,
              Rng& rng) {
  const float radius = std::cbrt(std::abs(axes.determinant()));
  const int count = static_cast<int>(per_square_metre * 2 * kTurn * radius * radius);
  for (int i = 0; i < count; ++i) points.push_back(centre + axes * random_direction(rng));
}

void add_stick(std::vector<Vec3>& points, const Vec3& through, const Vec3& direction, float per_square_metre,
               Rng& rng) {
  const float length = rng.uniform(0.15f, 1.4f), thickness = rng.uniform(0.008f, 0.04f);
  const Vec3 across = direction.unitOrthogonal(), other = direction.cross(across);
  const Vec3 from = through - rng.uniform(0.1f, 0.9f) * length * direction;
  const int count = static_cast<int>(per_square_metre * kTurn * thickness * length);
  for (int i = 0; i < count; ++i) {
    const float turn = rng.uniform(0, kTurn);
    points.push_back(from + rng.uniform() * length * direction +
                     thickness * (std::cos(turn) * across + std::sin(turn) * other));
  }
}

// Of the image in which the nearest hides what is behind it, and how much deeper still counts as the same
// surface: parts of leg length.
constexpr float kCell = 0.035f, kDepth = 0.06f;
constexpr size_t kLeast = 256;

}  // namespace

void wear_skirt(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng) {
  const float per_square_metre = density(cloud, truth);
  const Skirt skirt(cloud, truth, rng);
  if (!skirt.fits()) return;
  keep_where(cloud,
             [&](int i) { return !is_under_skirt(cloud.parts[i]) || !skirt.hides(cloud.points.row(i)); });
  skirt.sample(cloud, truth, per_square_metre, rng);
}

void wear_coat(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng) {
  const float thick = rng.uniform(0.01f, 0.06f);
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const int part = cloud.parts[i];
    if (!is_coated(part)) continue;
    const Vec3 x = cloud.points.row(i), from = at(truth, part);
    // Away from the bone, which leads along the T-pose's x in arms and y in the trunk.
    const bool is_arm = part >= LeftCollar;
    const Vec3 bone = truth.global[part].col(is_arm ? 0 : 1);
    const Vec3 direction = (x - from) - (x - from).dot(bone) * bone;
    if (direction.norm() > 1e-4f) cloud.points.row(i) += (thick * direction.normalized()).transpose();
  }
}

void wear_hair(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng) {
  const float size = leg_length(truth.joints) / 0.85f;
  const Mat3& head = truth.global[Head];
  std::vector<Vec3> points;
  if (rng.chance(0.5f)) {
    const Vec3 bun(rng.uniform(-0.02f, 0.02f), rng.uniform(0.05f, 0.22f), rng.uniform(-0.15f, -0.05f));
    const float radius = size * rng.uniform(0.03f, 0.065f);
    add_ball(points, at(truth, Head) + size * (head * bun), radius * Mat3::Identity(), density(cloud, truth),
             rng);
  } else {
    const Vec3 centre = at(truth, Head) + size * (head * Vec3(0, rng.uniform(0.06f, 0.12f), -0.02f));
    const Vec3 axes =
        size * Vec3(rng.uniform(0.09f, 0.16f), rng.uniform(0.12f, 0.2f), rng.uniform(0.1f, 0.16f));
    add_ball(points, centre, head * axes.asDiagonal(), density(cloud, truth), rng);
    const auto in_face = [&](const Vec3& x) {
      const Vec3 own = head.transpose() * (x - centre);
      return own.z() > 0.35f * axes.z() && own.y() < 0.5f * axes.y();
    };
    points.erase(std::remove_if(points.begin(), points.end(), in_face), points.end());
    keep_where(cloud, [&](int i) {
      const Vec3 x = cloud.points.row(i), own = (head.transpose() * (x - centre)).cwiseQuotient(axes);
      return cloud.parts[i] != Head || in_face(x) || own.norm() > 1;
    });
  }
  append(cloud, points, std::vector<int>(points.size(), Head));
}

void hold_thing(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng) {
  const bool left = rng.chance(0.5f);
  const int wrist = left ? LeftWrist : RightWrist;
  const Mat3& hand = truth.global[wrist];
  const float size = leg_length(truth.joints) / 0.85f;
  const Vec3 palm = at(truth, wrist) + size * hand * Vec3(left ? 0.08f : -0.08f, -0.02f, 0);
  std::vector<Vec3> points;
  if (rng.chance(0.65f)) {
    const Vec3 direction = (hand * Vec3(0.6f * rng.normal(), 0.6f * rng.normal(), 1)).normalized();
    add_stick(points, palm, direction, density(cloud, truth), rng);
  } else {
    const float radius = rng.uniform(0.04f, 0.16f);
    add_ball(points, palm - radius * hand.col(1), radius * Mat3::Identity(), density(cloud, truth), rng);
  }
  append(cloud, points, std::vector<int>(points.size(), kNoBody));
}

void see_from_one_side(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng) {
  const float leg = leg_length(truth.joints), turn = rng.uniform(-kPi, kPi), rise = rng.uniform(-0.2f, 0.6f);
  const Vec3 from(std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn));
  const Vec3 right = from.unitOrthogonal(), up = from.cross(right);
  const float cell = kCell * leg;
  Points image(cloud.points.rows(), 3);
  for (Eigen::Index i = 0; i < image.rows(); ++i) {
    const Vec3 x = cloud.points.row(i);
    image.row(i) << x.dot(right) / cell, x.dot(up) / cell, x.dot(from);
  }
  const CellImage seen(image);
  std::vector<int> kept;
  for (int i = 0; i < image.rows(); ++i)
    if (seen.shows(i, kDepth * leg)) kept.push_back(i);
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
