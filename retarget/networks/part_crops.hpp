// Arms, legs, hands, head and feet seen from near: points of a scan around a joint, in the joint's own
// frame.
#pragma once

#include <array>
#include <optional>

#include "retarget/geometry/mesh.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

enum class PartKind { Hand, Head, Foot, Arm, Leg };
constexpr int kPartKinds = 5;
constexpr int kPartPoints = 128;  ///< points of a crop
constexpr int kPartContext = 13;  ///< numbers that go with it
constexpr int kPartJoints = 2;    ///< joints of which something is told

/// A joint that is seen again, and what is corrected there.
struct Part {
  PartKind kind;
  int joint;                              ///< the crop is about it and in its frame
  std::array<int, kPartJoints> corrects;  ///< joints whose rotations and places are told, -1: none
  int moves;  ///< so many of them are put where they were told to be: the others are better known from afar
  bool mirrored;  ///< a right one, looked at as a left one
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

/// What a network sees of a part.
struct PartCrop {
  Points points;  ///< [kPartPoints, 3] in the joint's frame, in leg lengths
  Eigen::Matrix<float, kPartContext, 1>
      context;  ///< parent's bone and rotation in that frame, the second joint, how full it is
};

/// Points of the scan (finite ones, metres) around the part as the extraction, which must have rotations,
/// says it lies; repeated where there are few. None where fewer than 16 are there. `first` picks which are
/// taken where there are more than enough.
std::optional<PartCrop> cut_part(const Points& scan, const Extraction& seen, const Part& part,
                                 uint32_t first = 0);

/// A rotation of the world in the frame of a crop, and back: what the network is to say and what was said.
Mat3 into_part(const Mat3& world, const Extraction& seen, const Part& part);
Mat3 from_part(const Mat3& local, const Extraction& seen, const Part& part);
/// The same of a way in the world, metres; in the crop it is in leg lengths.
Vec3 vector_into_part(const Vec3& world, const Extraction& seen, const Part& part);
Vec3 vector_from_part(const Vec3& local, const Extraction& seen, const Part& part);

}  // namespace understudy::nn
