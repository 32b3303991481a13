// Part crops: the points of a scan around an arm, leg, hand, head or foot, in the frame of its joint.
#pragma once

#include <array>
#include <optional>

#include "retarget/geometry/mesh.hpp"
#include "retarget/networks/part_patches.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

enum class PartKind { Hand, Head, Foot, Arm, Leg };
constexpr int kPartKinds = 5;
constexpr int kPartPoints = 128;  ///< points of a crop
constexpr int kFinePoints = 256;  ///< points that patches are cut from, at most
constexpr int kPartContext = 13;  ///< numbers beside the points
constexpr int kPartJoints = 2;    ///< joints that a crop corrects, at most

/// Hands, heads and feet are small and have many shapes: they are seen in patches. Limbs gain nothing by it,
/// and are seen as points.
constexpr bool seen_in_patches(PartKind kind) {
  return kind == PartKind::Hand || kind == PartKind::Head || kind == PartKind::Foot;
}
/// Rows of a crop.
constexpr int rows_of(PartKind kind) {
  return seen_in_patches(kind) ? kPartPatchRows : kPartPoints;
}

/// A joint with a crop of its own, and the joints that are corrected there.
struct Part {
  PartKind kind;
  int joint;                              ///< the crop is about it and in its frame
  std::array<int, kPartJoints> corrects;  ///< joints with a predicted rotation and position, -1: none
  int moves;      ///< how many of them also move; the whole body gives better positions for the others
  bool mirrored;  ///< a right part, reflected into a left one
};
constexpr std::array<Part, 9> kCroppedParts = {
    {{PartKind::Leg, LeftKnee, {LeftKnee, LeftHip}, 1, false},
     {PartKind::Leg, RightKnee, {RightKnee, RightHip}, 1, true},
     {PartKind::Arm, LeftElbow, {LeftElbow, LeftShoulder}, 1, false},
     {PartKind::Arm, RightElbow, {RightElbow, RightShoulder}, 1, true},
     {PartKind::Hand, LeftWrist, {LeftWrist, -1}, 1, false},
     {PartKind::Hand, RightWrist, {RightWrist, -1}, 1, true},
     {PartKind::Head, Head, {Head, Neck}, 1, false},
     {PartKind::Foot, LeftAnkle, {LeftAnkle, LeftFoot}, 2, false},
     {PartKind::Foot, RightAnkle, {RightAnkle, RightFoot}, 2, true}}};

/// Input of the part network.
struct PartCrop {
  Points points;  ///< [rows_of(kind), 3] points or patches, in the joint's frame, in leg lengths
  /// parent's bone and rotation in that frame, the second joint, how full it is
  Eigen::Matrix<float, kPartContext, 1> context;
};

/// The finite points of a scan (metres) around the part, at the place that the extraction gives it; the
/// extraction must have rotations. Points repeat where there are few; no crop where there are fewer than 16.
/// `first` shifts the choice where there are more than enough.
std::optional<PartCrop> cut_part(const Points& scan, const Extraction& seen, const Part& part,
                                 uint32_t first = 0);

/// A world rotation in the frame of a crop, and back: labels and predictions.
Mat3 into_part(const Mat3& world, const Extraction& seen, const Part& part);
Mat3 from_part(const Mat3& local, const Extraction& seen, const Part& part);
/// The same for a displacement: metres in the world, leg lengths in the crop.
Vec3 vector_into_part(const Vec3& world, const Extraction& seen, const Part& part);
Vec3 vector_from_part(const Vec3& local, const Extraction& seen, const Part& part);

}  // namespace understudy::nn
