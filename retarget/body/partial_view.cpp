#include "retarget/body/partial_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "retarget/body/block.hpp"
#include "retarget/body/cell_image.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr size_t kLeastLeft = 200;  // points
constexpr float kCellMetres = 0.03f, kSameSurface = 0.05f;

Vec3 place_of(const PosedSkeleton& first, int joint) {
  return first.joints.row(joint).transpose();
}

/// A random direction near another.
Vec3 tilted(const Vec3& direction, float spread, Rng& rng) {
  const Vec3 off(rng.normal(), rng.normal(), rng.normal());
  return (direction + spread * off).normalized();
}

/// Keeps what is on the normal's side of a plane.
void keep_beyond(LabelledPoints& cloud, const Vec3& through, const Vec3& normal) {
  std::vector<int> kept;
  for (int i = 0; i < cloud.points.rows(); ++i)
    if ((cloud.points.row(i).transpose() - through).dot(normal) > 0) kept.push_back(i);
  if (kept.size() >= kLeastLeft) keep_rows(cloud, kept);
}

/// Somewhere between two joints, or a little beyond them.
Vec3 between(const PosedSkeleton& first, int upper, int lower, Rng& rng) {
  const float share = rng.uniform(-0.2f, 1.2f);
  return (1 - share) * place_of(first, upper) + share * place_of(first, lower);
}

struct Desk {
  Block block;
  Vec3 eye;
  bool is_seen_from_one_side, is_in_cloud;

  Desk(const PosedSkeleton& first, Rng& rng);
};

Desk::Desk(const PosedSkeleton& first, Rng& rng) {
  const float size = leg_length(first.joints) / 0.85f;
  const Mat3 heading = rotation_about_y(heading_of(first.global[Pelvis]));
  const Vec3 pelvis = place_of(first, Pelvis);
  const float top = size * rng.uniform(0.02f, 0.3f), near_edge = size * rng.uniform(0.18f, 0.4f);
  const float deep = rng.uniform(0.4f, 0.9f), wide = rng.uniform(0.8f, 2.0f);
  const float thick = rng.chance(0.3f) ? 0.04f : 1.5f;  // a top on legs, or closed to the floor
  block.axes = heading * rotation_about_y(0.15f * rng.normal());
  block.half = 0.5f * Vec3(wide, thick, deep);
  block.centre = pelvis + heading * Vec3(0.2f * rng.normal(), top - 0.5f * thick, near_edge + 0.5f * deep);
  const Mat3 turn = heading * rotation_about_y(rng.uniform(-0.9f, 0.9f));
  eye = pelvis + turn * Vec3(0, 0, rng.uniform(1.2f, 3.0f)) + Vec3(0, top + rng.uniform(0.05f, 0.9f), 0);
  is_seen_from_one_side = rng.chance(0.75f);
  is_in_cloud = rng.chance(0.5f);
}

/// Some of the desk's top, near the person.
std::vector<Vec3> top_points(const Desk& desk, float per_square_metre, Rng& rng) {
  const float deep = 0.5f * desk.block.half.z();  // the nearer half of it
  const float wide = std::min(desk.block.half.x(), 0.5f);
  std::vector<Vec3> points(
      static_cast<size_t>(per_square_metre * 2 * deep * 2 * wide * rng.uniform(0.1f, 0.6f)));
  for (Vec3& x : points) {
    const Vec3 own(wide * rng.uniform(-1, 1), desk.block.half.y() + 0.004f * rng.normal(),
                   -desk.block.half.z() + 2 * deep * rng.uniform());
    x = desk.block.centre + desk.block.axes * own;
  }
  return points;
}

}  // namespace

void cut_below(LabelledPoints& cloud, const PosedSkeleton& first, BodyCut cut, Rng& rng) {
  constexpr std::array<std::array<Joint, 2>, 4> kBetween = {
      {{Spine3, Spine1}, {Spine1, LeftHip}, {LeftHip, LeftKnee}, {LeftKnee, LeftAnkle}}};
  const auto [upper, lower] = kBetween[static_cast<size_t>(cut)];
  const Vec3 through = between(first, upper, lower, rng);
  keep_beyond(cloud, through, tilted(Vec3::UnitY(), 0.08f, rng));
}

void cut_below(LabelledPoints& cloud, const PosedSkeleton& first, Rng& rng) {
  const float level = rng.uniform();
  const BodyCut cut = level < 0.3f    ? BodyCut::Chest
                      : level < 0.65f ? BodyCut::Hips
                      : level < 0.9f  ? BodyCut::Knees
                                      : BodyCut::Shins;
  cut_below(cloud, first, cut, rng);
}

void cut_beside(LabelledPoints& cloud, const PosedSkeleton& first, Rng& rng) {
  const bool left = rng.chance(0.5f);
  const Vec3 own = place_of(first, left ? RightShoulder : LeftShoulder) -
                   place_of(first, left ? LeftShoulder : RightShoulder);  // from the arm that is lost
  const Vec3 level = rotation_about_y(0.5f * rng.normal()) * Vec3(own.x(), 0, own.z());
  if (level.norm() < 0.05f) return;  // lying on a side: no upright plane parts the shoulders
  const Vec3 normal = tilted(level.normalized(), 0.06f, rng);
  const float inwards = leg_length(first.joints) * rng.uniform(-0.12f, 0.12f);
  keep_beyond(cloud, place_of(first, left ? LeftShoulder : RightShoulder) + inwards * normal, normal);
}

void put_behind_desk(LabelledPoints& cloud, const PosedSkeleton& first, Rng& rng) {
  const Desk desk(first, rng);
  const float per_square_metre = density(cloud, first);
  std::vector<int> kept;
  for (int i = 0; i < cloud.points.rows(); ++i)
    if (!desk.block.blocks(desk.eye, cloud.points.row(i))) kept.push_back(i);
  if (kept.size() < kLeastLeft) return;
  keep_rows(cloud, kept);
  if (desk.is_seen_from_one_side) {
    const CellImage image(seen_from(cloud.points, desk.eye, place_of(first, Spine3), kCellMetres));
    std::vector<int> shown;
    for (int i = 0; i < cloud.points.rows(); ++i)
      if (image.shows(i, kSameSurface)) shown.push_back(i);
    if (shown.size() >= kLeastLeft) keep_rows(cloud, shown);
  }
  if (!desk.is_in_cloud) return;
  const std::vector<Vec3> top = top_points(desk, per_square_metre, rng);
  append(cloud, top, std::vector<int>(top.size(), kNoBody));
}

}  // namespace understudy
