// Arms, legs, hands, head and feet seen from near: points of a scan around a joint, in the joint's own
// frame.
#pragma once

#include <array>
#include <optional>

#include "retarget/geometry/mesh.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

enum class LeafKind { Hand, Head, Foot, Arm, Leg };
constexpr int kLeafKinds = 5;
constexpr int kLeafPoints = 128;  ///< points of a crop
constexpr int kLeafContext = 13;  ///< numbers that go with it
constexpr int kLeafJoints = 2;    ///< joints of which something is told

/// A joint that is seen again, and what is corrected there.
struct Leaf {
  LeafKind kind;
  int joint;                              ///< the crop is about it and in its frame
  std::array<int, kLeafJoints> corrects;  ///< joints whose rotations and places are told, -1: none
  int moves;  ///< so many of them are put where they were told to be: the others are better known from afar
  bool mirrored;  ///< a right one, looked at as a left one
};
constexpr std::array<Leaf, 9> kLeaves = {{{LeafKind::Leg, LeftKnee, {LeftKnee, LeftHip}, 1, false},
                                          {LeafKind::Leg, RightKnee, {RightKnee, RightHip}, 1, true},
                                          {LeafKind::Arm, LeftElbow, {LeftElbow, LeftShoulder}, 1, false},
                                          {LeafKind::Arm, RightElbow, {RightElbow, RightShoulder}, 1, true},
                                          {LeafKind::Hand, LeftWrist, {LeftWrist, -1}, 1, false},
                                          {LeafKind::Hand, RightWrist, {RightWrist, -1}, 1, true},
                                          {LeafKind::Head, Head, {Head, Neck}, 1, false},
                                          {LeafKind::Foot, LeftAnkle, {LeftAnkle, LeftFoot}, 2, false},
                                          {LeafKind::Foot, RightAnkle, {RightAnkle, RightFoot}, 2, true}}};

/// What a network sees of a leaf.
struct LeafCrop {
  Points points;  ///< [kLeafPoints, 3] in the joint's frame, in leg lengths
  Eigen::Matrix<float, kLeafContext, 1>
      context;  ///< parent's bone and rotation in that frame, the second joint, how full it is
};

/// Points of the scan (finite ones, metres) around the leaf as the extraction, which must have rotations,
/// says it lies; repeated where there are few. None where fewer than 16 are there. `first` picks which are
/// taken where there are more than enough.
std::optional<LeafCrop> cut_leaf(const Points& scan, const Extraction& seen, const Leaf& leaf,
                                 uint32_t first = 0);

/// A rotation of the world in the frame of a crop, and back: what the network is to say and what was said.
Mat3 into_leaf(const Mat3& world, const Extraction& seen, const Leaf& leaf);
Mat3 from_leaf(const Mat3& local, const Extraction& seen, const Leaf& leaf);
/// The same of a way in the world, metres; in the crop it is in leg lengths.
Vec3 way_into_leaf(const Vec3& world, const Extraction& seen, const Leaf& leaf);
Vec3 way_from_leaf(const Vec3& local, const Extraction& seen, const Leaf& leaf);

}  // namespace understudy::nn
