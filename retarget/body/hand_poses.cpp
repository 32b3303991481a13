#include "retarget/body/hand_poses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {
namespace {

constexpr float kRadiansADegree = kPi / 180;
constexpr float kAllowedOverlap = 0.003f;  // metres
constexpr int kTries = 30;

Vec3 unit(const Vec3& x) {
  return x / std::max(x.norm(), 1e-12f);
}

/// x turned about the line through `centre` along the unit vector `axis`.
Vec3 turned(const Vec3& x, const Vec3& centre, const Vec3& axis, float radians) {
  const Vec3 d = x - centre;
  const float c = std::cos(radians), s = std::sin(radians);
  return centre + c * d + s * axis.cross(d) + (1 - c) * axis.dot(d) * axis;
}

int joint_of(int finger, int level) {
  return 1 + 5 * finger + level;
}

int first_angle(int finger) {
  return finger == 0 ? 0 : 1 + 5 * finger;
}

int finger_of_angle(int angle) {
  return angle < 6 ? 0 : (angle - 1) / 5;
}

std::vector<int> whole_numbers(const Npz& npz, const std::string& name, const std::string& path) {
  const IntegerMatrix column = require(npz, name, path).integers(1, path + ": " + name);
  std::vector<int> numbers;
  for (Eigen::Index i = 0; i < column.rows(); ++i) {
    US_CHECK(column(i, 0) >= 0 && column(i, 0) < 1 << 30, path, ": ", name, " has a number out of range");
    numbers.push_back(static_cast<int>(column(i, 0)));
  }
  return numbers;
}

/// Exactly rows x columns numbers, all finite.
RowMatrix numbers(const Npz& npz, const std::string& name, std::array<Eigen::Index, 2> size,
                  const std::string& path) {
  const NpyArray& array = require(npz, name, path);
  US_CHECK(array.size() == size[0] * size[1], path, ": ", name, " has ", array.size(), " numbers, not ",
           size[0] * size[1]);
  RowMatrix matrix = array.matrix(size[1], path + ": " + name);
  US_CHECK(matrix.allFinite(), path, ": ", name, " is not finite");
  return matrix;
}

HandAngles clamped(const HandAngles& angles, const HandAngles& low, const HandAngles& high) {
  return angles.cwiseMax(low).cwiseMin(high);
}

HandAngles normals(const HandDraws& random, float spread) {
  HandAngles result;
  for (float& x : result) x = spread * static_cast<float>(random.normal());
  return result;
}

/// A number in 0 .. 1 for each finger, alike but for `spread`.
std::array<float, kFingers> finger_shares(const HandDraws& random, float spread) {
  const auto all = static_cast<float>(random.uniform());
  std::array<float, kFingers> shares;
  for (float& share : shares)
    share = std::clamp(all + spread * static_cast<float>(random.normal()), 0.0f, 1.0f);
  return shares;
}

/// The numbers are degrees of people's hands: how bones of the palm, spread and joints follow the curl.
HandAngles curled(const HandDraws& random) {
  constexpr std::array<float, kFingers> kPalm = {0, 0, 0, 4, 9}, kOpenSpread = {0, 3, 0, -1, -1},
                                        kClosedSpread = {0, 2, 0, 7, 11};
  const auto u = finger_shares(random, 0.2f);
  const HandAngles w = normals(random, 1);
  HandAngles a;
  a.head<6>() << 15 * w[0] + 20 * u[0], -6 + 14 * w[1], -4 + 30 * u[0] + 10 * w[2], 4 * w[3], 12 + 14 * w[4],
      12 + 20 * w[5];
  for (int f = 1; f < kFingers; ++f) {
    const int o = first_angle(f);
    const float pip = 92 * u[f] + 8 * w[o + 3];
    a.segment<5>(o) << kPalm[f] * u[f], kOpenSpread[f] * (1 - u[f]) - kClosedSpread[f] * u[f] + 4 * w[o + 1],
        70 * std::clamp(u[f] + 0.15f * w[o + 2], 0.0f, 1.0f) - 14 * (1 - u[f]), pip,
        0.55f * pip + 6 * w[o + 4];
  }
  return a;
}

}  // namespace

HandPoses::HandPoses(const std::string& path) : source_(path) {
  const Npz npz = read_npz(path);
  rows_ = {whole_numbers(npz, "left_idx", path), whole_numbers(npz, "right_idx", path)};
  const Eigen::Index H = ssize(rows_[0]);
  US_CHECK(H > 0 && ssize(rows_[1]) == H, path, ": left_idx and right_idx must be as many, at least 1");
  read_weights(numbers(npz, "weights", {H, kFingers * kFingerBones}, path));
  const RowMatrix regressor = numbers(npz, "joint_reg", {kHandJoints, H}, path);
  for (int j = 0; j < kHandJoints; ++j)
    for (int v = 0; v < H; ++v)
      if (regressor(j, v) != 0) joint_sum_.push_back({j, v, regressor(j, v)});
  read_poses(npz, path);
  lowest_ = numbers(npz, "dof_lo", {kHandAngles, 1}, path);
  highest_ = numbers(npz, "dof_hi", {kHandAngles, 1}, path);
  thumb_nail_ = numbers(npz, "thumb_nail", {3, 1}, path);
  const RowMatrix roll = numbers(npz, "finger_roll", {kFingers, 1}, path);
  for (int f = 0; f < kFingers; ++f) roll_[f] = kRadiansADegree * roll(f, 0);
  if (npz.find("sph_finger") != npz.end()) read_spheres(npz, path);
}

/// Names are optional: what they say of a pose is only how often it is drawn.
void HandPoses::read_poses(const Npz& npz, const std::string& path) {
  const Eigen::Index count = require(npz, "pose_angles", path).size() / kHandAngles;
  US_CHECK(count > 0, path, ": has no poses");
  const RowMatrix poses = numbers(npz, "pose_angles", {count, kHandAngles}, path);
  for (Eigen::Index i = 0; i < count; ++i) poses_.emplace_back(poses.row(i).transpose());
  if (const auto it = npz.find("pose_names"); it != npz.end()) names_ = it->second.texts;
  names_.resize(poses_.size());
  const auto is_named = [&](size_t i, std::initializer_list<const char*> parts) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const char* part) { return names_[i].find(part) != std::string::npos; });
  };
  for (size_t i = 0; i < names_.size(); ++i) {
    if (is_named(i, {"relaxed", "walking", "sitting"})) relaxed_.push_back(static_cast<int>(i));
    if (is_named(i, {"fist", "grip", "hook", "cupped"})) closed_.push_back(static_cast<int>(i));
  }
}

void HandPoses::read_spheres(const Npz& npz, const std::string& path) {
  spheres_.finger = whole_numbers(npz, "sph_finger", path);
  spheres_.level = whole_numbers(npz, "sph_level", path);
  const Eigen::Index S = ssize(spheres_.finger);
  spheres_.centres = numbers(npz, "sph_centre", {S, 3}, path);
  const RowMatrix radius = numbers(npz, "sph_r", {S, 1}, path);
  spheres_.radius.assign(radius.data(), radius.data() + S);
  spheres_.joints = numbers(npz, "template_joints", {kHandJoints, 3}, path);
  const std::vector<int> pairs = whole_numbers(npz, "sph_pairs", path);
  const RowMatrix rest = numbers(npz, "sph_rest", {ssize(pairs) / 2, 1}, path);
  for (size_t i = 0; i + 1 < pairs.size(); i += 2) {
    US_CHECK(pairs[i] < S && pairs[i + 1] < S, path, ": sph_pairs names a sphere that does not exist");
    spheres_.pairs.push_back({pairs[i], pairs[i + 1]});
    spheres_.rest.push_back(rest(static_cast<Eigen::Index>(i) / 2, 0));
  }
  for (Eigen::Index s = 0; s < S; ++s)
    US_CHECK(spheres_.finger[s] < kFingers && ssize(spheres_.level) == S, path,
             ": sph_finger and sph_level must name a finger and a bone of each sphere");
}

void HandPoses::read_weights(const RowMatrix& weights) {
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    first_.push_back(static_cast<int>(follows_.size()));
    const float moving = weights.row(v).sum();  // what does not stay with the wrist
    for (int f = 0; f < kFingers && moving > 0; ++f) {
      const auto bones = weights.row(v).segment<kFingerBones>(kFingerBones * f);
      Follows one{f, bones.sum() / std::max(moving, 1e-9f), {}};
      if (one.share <= 0) continue;
      one.joints[0] = moving;
      for (int l = 1; l < kFingerBones; ++l)
        one.joints[l] =
            std::clamp(bones.tail(kFingerBones - l).sum() / std::max(one.share, 1e-9f), 0.0f, 1.0f);
      follows_.push_back(one);
    }
  }
  first_.push_back(static_cast<int>(follows_.size()));
}

const HandAngles& HandPoses::pose(const std::string& name) const {
  const auto it = std::find(names_.begin(), names_.end(), name);
  US_CHECK(it != names_.end(), source_, ": has no hand pose \"", name, "\"");
  return poses_[it - names_.begin()];
}

HandVertices HandPoses::vertices_of(const RowMatrix& body_weights, const RowMatrix& weights) const {
  HandVertices found;
  std::vector<int> place(weights.rows(), -1);
  for (size_t side = 0; side < 2; ++side) {
    const int wrist = side == 0 ? LeftWrist : RightWrist;
    float least = 1;
    for (const int row : rows_[side]) {
      US_CHECK(row < body_weights.rows(), source_, ": names vertex ", row, " of a body of ",
               body_weights.rows());
      least = std::min(least, body_weights(row, wrist));
    }
    const auto that_follow = [&](const RowMatrix& all) {
      std::vector<int> rows;
      for (Eigen::Index v = 0; v < all.rows(); ++v)
        if (all(v, wrist) >= 0.999f * least) rows.push_back(static_cast<int>(v));
      return rows;
    };
    const std::vector<int> there = that_follow(body_weights), here = that_follow(weights);
    if (here.size() < there.size()) return {};
    for (size_t i = 0; i < there.size(); ++i)
      if (std::abs(body_weights(there[i], wrist) - weights(here[i], wrist)) > 1e-3f) return {};
    for (const int row : rows_[side]) {
      const auto at = std::lower_bound(there.begin(), there.end(), row) - there.begin();
      place[here[at]] = static_cast<int>(found.rows[side].size() + side * rows_[0].size());
      found.rows[side].push_back(here[at]);
    }
  }
  found.place = std::move(place);
  return found;
}

std::array<Hinges, kFingers> HandPoses::hinges(const HandJointPoints& joints) const {
  const auto joint = [&](int finger, int level) -> Vec3 {
    return joints.row(joint_of(finger, level)).transpose();
  };
  const auto bone = [&](int finger, int level) {
    return unit(joint(finger, level + 1) - joint(finger, level));
  };
  // The hand's frame: forwards, from the index to the little finger, the back of the hand.
  const Vec3 forwards = unit(joint(2, 1) - joints.row(0).transpose()), across = joint(4, 1) - joint(1, 1);
  const Vec3 lateral = unit(across - across.dot(forwards) * forwards), back = forwards.cross(lateral);
  const Vec3 nail = thumb_nail_[0] * forwards + thumb_nail_[1] * lateral + thumb_nail_[2] * back;

  std::array<Hinges, kFingers> result;
  const Vec3 knuckle = unit(nail.cross(bone(0, 1)));
  result[0] = {{2, unit(nail.cross(bone(0, 2))), 5}, {1, knuckle, 4},
               {1, bone(0, 1).cross(knuckle), 3},    {0, bone(0, 0), 0},
               {0, unit(back.cross(bone(0, 0))), 1}, {0, back, 2}};
  for (int f = 1; f < kFingers; ++f) {
    const Vec3 roll = std::cos(roll_[f]) * lateral + std::sin(roll_[f]) * back;
    const auto axis = [&](int level) { return unit(roll - roll.dot(bone(f, level)) * bone(f, level)); };
    const float outwards = f < 3 ? -1.0f : 1.0f;  // where the finger is spread to
    const int o = first_angle(f);
    result[f] = {{3, axis(3), o + 4},
                 {2, axis(2), o + 3},
                 {1, axis(1), o + 2},
                 {1, outwards * bone(f, 1).cross(axis(1)), o + 1},
                 {0, axis(0), o}};
  }
  return result;
}

float HandPoses::overlap(const HandAngles& angles) const {
  if (spheres_.pairs.empty()) return -1;
  const std::array<Hinges, kFingers> all = hinges(spheres_.joints);
  Points at = spheres_.centres;
  for (Eigen::Index s = 0; s < at.rows(); ++s)
    for (const Hinge& hinge : all[spheres_.finger[s]])
      if (spheres_.level[s] >= hinge.level)
        at.row(s) = turned(at.row(s).transpose(),
                           spheres_.joints.row(joint_of(spheres_.finger[s], hinge.level)).transpose(),
                           hinge.axis, kRadiansADegree * angles[hinge.angle])
                        .transpose();
  float deepest = -1;
  for (size_t i = 0; i < spheres_.pairs.size(); ++i) {
    const auto [a, b] = spheres_.pairs[i];
    deepest = std::max(
        deepest, spheres_.radius[a] + spheres_.radius[b] - spheres_.rest[i] - (at.row(a) - at.row(b)).norm());
  }
  return deepest;
}

const HandAngles& HandPoses::any_pose(Rng& rng) const {
  return poses_[rng.below(static_cast<int>(poses_.size()))];
}

const HandAngles& HandPoses::pose_of(const std::vector<int>& group, Rng& rng) const {
  return group.empty() ? any_pose(rng) : poses_[group[rng.below(static_cast<int>(group.size()))]];
}

HandAngles HandPoses::near_pose(const HandAngles& pose, const HandDraws& random) const {
  const auto share = static_cast<float>(0.5 + 0.6 * random.uniform());
  return share * pose + normals(random, 4);
}

HandAngles HandPoses::between_poses(const HandAngles& a, const HandDraws& random) const {
  const HandAngles b = poses_[random.below(static_cast<int>(poses_.size()))];
  const auto shares = finger_shares(random, 0.12f);
  HandAngles result;
  for (int i = 0; i < kHandAngles; ++i) result[i] = a[i] + shares[finger_of_angle(i)] * (b[i] - a[i]);
  return result;
}

HandAngles HandPoses::sample(Rng& rng) const {
  return sample({[&rng] { return rng.uniform(); }, [&rng] { return rng.normal(); },
                 [&rng](int count) { return rng.below(count); }});
}

HandAngles HandPoses::sample(const HandDraws& random) const {
  const int count = static_cast<int>(poses_.size());
  for (int i = 0; i < kTries; ++i) {
    const double kind = random.uniform();
    const HandAngles& pose = poses_[random.below(count)];
    const HandAngles drawn = kind < 0.45   ? near_pose(pose, random)
                             : kind < 0.75 ? between_poses(pose, random)
                                           : curled(random);
    HandAngles angles = clamped(drawn, lowest_, highest_);
    if (overlap(angles) < kAllowedOverlap) return angles;
  }
  return poses_[random.below(count)];
}

HandAngles HandPoses::draw(Rng& rng) const {
  const float kind = rng.uniform();
  if (kind < 0.18f) return HandAngles::Zero();
  if (kind < 0.48f) return rng.uniform(0.3f, 1.0f) * pose_of(relaxed_, rng);
  if (kind < 0.60f) return rng.uniform(0.5f, 1.0f) * pose_of(closed_, rng);
  if (kind < 0.75f) return rng.uniform(0.6f, 1.0f) * any_pose(rng);
  return sample(rng);
}

Points HandPoses::apply(const Points& vertices, const HandVertices& hands,
                        const std::array<HandAngles, 2>& angles) const {
  Points result = vertices;
  if (hands.empty()) return result;
  const BentHands bent(*this, hands, vertices, angles);
  for (const auto& rows : hands.rows)
    for (const int row : rows) result.row(row) = bent.vertex(row).transpose();
  return result;
}

BentHands::BentHands(const HandPoses& poses, const HandVertices& hands, const Points& vertices,
                     const std::array<HandAngles, 2>& angles)
    : poses_(poses), hands_(hands), vertices_(vertices) {
  US_CHECK(hands.empty() || ssize(hands.place) == vertices.rows(), "hands of ", hands.place.size(),
           " vertices for a mesh of ", vertices.rows());
  for (size_t side = 0; side < 2 && !hands.empty(); ++side) {
    Hand& hand = sides_[side];
    hand.joints.setZero();
    for (const auto& [joint, vertex, weight] : poses.joint_sum_)
      hand.joints.row(joint) += weight * vertices.row(hands.rows[side][vertex]);
    if (side == 1) hand.joints.col(0) *= -1;
    hand.hinges = poses.hinges(hand.joints);
    hand.radians = kRadiansADegree * angles[side];
  }
}

/// A vertex of a left hand, or of a right one in the mirror.
Vec3 BentHands::bent(const Hand& hand, int number, const Vec3& x) const {
  Vec3 result = x;
  for (int i = poses_.first_[number]; i < poses_.first_[number + 1]; ++i) {
    const HandPoses::Follows& one = poses_.follows_[i];
    Vec3 moved = x;
    for (const Hinge& hinge : hand.hinges[one.finger]) {
      const float angle = one.joints[hinge.level] * hand.radians[hinge.angle];
      if (angle != 0)
        moved =
            turned(moved, hand.joints.row(joint_of(one.finger, hinge.level)).transpose(), hinge.axis, angle);
    }
    result += one.share * (moved - x);
  }
  return result;
}

Vec3 BentHands::vertex(int row) const {
  const int place = hands_.empty() ? -1 : hands_.place[row];
  if (place < 0) return vertices_.row(row).transpose();
  const int count = poses_.vertex_count(), side = place / count;
  const Vec3 flip(side == 0 ? 1.0f : -1.0f, 1, 1), x = vertices_.row(row).transpose().cwiseProduct(flip);
  return bent(sides_[side], place % count, x).cwiseProduct(flip);
}

}  // namespace understudy
