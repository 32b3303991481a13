#include "retarget/networks/part_crops.hpp"

#include <algorithm>
#include <vector>

#include "retarget/math/rotation.hpp"

namespace understudy::nn {
namespace {

constexpr int kFewest = 16;

/// Where the middle of a hand, head or foot is from its joint, T-pose axes of a left one, and how far it
/// reaches with some room for errors of the joint; in leg lengths.
struct Reach {
  Vec3 middle;
  float radius;
};
const Reach& reach_of(PartKind kind) {
  static const std::array<Reach, kPartKinds> reaches = {{{Vec3(0.085f, 0, 0), 0.18f},
                                                         {Vec3(0, 0.11f, 0.03f), 0.23f},
                                                         {Vec3(0, -0.035f, 0.07f), 0.20f},
                                                         {Vec3(0, 0, 0), 0.28f},
                                                         {Vec3(0, 0, 0), 0.30f}}};
  return reaches[static_cast<int>(kind)];
}

/// x to -x and back.
Mat3 mirrored(const Mat3& R) {
  const Vec3 flip(-1, 1, 1);
  return flip.asDiagonal() * R * flip.asDiagonal();
}

const Mat3& frame_of(const Extraction& seen, const Part& part) {
  return (*seen.global)[part.joint];
}

/// Some points at a time, first all distances, then what they are compared with: the compiler turns both into
/// vector instructions.
std::vector<int> points_within(const Points& scan, const Vec3& middle, float radius) {
  constexpr Eigen::Index kRun = 64;
  const float most = radius * radius;
  std::array<float, kRun> squared;
  std::array<int, kRun> found;
  std::vector<int> near;
  for (Eigen::Index from = 0; from < scan.rows(); from += kRun) {
    const Eigen::Index count = std::min(kRun, scan.rows() - from);
    const float* const point = scan.data() + 3 * from;
    for (Eigen::Index i = 0; i < count; ++i) {
      const float x = point[3 * i] - middle.x(), y = point[3 * i + 1] - middle.y(),
                  z = point[3 * i + 2] - middle.z();
      squared[i] = x * x + (y * y + z * z);
    }
    size_t within = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
      found[within] = static_cast<int>(from + i);
      within += squared[i] < most ? 1 : 0;
    }
    near.insert(near.end(), found.begin(), found.begin() + within);
  }
  return near;
}

}  // namespace

Mat3 into_part(const Mat3& world, const Extraction& seen, const Part& part) {
  const Mat3 local = frame_of(seen, part).transpose() * world;
  return part.mirrored ? mirrored(local) : local;
}

Mat3 from_part(const Mat3& local, const Extraction& seen, const Part& part) {
  return frame_of(seen, part) * (part.mirrored ? mirrored(local) : local);
}

Vec3 vector_into_part(const Vec3& world, const Extraction& seen, const Part& part) {
  const Vec3 local = frame_of(seen, part).transpose() * world / leg_length(seen.joints);
  return part.mirrored ? Vec3(-local.x(), local.y(), local.z()) : local;
}

Vec3 vector_from_part(const Vec3& local, const Extraction& seen, const Part& part) {
  const Vec3 side(part.mirrored ? -1.0f : 1.0f, 1, 1);
  return frame_of(seen, part) * local.cwiseProduct(side) * leg_length(seen.joints);
}

std::optional<PartCrop> cut_part(const Points& scan, const Extraction& seen, const Part& part,
                                 uint32_t first) {
  const float size = leg_length(seen.joints);
  const Mat3& R = frame_of(seen, part);
  const Vec3 joint = seen.joints.row(part.joint).transpose(), side(part.mirrored ? -1.0f : 1.0f, 1, 1);
  const Reach& reach = reach_of(part.kind);
  const Vec3 middle = joint + size * (R * side.cwiseProduct(reach.middle));
  const std::vector<int> near = points_within(scan, middle, size * reach.radius);
  if (static_cast<int>(near.size()) < kFewest || !(size > 1e-4f)) return std::nullopt;
  // Spread over all of them: scans are often sorted along the body.
  const bool in_patches = seen_in_patches(part.kind);
  const size_t count = near.size(), most = in_patches ? kFinePoints : kPartPoints,
               taken = in_patches ? std::min(count, most) : most;
  Points points(taken, 3);
  for (size_t i = 0; i < taken; ++i) {
    const size_t at = count > most ? (i * count / most + first) % count : i % count;
    const Vec3 x = R.transpose() * (scan.row(near[at]).transpose() - joint) / size;
    points.row(i) = x.cwiseProduct(side).transpose();
  }
  PartCrop crop;
  crop.points = in_patches ? cut_part_patches(points) : std::move(points);
  const int parent = kParents[part.joint];
  const Vec3 bone = R.transpose() * (seen.joints.row(parent).transpose() - joint) / size;
  crop.context.head<3>() = bone.cwiseProduct(side);
  crop.context.segment<6>(3) = rotation_to_6d(into_part((*seen.global)[parent], seen, part));
  const int second = part.corrects[1] < 0 ? part.joint : part.corrects[1];
  crop.context.segment<3>(9) =
      vector_into_part((seen.joints.row(second) - seen.joints.row(part.joint)).transpose(), seen, part);
  crop.context[12] = std::min(1.0f, static_cast<float>(count) / most);
  return crop;
}

}  // namespace understudy::nn
