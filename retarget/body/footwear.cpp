#include "retarget/body/footwear.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kFootLength = 0.25f;  // metres, that shoe options are for
constexpr float kWall = 0.03f;        // height in which a sole's side is stretched
constexpr float kHeelShare = 0.3f;    // of the foot's length, that a heel is under

/// 0 below `low`, 1 above `high`, smooth between.
float risen(float x, float low, float high) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

float follows_foot(const RowMatrix& weights, Eigen::Index row, int side) {
  return weights(row, LeftAnkle + side) + weights(row, LeftFoot + side);
}

}  // namespace

ShoeOptions random_shoe(Rng& rng) {
  ShoeOptions shoe;
  shoe.corner = rng.uniform(2.0f, 5.0f);
  if (rng.chance(0.15f)) {  // socks
    shoe.sole = rng.uniform(0.001f, 0.004f);
    shoe.upper = rng.uniform(0.001f, 0.003f);
    shoe.longer = shoe.pointed = 0;
    return shoe;
  }
  shoe.sole = rng.uniform(0.006f, 0.03f) + (rng.chance(0.2f) ? rng.uniform(0, 0.015f) : 0.0f);
  shoe.upper = rng.uniform(0.002f, 0.01f);
  shoe.longer = rng.uniform(0, 0.03f);
  shoe.pointed = rng.uniform(0, 0.3f);
  if (rng.chance(0.25f)) {
    shoe.pointed = rng.uniform(0.4f, 0.85f);
    shoe.longer += rng.uniform(0, 0.025f);
  } else if (rng.chance(0.5f)) {
    shoe.toe_height = rng.uniform(0.03f, 0.055f);
  }
  const float heeled = rng.uniform();
  shoe.heel = heeled < 0.45f ? 0.0f : heeled < 0.8f ? rng.uniform(0, 0.03f) : rng.uniform(0.03f, 0.08f);
  shoe.wedge = rng.chance(0.4f);
  shoe.heel_width = shoe.heel > 0.03f ? rng.uniform(0.2f, 1.0f) : 1.0f;
  if (rng.chance(0.3f)) shoe.shaft = rng.uniform(0.1f, 0.55f);
  shoe.shaft_width = rng.uniform(0.004f, 0.025f);
  return shoe;
}

Shoes::Slice Shoes::Foot::slice(float along) const {
  const float at =
      std::clamp((along - heel) / (tip - heel) * kSlices - 0.5f, 0.0f, static_cast<float>(kSlices - 1));
  const auto k = std::min(static_cast<size_t>(at), slices.size() - 2);
  const float share = at - static_cast<float>(k);
  const auto mixed = [&](float Slice::*what) {
    return (1 - share) * slices[k].*what + share * slices[k + 1].*what;
  };
  return {mixed(&Slice::middle), mixed(&Slice::half_width), mixed(&Slice::height)};
}

Shoes::Foot Shoes::measured(const ShapedBody& body, int side) {
  const auto joint = [&](int j) -> Vec3 { return body.joints.row(j + side).transpose(); };
  Foot foot;
  foot.ankle = joint(LeftAnkle);
  foot.knee = joint(LeftKnee);
  foot.forwards = joint(LeftFoot) - foot.ankle;
  foot.forwards.y() = 0;
  foot.forwards = foot.forwards.norm() > 1e-4f ? foot.forwards.normalized() : Vec3::UnitZ();
  foot.sideways = Vec3::UnitY().cross(foot.forwards);
  foot.ball = joint(LeftFoot).dot(foot.forwards);
  foot.heel = foot.ball - 1e-3f;
  foot.tip = foot.ball + 1e-3f;
  foot.floor = joint(LeftFoot).y();
  std::vector<Eigen::Index> skin;
  for (Eigen::Index v = 0; v < body.vertices.rows(); ++v) {
    if (follows_foot(body.weights, v, side) < 0.5f) continue;
    skin.push_back(v);
    const float along = body.vertices.row(v).dot(foot.forwards);
    foot.heel = std::min(foot.heel, along);
    foot.tip = std::max(foot.tip, along);
    foot.floor = std::min(foot.floor, body.vertices(v, 1));
  }
  foot.size = (foot.tip - foot.heel) / kFootLength;
  std::array<float, kSlices> low, high;
  low.fill(1e9f), high.fill(-1e9f);
  for (const Eigen::Index v : skin) {
    const Vec3 x = body.vertices.row(v).transpose();
    const float at = (x.dot(foot.forwards) - foot.heel) / (foot.tip - foot.heel) * kSlices;
    const auto k = static_cast<size_t>(std::clamp(at, 0.0f, kSlices - 1.0f));
    low[k] = std::min(low[k], x.dot(foot.sideways));
    high[k] = std::max(high[k], x.dot(foot.sideways));
    foot.slices[k].height = std::max(foot.slices[k].height, x.y() - foot.floor);
  }
  const float ankle = foot.ankle.dot(foot.sideways);
  for (size_t k = 0; k < kSlices; ++k) {
    Slice& slice = foot.slices[k];
    const bool is_empty = low[k] > high[k];
    slice.middle = is_empty ? ankle : 0.5f * (low[k] + high[k]);
    slice.half_width = std::max(is_empty ? 0.0f : 0.5f * (high[k] - low[k]), 0.008f * foot.size);
    slice.height = std::max(slice.height, 0.01f * foot.size);
  }
  return foot;
}

Shoes::Shoes(const ShapedBody& body, const ShoeOptions& options)
    : options_(options), feet_{measured(body, 0), measured(body, 1)} {}

/// own: along, across, height over the sole. Onto the outline of the toe box, which closes what is between
/// the toes.
Vec3 Shoes::toe_box(const Foot& foot, const Vec3& own) const {
  const Slice slice = foot.slice(own.x()), widest = foot.slice(foot.ball);
  const float r = std::clamp((own.x() - foot.ball) / (foot.tip - foot.ball), 0.0f, 1.0f);
  const float blunt = 0.7f * (1 - options_.pointed);
  const float rounded = std::pow(1 - 0.97f * std::pow(r, options_.corner + 1), 1 / options_.corner);
  const float half_width =
      ((1 - blunt) * slice.half_width + blunt * widest.half_width * rounded) * (1 - options_.pointed * r) +
      foot.size * options_.upper;
  const float height = std::max(slice.height, foot.size * options_.toe_height) + foot.size * options_.upper;
  const float p = (own.y() - slice.middle) / slice.half_width, q = 2 * own.z() / slice.height - 1;
  const float radius = std::pow(
      std::pow(std::abs(p), options_.corner) + std::pow(std::abs(q), options_.corner), 1 / options_.corner);
  const float out = 1 / std::max(radius, 0.25f);
  return {own.x() + foot.size * options_.longer * r * r, slice.middle + half_width * p * out,
          0.5f * height * (q * out + 1)};
}

/// Downwards by sole and heel, the walls stretched.
Vec3 Shoes::heel_and_sole(const Foot& foot, const Vec3& own) const {
  const float low = 1 - risen(own.z(), 0, kWall * foot.size);
  const float length = foot.tip - foot.heel, front = foot.heel + kHeelShare * length;
  const float block = 1 - risen(own.x(), front, front + 0.04f * length);
  const float slope = 1 - risen(own.x(), front, foot.ball);
  const float under = options_.wedge ? slope : block;
  Vec3 result = own;
  const float narrower = (1 - options_.heel_width) * low * under;
  const float middle = foot.slice(own.x()).middle, back = foot.heel + 0.5f * kHeelShare * length;
  result.y() -= narrower * (own.y() - middle);
  if (!options_.wedge) result.x() -= narrower * (own.x() - back);
  result.z() -= low * foot.size * (options_.sole + options_.heel * under);
  return result;
}

/// shin: how far the point follows the shin.
Vec3 Shoes::shod(const Foot& foot, const Vec3& x, float shin) const {
  Vec3 own(x.dot(foot.forwards), x.dot(foot.sideways), x.y() - foot.floor);
  const float ankle_height = foot.ankle.y() - foot.floor;
  const float is_front = risen(own.x(), foot.ball - 0.35f * (foot.ball - foot.heel), foot.ball) *
                         (1 - risen(own.z(), 0.7f * ankle_height, 1.1f * ankle_height));
  const Vec3 box = toe_box(foot, own);
  // Behind the toes the shoe is a skin about the foot and, in boots, about the shin.
  const float up = (x.y() - foot.ankle.y()) / std::max(foot.knee.y() - foot.ankle.y(), 1e-3f);
  const Vec3 axis = foot.ankle + std::max(up, 0.0f) * (foot.knee - foot.ankle);
  Vec3 away = x - axis;
  away.y() = 0;
  const float collar = options_.shaft > 0 ? 1 - risen(up, options_.shaft - 0.03f, options_.shaft)
                                          : 1 - risen(own.z(), 0.8f * ankle_height, 0.95f * ankle_height);
  const float shaft = options_.shaft > 0 ? shin * options_.shaft_width : 0.0f;
  const float thick = foot.size * collar * std::max(options_.upper, shaft);
  if (away.norm() > 1e-4f) away *= thick / away.norm();
  const Vec3 skin = own + Vec3(away.dot(foot.forwards), away.dot(foot.sideways), 0);
  own = heel_and_sole(foot, (1 - is_front) * skin + is_front * box);
  return own.x() * foot.forwards + own.y() * foot.sideways + (own.z() + foot.floor) * Vec3::UnitY();
}

void Shoes::wear(Points& points, const RowMatrix& weights) const {
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (int side = 0; side < 2; ++side) {
      const float foot = follows_foot(weights, i, side), shin = weights(i, LeftKnee + side);
      const float worn = options_.shaft > 0 ? foot + shin : foot;
      if (worn < 0.05f) continue;
      const Vec3 x = points.row(i).transpose();
      points.row(i) += (std::min(worn, 1.0f) * (shod(feet_[side], x, shin) - x)).transpose();
    }
}

void Shoes::lift_heels(Pose& pose) const {
  if (options_.heel <= 0.01f) return;
  for (size_t side = 0; side < 2; ++side) {
    const Foot& foot = feet_[side];
    const float angle = std::atan2(foot.size * options_.heel, foot.ball - foot.heel);
    const Mat3 down = rotation_from_axis_angle(angle * foot.sideways);
    pose.local[LeftAnkle + side] = pose.local[LeftAnkle + side] * down;
    pose.local[LeftFoot + side] = down.transpose() * pose.local[LeftFoot + side];
  }
}

}  // namespace understudy
