#include "retarget/body/depth_cameras.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/body/cell_image.hpp"
#include "retarget/math/directions.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

// Of a structured-light camera, by the distance squared: noise, and the step of one disparity.
constexpr float kStructuredNoise = 1.425e-3f, kStructuredStep = 2.85e-3f;
constexpr float kPixelCell = 0.04f, kOneSurface = 0.05f;  // metres
constexpr float kMostShift = 0.03f, kMostTurn = 0.017f, kMostLate = 0.45f;
constexpr float kFarthestFlight = 0.4f;  // metres
constexpr size_t kLeastSeen = 200;

// Clothes that are of one colour.
const std::array<std::vector<int>, 4> kClothes = {
    {{Pelvis, LeftHip, RightHip, LeftKnee, RightKnee},
     {Spine1, Spine2, Spine3, LeftCollar, RightCollar, LeftShoulder, RightShoulder},
     {LeftShoulder, RightShoulder, LeftElbow, RightElbow},
     {LeftAnkle, RightAnkle, LeftFoot, RightFoot}}};

float capped_normal(float spread, float most, Rng& rng) {
  return std::clamp(spread * rng.normal(), -most, most);
}

DepthCamera random_camera(const Vec3& at, float angle, float distance, Rng& rng) {
  DepthCamera camera;
  camera.at = at + 0.1f * Vec3(rng.normal(), rng.normal(), rng.normal());
  camera.eye = at + Vec3(distance * std::sin(angle), rng.uniform(-0.5f, 1.4f), distance * std::cos(angle));
  if (rng.chance(0.45f)) {
    const float quality = rng.uniform(0.25f, 1.0f);
    camera.noise = quality * kStructuredNoise;
    camera.step = quality * kStructuredStep;
    camera.flying = rng.uniform(0.0f, 0.04f);
  } else {
    camera.noise = rng.uniform(1e-4f, 8e-4f);
    camera.floor_noise = rng.uniform(0.0005f, 0.003f);
    camera.flying = rng.uniform(0.01f, 0.15f);
  }
  return camera;
}

void misalign(DepthCamera& camera, Rng& rng) {
  camera.shift = capped_normal(0.012f, kMostShift, rng) * random_direction(rng);
  camera.turn = rotation_from_axis_angle(capped_normal(0.006f, kMostTurn, rng) * random_direction(rng));
  camera.late = rng.uniform(-kMostLate, kMostLate);
}

/// Whether a sensor hardly sees a point.
bool is_dark(const Vec3& x, int part, const DarkCloth& dark, const PosedSkeleton& truth) {
  if (part >= kJointCount) return false;
  const Vec3 own = truth.global[part].transpose() * (x - truth.joints.row(part).transpose());
  if (part == Head) return dark.is_hair_lost && (own.y() > 0.12f || (own.y() > 0.03f && own.z() < 0));
  if (dark.group < 0) return false;
  const auto& parts = kClothes[dark.group];
  return std::find(parts.begin(), parts.end(), part) != parts.end() &&
         std::sin(dark.wave.dot(own)) > dark.edge;
}

/// The distance along the ray as the camera measures it.
float measured(float distance, const DepthCamera& camera, Rng& rng) {
  const float square = distance * distance;
  distance += std::hypot(camera.floor_noise, camera.noise * square) * rng.normal();
  if (camera.step <= 0) return distance;
  return 1 / (std::max(1.0f, std::round(1 / (distance * camera.step))) * camera.step);  // whole disparities
}

struct Sight {
  int camera = -1;  // that measures the point; -1: nobody sees it
  bool at_edge = false;
};

/// The points in a camera's field of view.
std::vector<int> in_view(const Points& points, const DepthCamera& camera) {
  const Mat3 axes = camera_axes(camera.eye, camera.at);
  std::vector<int> rows;
  for (int i = 0; i < points.rows(); ++i) {
    const Vec3 own = axes.transpose() * (points.row(i).transpose() - camera.eye);
    if (camera.widest <= 0 || own.head<2>().cwiseAbs().maxCoeff() < camera.widest * own.z())
      rows.push_back(i);
  }
  return rows;
}

/// Which camera measures each point: near ones more often, as they have more pixels there.
std::vector<Sight> who_sees(const Points& points, const std::vector<DepthCamera>& cameras, Rng& rng) {
  std::vector<Sight> sights(points.rows());
  std::vector<float> total(points.rows(), 0);
  for (size_t c = 0; c < cameras.size(); ++c) {
    const DepthCamera& camera = cameras[c];
    const std::vector<int> rows = in_view(points, camera);
    const Points seen = seen_from(points(rows, Eigen::all), camera.eye, camera.at, kPixelCell);
    const CellImage image(seen);
    for (int i = 0; i < seen.rows(); ++i) {
      if (!image.shows(i, kOneSurface)) continue;
      const float weight = 1 / std::max(0.04f, seen(i, 2) * seen(i, 2));
      float& sum = total[rows[i]];
      sum += weight;
      if (rng.chance(weight / sum))
        sights[rows[i]] = {static_cast<int>(c), image.is_at_edge(i, 2 * kOneSurface)};
    }
  }
  return sights;
}

}  // namespace

DarkCloth random_dark_cloth(Rng& rng) {
  DarkCloth dark;
  if (rng.chance(0.25f)) dark.group = rng.below(kClothes.size());
  dark.is_hair_lost = rng.chance(0.25f);
  dark.left = rng.uniform(0.0f, 0.4f);
  dark.edge = rng.uniform(-1.2f, 0.6f);
  dark.wave = rng.uniform(10.0f, 40.0f) * random_direction(rng);
  return dark;
}

DepthRig random_depth_rig(const PosedSkeleton& first, Rng& rng) {
  constexpr std::array<int, 8> kCounts = {1, 1, 2, 3, 4, 5, 7, 10};
  const int count = kCounts[rng.below(kCounts.size())];
  const Vec3 at = 0.5f * (first.joints.row(Pelvis) + first.joints.row(Spine3)).transpose();
  return random_depth_rig({count, at}, rng);
}

DepthRig random_depth_rig(const RigPlace& place, Rng& rng) {
  const float begin = rng.uniform(-kPi, kPi), distance = rng.uniform(place.nearest, place.farthest);
  // Some rigs stand about somebody, others all on one side.
  const float around = rng.chance(0.7f) ? 2 * kPi : 2.0f;
  DepthRig rig;
  for (int i = 0; i < place.cameras; ++i) {
    const float share =
        (static_cast<float>(i) + 0.3f * rng.uniform(-1, 1)) / static_cast<float>(place.cameras);
    const float away = distance * rng.uniform(0.9f, 1.12f);
    rig.cameras.push_back(random_camera(place.at, begin + around * share, away, rng));
    if (place.cameras > 1) misalign(rig.cameras.back(), rng);
  }
  rig.dark = random_dark_cloth(rng);
  return rig;
}

SeenSurface surface_to_see(const LabelledPoints& cloud, const DarkCloth& dark, const PosedSkeleton& truth,
                           const PosedSkeleton& beside) {
  SeenSurface surface{cloud.points, cloud.points, std::vector<float>(cloud.parts.size(), 1)};
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const int part = cloud.parts[i];
    if (part >= kJointCount) continue;
    const Vec3 x = cloud.points.row(i);
    const Vec3 own = truth.global[part].transpose() * (x - truth.joints.row(part).transpose());
    surface.beside.row(i) = (beside.global[part] * own).transpose() + beside.joints.row(part);
    if (is_dark(x, part, dark, truth)) surface.returned[i] = dark.left;
  }
  return surface;
}

std::vector<DepthReading> depth_readings(const SeenSurface& surface, const std::vector<DepthCamera>& cameras,
                                         Rng& rng) {
  const std::vector<Sight> sights = who_sees(surface.now, cameras, rng);
  std::vector<DepthReading> readings;
  for (int i = 0; i < surface.now.rows(); ++i) {
    if (sights[i].camera < 0) continue;
    if (surface.returned[i] < 1 && !rng.chance(surface.returned[i])) continue;
    const DepthCamera& camera = cameras[sights[i].camera];
    const Vec3 now = surface.now.row(i), there = surface.beside.row(i);
    const Vec3 ray = now + camera.late * (there - now) - camera.eye;
    DepthReading reading{i, Vec3::Zero()};
    const float distance = measured(ray.norm(), camera, rng);
    if (sights[i].at_edge && rng.chance(camera.flying)) reading.behind = rng.uniform(0, kFarthestFlight);
    const Vec3 seen = camera.eye + (distance + reading.behind) * ray.normalized();
    reading.place = camera.at + camera.turn * (seen - camera.at) + camera.shift;
    readings.push_back(reading);
  }
  return readings;
}

void see_with_depth_cameras(LabelledPoints& cloud, const DepthRig& rig, const PosedSkeleton& truth,
                            const PosedSkeleton& beside, Rng& rng) {
  const std::vector<DepthReading> readings =
      depth_readings(surface_to_see(cloud, rig.dark, truth, beside), rig.cameras, rng);
  if (readings.size() < kLeastSeen) return;
  LabelledPoints seen;
  seen.points.resize(static_cast<Eigen::Index>(readings.size()), 3);
  for (size_t i = 0; i < readings.size(); ++i) {
    seen.points.row(i) = readings[i].place.transpose();
    seen.parts.push_back(readings[i].flies() ? kNoBody : cloud.parts[readings[i].row]);
  }
  cloud = std::move(seen);
}

}  // namespace understudy
