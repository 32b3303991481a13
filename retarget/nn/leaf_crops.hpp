// Hands, head and feet seen from near: points of a scan around a leaf of the skeleton, in the leaf's own
// frame.
#pragma once

#include <array>
#include <optional>

#include "retarget/geometry/mesh.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

enum class LeafKind { Hand, Head, Foot, Arm };
constexpr int kLeafKinds = 4;
constexpr int kLeafPoints = 128;  ///< points of a crop
constexpr int kLeafContext = 10;  ///< numbers that go with it
constexpr int kLeafTurns = 2;     ///< rotations that are told of each

/// A joint whose rotation no bone's direction tells, and what is corrected there.
struct Leaf {
  LeafKind kind;
  int joint;                             ///< the crop is about it and in its frame
  std::array<int, kLeafTurns> corrects;  ///< joints whose rotations are told, -1: none
  bool mirrored;                         ///< a right one, looked at as a left one
};
constexpr std::array<Leaf, 7> kLeaves = {{{LeafKind::Arm, LeftElbow, {LeftElbow, LeftShoulder}, false},
                                          {LeafKind::Arm, RightElbow, {RightElbow, RightShoulder}, true},
                                          {LeafKind::Hand, LeftWrist, {LeftWrist, -1}, false},
                                          {LeafKind::Hand, RightWrist, {RightWrist, -1}, true},
                                          {LeafKind::Head, Head, {Head, Neck}, false},
                                          {LeafKind::Foot, LeftAnkle, {LeftAnkle, LeftFoot}, false},
                                          {LeafKind::Foot, RightAnkle, {RightAnkle, RightFoot}, true}}};

/// What a network sees of a leaf.
struct LeafCrop {
  Points points;  ///< [kLeafPoints, 3] in the joint's frame, in leg lengths
  Eigen::Matrix<float, kLeafContext, 1>
      context;  ///< parent's bone and rotation in that frame, how full it is
};

/// Points of the scan (finite ones, metres) around the leaf as the extraction, which must have rotations,
/// says it lies; repeated where there are few. None where fewer than 16 are there. `first` picks which are
/// taken where there are more than enough.
std::optional<LeafCrop> cut_leaf(const Points& scan, const Extraction& seen, const Leaf& leaf,
                                 uint32_t first = 0);

/// A rotation of the world in the frame of a crop, and back: what the network is to say and what was said.
Mat3 into_leaf(const Mat3& world, const Extraction& seen, const Leaf& leaf);
Mat3 from_leaf(const Mat3& local, const Extraction& seen, const Leaf& leaf);

}  // namespace understudy::nn
