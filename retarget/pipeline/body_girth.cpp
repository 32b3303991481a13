#include "retarget/pipeline/body_girth.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"
#include "retarget/math/segment.hpp"
#include "retarget/pipeline/copy_transfer.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"

namespace understudy {
namespace {

constexpr int kLooked = 500;        // points of a scan
constexpr float kGirthFrames = 90;  // frames that the running mean remembers
constexpr float kDoubt = 0.06f;     // of the leg: an arm this near as well leaves it open what a point is of
constexpr float kFarthest = 2.5f;   // human radii: what is further out is no skin

enum Group { Trunk, Legs, LeftArm, RightArm };

/// A bone and what is around it. Radius: a human's, of the leg.
struct Bone {
  int joint, end;  // end -1: see bone_end
  Group group;
  float radius;
  int station, stations;
  float from, to;  // along: where it is sure to be this bone's
};

constexpr std::array<Bone, 19> kBones = {{
    {Pelvis, Spine1, Trunk, 0.15f, 0, 1, -0.6f, 1.0f},
    {Spine1, Spine2, Trunk, 0.15f, 1, 1, 0.0f, 1.0f},
    {Spine2, Spine3, Trunk, 0.15f, 2, 1, 0.0f, 1.0f},
    {Spine3, Neck, Trunk, 0.15f, 3, 1, 0.0f, 0.7f},
    {Head, -1, Trunk, 0.11f, 4, 1, -0.1f, 0.8f},
    {LeftHip, LeftKnee, Legs, 0.1f, 5, 2, 0.1f, 1.0f},
    {RightHip, RightKnee, Legs, 0.1f, 7, 2, 0.1f, 1.0f},
    {LeftShoulder, LeftElbow, LeftArm, 0.055f, 9, 1, 0.3f, 1.0f},
    {RightShoulder, RightElbow, RightArm, 0.055f, 10, 1, 0.3f, 1.0f},
    {LeftElbow, LeftWrist, LeftArm, 0.042f, 11, 1, 0.0f, 0.9f},
    {RightElbow, RightWrist, RightArm, 0.042f, 12, 1, 0.0f, 0.9f},
    {LeftWrist, -1, LeftArm, 0.035f, -1, 0, 0, 1},
    {RightWrist, -1, RightArm, 0.035f, -1, 0, 0, 1},
    {LeftKnee, LeftAnkle, Legs, 0.06f, -1, 0, 0, 1},
    {RightKnee, RightAnkle, Legs, 0.06f, -1, 0, 0, 1},
    {LeftAnkle, LeftFoot, Legs, 0.05f, -1, 0, 0, 1},
    {RightAnkle, RightFoot, Legs, 0.05f, -1, 0, 0, 1},
    {LeftFoot, -1, Legs, 0.03f, -1, 0, 0, 1},
    {RightFoot, -1, Legs, 0.03f, -1, 0, 0, 1},
}};

constexpr size_t kSpineBones = 4;  // the first

/// World: the other end of a bone, also of those that no joint ends.
Vec3 bone_end(const Bone& bone, const Joints& joints) {
  const auto at = [&](int j) { return Vec3(joints.row(j).transpose()); };
  if (bone.end >= 0) return at(bone.end);
  const int parent = kParents[bone.joint];
  const float longer = bone.joint == Head ? 1.3f : bone.joint >= LeftWrist ? 0.7f : 0.5f;
  return at(bone.joint) + longer * (at(bone.joint) - at(parent));
}

/// Two axes across the bone, T-pose axes: direction 0 and a quarter further.
std::pair<Vec3, Vec3> across(const Bone& bone) {
  if (bone.group == LeftArm || bone.group == RightArm) return {Vec3::UnitY(), Vec3::UnitZ()};
  return {Vec3::UnitX(), Vec3::UnitZ()};
}

bool is_arm(Group group) {
  return group == LeftArm || group == RightArm;
}

/// How far the point is out of the skin of a human around each bone; the nearest, and the nearest of another
/// group where one of both is an arm.
struct Nearest {
  size_t bone = 0;
  float out = INFINITY, other = INFINITY;
};

Nearest nearest_bone(const Vec3& point, const Joints& joints, float leg_m) {
  Nearest result;
  std::array<float, kBones.size()> out;
  for (size_t b = 0; b < kBones.size(); ++b) {
    const Vec3 start = joints.row(kBones[b].joint).transpose();
    out[b] = from_segment(point, start, bone_end(kBones[b], joints)).norm() - kBones[b].radius * leg_m;
    if (out[b] < result.out) result.bone = b, result.out = out[b];
  }
  const Group mine = kBones[result.bone].group;
  for (size_t b = 0; b < kBones.size(); ++b)
    if (kBones[b].group != mine && (is_arm(mine) || is_arm(kBones[b].group)))
      result.other = std::min(result.other, out[b]);
  return result;
}

}  // namespace

GirthPlace girth_place(const Vec3& point, const Joints& joints, const Rotations& global) {
  const float leg_m = leg_length(joints);
  Nearest near = nearest_bone(point, joints, leg_m);
  const auto at = [&](int j) { return Vec3(joints.row(j).transpose()); };
  const bool spine = near.bone < kSpineBones;
  const Vec3 up = at(Neck) - at(Pelvis);
  // Along the spine, which is bent, height decides: a belly is nearest to the bone that lies foremost.
  for (near.bone = spine ? 0 : near.bone; spine && near.bone + 1 < kSpineBones; ++near.bone)
    if ((point - at(kBones[near.bone].end)).dot(up) < 0) break;
  const Bone& bone = kBones[near.bone];
  const Vec3 a = at(bone.joint), whole = bone_end(bone, joints) - a, axis = spine ? up : whole;
  const float length = whole.dot(axis);
  GirthPlace place;
  place.joint = bone.joint;
  place.end = bone.end;
  place.along = (point - a).dot(axis) / (std::abs(length) > 1e-12f ? length : 1e-12f);
  place.radial = global[bone.joint].transpose() * (point - a - place.along * whole);
  const auto [zero, quarter] = across(bone);
  const float angle = std::atan2(place.radial.dot(quarter), place.radial.dot(zero)) / (2 * kPi);
  place.direction = (angle < 0 ? angle + 1 : angle) * BodyGirth::kDirections;
  if (bone.station < 0) return place;
  const int step = static_cast<int>(std::floor(place.along * static_cast<float>(bone.stations)));
  place.station = bone.station + std::clamp(step, 0, bone.stations - 1);
  place.sure = place.along >= bone.from && place.along <= bone.to && near.other - near.out > kDoubt * leg_m &&
               place.radial.norm() < kFarthest * bone.radius * leg_m;
  return place;
}

BodyGirth measure_girth(const Joints& joints, const Rotations& global, const Points& surface) {
  BodyGirth girth;
  std::array<std::array<int, BodyGirth::kDirections>, BodyGirth::kStations> count{};
  const Eigen::Index step = std::max<Eigen::Index>(1, surface.rows() / kLooked);
  for (Eigen::Index i = 0; i < surface.rows(); i += step) {
    if (!surface.row(i).allFinite()) continue;
    const GirthPlace place = girth_place(surface.row(i).transpose(), joints, global);
    if (place.station < 0 || !place.sure) continue;
    const size_t s = place.station;
    const auto d = static_cast<size_t>(std::lround(place.direction)) % BodyGirth::kDirections;
    girth.radius[s][d] += place.radial.norm();
    ++count[s][d];
  }
  for (size_t s = 0; s < girth.radius.size(); ++s)
    for (size_t d = 0; d < BodyGirth::kDirections; ++d)
      if (count[s][d] > 0) girth.radius[s][d] /= static_cast<float>(count[s][d]);
  return girth;
}

BodyGirth measure_girth(const Extraction& source, const Points& scan) {
  CopyTransfer solver;
  solver.reset(human_rest());
  const Pose pose{solver.push(source, 1 / 30.0f), Vec3::Zero()};
  BodyGirth girth = measure_girth(source.joints, forward_kinematics(human_rest(), pose).global, scan);
  for (const Bone& bone : kBones)
    for (int s = bone.station; bone.end >= 0 && is_lost(source, bone.end) && s < bone.station + bone.stations;
         ++s)
      girth.radius[s].fill(0);  // what is near is something else
  return girth;
}

const BodyGirth& human_girth() {
  static const BodyGirth girth = {{{
      {{0.142f, 0.179f, 0.158f, 0.177f, 0.144f, 0.125f, 0.113f, 0.123f}},  // pelvis
      {{0.152f, 0.204f, 0.192f, 0.205f, 0.151f, 0.074f, 0.049f, 0.074f}},  // spine1
      {{0.145f, 0.185f, 0.180f, 0.184f, 0.144f, 0.072f, 0.048f, 0.073f}},  // spine2
      {{0.159f, 0.190f, 0.172f, 0.190f, 0.159f, 0.104f, 0.080f, 0.106f}},  // spine3
      {{0.088f, 0.089f, 0.099f, 0.089f, 0.088f, 0.115f, 0.138f, 0.115f}},  // head
      {{0.092f, 0.113f, 0.126f, 0.124f, 0.104f, 0.090f, 0.081f, 0.079f}},  // left thigh, upper half
      {{0.070f, 0.085f, 0.097f, 0.096f, 0.081f, 0.070f, 0.064f, 0.065f}},  // lower half
      {{0.105f, 0.124f, 0.126f, 0.113f, 0.092f, 0.079f, 0.081f, 0.089f}},  // right thigh
      {{0.080f, 0.096f, 0.097f, 0.085f, 0.070f, 0.065f, 0.064f, 0.071f}},
      {{0.053f, 0.053f, 0.051f, 0.050f, 0.055f, 0.058f, 0.056f, 0.050f}},  // left upper arm
      {{0.053f, 0.053f, 0.051f, 0.050f, 0.055f, 0.058f, 0.056f, 0.050f}},  // right
      {{0.037f, 0.042f, 0.044f, 0.042f, 0.038f, 0.041f, 0.039f, 0.039f}},  // left forearm
      {{0.037f, 0.042f, 0.044f, 0.042f, 0.038f, 0.041f, 0.039f, 0.039f}},  // right
  }}};
  return girth;
}

void RunningGirth::push(const BodyGirth& seen) {
  for (size_t s = 0; s < count_.size(); ++s)
    for (size_t d = 0; d < BodyGirth::kDirections; ++d) {
      if (seen.radius[s][d] <= 0) continue;
      count_[s][d] = std::min(count_[s][d] + 1, kGirthFrames);
      mean_.radius[s][d] += (seen.radius[s][d] - mean_.radius[s][d]) / count_[s][d];
    }
}

BodyGirth RunningGirth::value(float leg_m) const {
  BodyGirth result = human_girth();
  for (size_t s = 0; s < count_.size(); ++s) {
    float seen = 0, human = 0;
    for (size_t d = 0; d < BodyGirth::kDirections; ++d) {
      result.radius[s][d] *= leg_m;
      if (count_[s][d] <= 0) continue;
      seen += mean_.radius[s][d];
      human += result.radius[s][d];
    }
    for (size_t d = 0; d < BodyGirth::kDirections; ++d) {
      if (count_[s][d] > 0)
        result.radius[s][d] = mean_.radius[s][d];
      else if (human > 0)
        result.radius[s][d] *= seen / human;
    }
  }
  return result;
}

}  // namespace understudy
