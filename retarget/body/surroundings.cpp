#include "retarget/body/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/body/furniture.hpp"
#include "retarget/math/directions.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/segment.hpp"

namespace understudy {
namespace {

constexpr float kClear = 0.12f;  // metres from the bones: what stands about somebody is not in them
constexpr float kSole = 0.05f;   // metres below the lowest joint
constexpr int kTriesAPoint = 4;  // those not clear are given up

float size_of(const PosedSkeleton& first) {
  return leg_length(first.joints) / 0.85f;
}

float ground_of(const PosedSkeleton& first) {
  return first.joints.col(1).minCoeff() - kSole * size_of(first);
}

/// Straight below the pelvis.
Vec3 foot_point(const PosedSkeleton& first) {
  return {first.joints(Pelvis, 0), ground_of(first), first.joints(Pelvis, 2)};
}

bool is_clear(const Vec3& x, const PosedSkeleton& first) {
  const float clear = kClear * size_of(first);
  for (int j = 1; j < kJointCount; ++j)
    if (from_segment(x, first.joints.row(kParents[j]).transpose(), first.joints.row(j).transpose())
            .squaredNorm() < clear * clear)
      return false;
  return true;
}

int share_of(const LabelledPoints& cloud, float share) {
  return static_cast<int>(share * static_cast<float>(cloud.points.rows()));
}

void append_thing(LabelledPoints& cloud, const std::vector<Vec3>& points) {
  append(cloud, points, std::vector<int>(points.size(), kNoBody));
}

/// A level direction, all alike likely.
Vec3 level_direction(Rng& rng) {
  return rotation_about_y(rng.uniform(-kPi, kPi)).col(2);
}

/// What is left of a piece of furniture in a cloud: what is within `reach` of a place, with noise.
struct SeenFurniture {
  Furniture thing;
  Vec3 near = Vec3::Zero();
  float reach = 10, noise = 0;

  std::vector<Vec3> sample(int count, const PosedSkeleton& first, Rng& rng) const;
};

std::vector<Vec3> SeenFurniture::sample(int count, const PosedSkeleton& first, Rng& rng) const {
  const float surface = surface_of(thing);
  std::vector<Vec3> points;
  for (int i = 0; i < kTriesAPoint * count && points.size() < static_cast<size_t>(count); ++i) {
    const Vec3 on = sample_of(thing, surface, rng);
    const Vec3 x = on + noise * Vec3(rng.normal(), rng.normal(), rng.normal());
    if ((x - near).norm() < reach && is_clear(x, first)) points.push_back(x);
  }
  return points;
}

}  // namespace

void add_ground(LabelledPoints& cloud, const PosedSkeleton& first, SceneRandom random) {
  auto& [scene, rng] = random;
  const Vec3 foot = foot_point(first);
  const float size = size_of(first), noise = scene.uniform(0.001f, 0.02f);
  const float slope_x = 0.03f * scene.normal(), slope_z = 0.03f * scene.normal(),
              rise = 0.01f * scene.normal();
  const int pieces = 1 + scene.below(4), count = share_of(cloud, scene.uniform(0.02f, 0.25f)) / pieces;
  std::vector<Vec3> points;
  for (int p = 0; p < pieces; ++p) {
    const Vec3 centre = foot + size * scene.uniform(0.0f, 0.7f) * level_direction(scene);
    const float radius = size * scene.uniform(0.08f, pieces == 1 ? 1.0f : 0.4f);
    for (int i = 0; i < count; ++i) {
      const Vec3 x = centre + radius * std::sqrt(rng.uniform()) * level_direction(rng);
      const float height = slope_x * (x.x() - foot.x()) + slope_z * (x.z() - foot.z()) + rise;
      points.emplace_back(x.x(), foot.y() + height + noise * rng.normal(), x.z());
    }
  }
  append_thing(cloud, points);
}

void add_furniture(LabelledPoints& cloud, const PosedSkeleton& first, SceneRandom random) {
  auto& [scene, rng] = random;
  SeenFurniture thing{any_furniture(size_of(first), scene)};
  const Vec3 way = level_direction(scene);
  place(thing.thing, foot_point(first) + size_of(first) * scene.uniform(0.35f, 1.1f) * way,
        rotation_about_y(scene.uniform(-kPi, kPi)));
  thing.near = first.joints.row(Pelvis).transpose() + scene.uniform(0.2f, 0.7f) * way +
               Vec3(0, scene.uniform(-0.7f, 0.4f), 0);
  thing.reach = scene.chance(0.5f) ? scene.uniform(0.3f, 0.7f) : 2.0f;
  thing.noise = scene.uniform(0.0f, 0.008f);
  const int count = share_of(cloud, scene.uniform(0.02f, 0.3f));
  append_thing(cloud, thing.sample(count, first, rng));
}

void add_chair_below(LabelledPoints& cloud, const PosedSkeleton& first, SceneRandom random) {
  auto& [scene, rng] = random;
  const float size = size_of(first), ground = ground_of(first);
  const float hips = 0.5f * (first.joints(LeftHip, 1) + first.joints(RightHip, 1)) - 0.13f * size;
  SeenFurniture thing{chair(std::max(0.2f, hips - ground), scene)};
  const Mat3 heading = rotation_about_y(heading_of(first.global[Pelvis]) + 0.15f * scene.normal());
  place(thing.thing, foot_point(first) + heading.col(2) * size * scene.uniform(-0.05f, 0.15f), heading);
  thing.near = first.joints.row(Pelvis).transpose();
  thing.noise = scene.uniform(0.0f, 0.008f);
  const int count = share_of(cloud, scene.uniform(0.05f, 0.4f));
  append_thing(cloud, thing.sample(count, first, rng));
}

void add_loose_ball(LabelledPoints& cloud, const PosedSkeleton& first, SceneRandom random) {
  auto& [scene, rng] = random;
  const float size = size_of(first), radius = scene.uniform(0.05f, 0.35f);
  const float height = scene.chance(0.6f) ? radius : scene.uniform(radius, 1.8f * size);
  const Vec3 centre = foot_point(first) +
                      (radius + size * scene.uniform(0.2f, 0.9f)) * level_direction(scene) +
                      Vec3(0, height, 0);
  const auto count = static_cast<int>(density(cloud, first) * 4 * kPi * radius * radius);
  std::vector<Vec3> points;
  for (int i = 0; i < std::min(count, share_of(cloud, 0.4f)); ++i) {
    const Vec3 x = centre + radius * random_direction(rng);
    if (is_clear(x, first)) points.push_back(x);
  }
  append_thing(cloud, points);
}

Vec3 shift_beside(const PosedSkeleton& first, const PosedSkeleton& other, Rng& scene) {
  return foot_point(first) - foot_point(other) +
         size_of(first) * scene.uniform(0.4f, 1.2f) * level_direction(scene);
}

void add_piece(LabelledPoints& cloud, const PosedSkeleton& first, const LabelledPoints& other,
               const PosedSkeleton& others, SceneRandom random) {
  Rng& scene = random.scene;
  const Vec3 centre = others.joints.row(scene.below(kJointCount)).transpose();
  const float reach = size_of(first) * scene.uniform(0.12f, 0.5f);
  const int most = share_of(cloud, 0.3f);
  std::vector<Vec3> points;
  for (Eigen::Index i = 0; i < other.points.rows() && points.size() < static_cast<size_t>(most); ++i) {
    const Vec3 x = other.points.row(i).transpose();
    if ((x - centre).norm() < reach && is_clear(x, first)) points.push_back(x);
  }
  append_thing(cloud, points);
}

}  // namespace understudy
