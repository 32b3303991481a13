#include "retarget/pose2d/reference_remarks.hpp"

#include <cmath>
#include <optional>

#include "retarget/base/text.hpp"

namespace understudy {
namespace {

constexpr float kDown = 0.5f;       // sine of the least slope that counts as upside down
constexpr float kLying = 0.5f;      // sine of the most slope of a trunk that lies
constexpr float kSideways = 0.25f;  // of the trunk: shoulders nearer to one another are seen from the side
constexpr float kShort = 0.6f;      // of its length: a thigh that points at the camera
constexpr float kStraight = 0.7f;   // of its length: a shin that does not
constexpr float kUnusual = 2.2f;    // times as long, or as short: no person's
/// Lengths over their geometric mean: of 240 people of the suite pose2d, none of whom is more than 1.3 times
/// off; of those of pose2d-odd, whose bones are scaled apart, none is more than 2.1 times off.
constexpr std::array<float, kFlatBoneCount> kUsual = {1.983f, 0.897f, 0.694f, 0.694f, 0.989f, 0.989f, 0.964f,
                                                      0.964f, 0.424f, 0.424f, 1.618f, 1.618f, 1.65f,  1.65f};

Vec2 trunk_of(const FlatPose& pose) {
  const bool is_seen = pose.has(body25::MidHip) && pose.has(body25::Neck);
  return is_seen ? Vec2(pose.at(body25::Neck) - pose.at(body25::MidHip)) : Vec2(Vec2::Zero());
}

/// Of left to right over the trunk: above 0 of who faces the camera. None where it is seen from the side.
std::optional<float> facing(const FlatPose& pose) {
  const Vec2 up = trunk_of(pose);
  const float size = up.norm();
  const auto across = [&](int right, int left) {
    if (!pose.has(right) || !pose.has(left) || size <= 0) return 0.0f;
    const Vec2 way = (pose.at(left) - pose.at(right)) / size;
    return (up.x() * way.y() - up.y() * way.x()) / size;
  };
  const float shoulders = across(body25::RightShoulder, body25::LeftShoulder),
              hips = across(body25::RightHip, body25::LeftHip);
  if (std::abs(shoulders) < kSideways || shoulders * hips < 0) return std::nullopt;
  return shoulders;
}

bool shows_face(const FlatPose& pose) {
  return pose.has(body25::Nose) && pose.has(body25::RightEye) && pose.has(body25::LeftEye);
}

/// How long a bone looks for its length; none where it is not seen.
std::optional<float> look_of(const FlatPose& pose, const Proportions& lengths, int bone) {
  const float seen = seen_lengths(pose)[bone];
  if (seen <= 0) return std::nullopt;
  return seen / std::max(lengths.length[bone], 1e-6f);
}

bool sits(const FlatPose& pose, const Proportions& lengths) {
  if (-trunk_of(pose).y() < 0.8f * trunk_of(pose).norm()) return false;
  for (const auto& [thigh, shin] : {std::pair{flat_bone::RightThigh, flat_bone::RightShin},
                                    std::pair{flat_bone::LeftThigh, flat_bone::LeftShin}}) {
    const auto upper = look_of(pose, lengths, thigh), lower = look_of(pose, lengths, shin);
    if (!upper || !lower || *lower < kStraight) return false;
    const FlatBone& bone = kFlatBones[static_cast<size_t>(thigh)];
    const Vec2 way = pose.at(bone.to) - pose.at(bone.from);
    // Towards the camera it looks short, from the side it lies.
    if (*upper > kShort && way.y() > kLying * way.norm()) return false;
  }
  return true;
}

bool is_on_all_fours(const FlatPose& pose) {
  const Vec2 trunk = trunk_of(pose);
  const float size = trunk.norm();
  if (size <= 0 || std::abs(trunk.y()) > kLying * size) return false;
  const auto hangs = [&](int from, int to) {
    return pose.has(from) && pose.has(to) && pose.at(to).y() > pose.at(from).y() + 0.3f * size;
  };
  return hangs(body25::RightShoulder, body25::RightWrist) && hangs(body25::LeftShoulder, body25::LeftWrist) &&
         hangs(body25::RightHip, body25::RightAnkle) && hangs(body25::LeftHip, body25::LeftAnkle);
}

bool shows_legs(const FlatPose& pose) {
  return pose.has(body25::RightKnee) || pose.has(body25::LeftKnee) || pose.has(body25::RightAnkle) ||
         pose.has(body25::LeftAnkle);
}

/// The bone that is farthest from a person's usual proportions, where that is too far.
std::string unusual(const Proportions& lengths) {
  BoneLengths off;
  for (int b = 0; b < kFlatBoneCount; ++b)
    off[b] = std::log(std::max(lengths.length[b], 1e-6f) / kUsual[static_cast<size_t>(b)]);
  off -= off.mean();
  int worst = 0;
  off.abs().maxCoeff(&worst);
  const float times = std::exp(off[worst]);
  if (std::abs(off[worst]) < std::log(kUnusual)) return "";
  return "has proportions that are hardly a person's: " +
         lower_case(kFlatBones[static_cast<size_t>(worst)].label) +
         printed(" %.1f times as long as usual", static_cast<double>(times));
}

}  // namespace

bool is_upside_down(const FlatPose& pose) {
  const Vec2 trunk = trunk_of(pose);
  return trunk.y() > kDown * trunk.norm() && trunk.y() > 0;
}

FlatPose turned_by_half(const FlatPose& pose) {
  FlatPose turned = pose;
  turned.body.leftCols<2>() *= -1;
  for (FlatPoints* points : {&turned.left_hand, &turned.right_hand, &turned.face}) points->leftCols(2) *= -1;
  return turned;
}

std::vector<std::string> reference_remarks(const FlatPose& seen, const Proportions& lengths) {
  FlatPose standing = seen;
  add_middles(standing);
  std::vector<std::string> remarks;
  if (const auto front = facing(standing); front && *front < 0)
    remarks.push_back(shows_face(standing)
                          ? "has left and right exchanged: the face is seen, the sides are those of a back"
                          : "is seen from behind, or left and right are exchanged; lengths are the same");
  if (is_upside_down(standing))
    remarks.push_back("is upside down: the result starts about the middle of the body, not with the feet");
  if (is_on_all_fours(standing))
    remarks.push_back("is on all fours: if that is no person, neither are its proportions");
  else if (sits(standing, lengths))
    remarks.push_back("sits: the result stands up with its feet where the feet are");
  if (!shows_legs(standing))
    remarks.push_back("shows no legs: how long they are is guessed from the rest of the body");
  if (const std::string why = unusual(lengths); !why.empty()) remarks.push_back(why);
  return remarks;
}

}  // namespace understudy
