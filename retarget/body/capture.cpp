#include "retarget/body/capture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

struct Camera {
  Vec3 eye, right, up, forward;
  float gain;  // share of its pixels that give a point
};

struct Sighting {
  Vec3 point;
  Vec3 ray;  // unit, from the camera
};

std::vector<Camera> rig(const Vec3& centre, const CaptureOptions& options) {
  Rng rng(options.seed * 0x9e37u + 11);
  std::vector<Camera> cameras;
  for (int i = 0; i < options.views; ++i) {
    const float angle =
        2 * kPi * (static_cast<float>(i) + rng.uniform(-0.15f, 0.15f)) / static_cast<float>(options.views);
    Camera c;
    c.eye =
        Vec3(2.8f * std::sin(angle), (i % 2 ? 2.2f : 0.9f) + rng.uniform(-.2f, .2f), 2.8f * std::cos(angle));
    c.eye += Vec3(centre.x(), 0, centre.z());
    c.forward = (centre - c.eye).normalized();
    c.right = c.forward.cross(Vec3::UnitY()).normalized();
    c.up = c.right.cross(c.forward);
    c.gain = rng.uniform(0.35f, 1.0f);
    cameras.push_back(c);
  }
  return cameras;
}

/// What one camera sees: the nearest surface in each of its pixels, thinned where it is seen at a slant.
class DepthView {
 public:
  static constexpr int kPixels = 200;

  DepthView(const Camera& camera, const Points& vertices, const Faces& faces, float size)
      : camera_(camera),
        scale_(kPixels / (1.15f * size)),
        depth_(kPixels * kPixels, 1e9f),
        facing_(kPixels * kPixels, 0.0f) {
    distance_ = (vertices.colwise().mean().transpose() - camera.eye).dot(camera.forward);
    for (int f = 0; f < faces.rows(); ++f) {
      std::array<Vec3, 3> corners;
      for (int c = 0; c < 3; ++c) corners[c] = vertices.row(faces(f, c)).transpose();
      const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      const float facing = -normal.normalized().dot((corners[0] - camera.eye).normalized());
      if (facing > 0) draw({pixel(corners[0]), pixel(corners[1]), pixel(corners[2])}, facing);
    }
  }

  void sightings(float share, Rng& rng, std::vector<Sighting>& out) const {
    for (int y = 0; y < kPixels; ++y)
      for (int x = 0; x < kPixels; ++x) {
        const float z = depth_[y * kPixels + x], facing = facing_[y * kPixels + x];
        if (z > 1e8f || facing < 0.12f || !rng.chance(share * camera_.gain * std::min(1.0f, 0.25f + facing)))
          continue;
        const float half = 0.5f * kPixels, u = (static_cast<float>(x) + rng.uniform() - half) / scale_,
                    v = (half - static_cast<float>(y) - rng.uniform()) / scale_;
        const Vec3 ray = (camera_.forward * distance_ + camera_.right * u + camera_.up * v) / distance_;
        out.push_back({camera_.eye + z * ray, ray.normalized()});
      }
  }

 private:
  /// Column, row and depth along the camera's axis.
  Vec3 pixel(const Vec3& p) const {
    const Vec3 d = p - camera_.eye;
    const float z = d.dot(camera_.forward), k = scale_ * distance_ / z;
    return Vec3(0.5f * kPixels + k * d.dot(camera_.right), 0.5f * kPixels - k * d.dot(camera_.up), z);
  }

  void draw(const std::array<Vec3, 3>& q, float facing) {
    const auto cross = [](const Vec3& o, const Vec3& a, float x, float y) {
      return (a.x() - o.x()) * (y - o.y()) - (a.y() - o.y()) * (x - o.x());
    };
    const float area = cross(q[0], q[1], q[2].x(), q[2].y());
    if (std::abs(area) < 1e-9f) return;
    const auto range = [&](int axis) {
      const auto [low, high] = std::minmax({q[0][axis], q[1][axis], q[2][axis]});
      return std::make_pair(std::max(0, static_cast<int>(std::floor(low))),
                            std::min(kPixels - 1, static_cast<int>(std::ceil(high))));
    };
    const auto [x0, x1] = range(0);
    const auto [y0, y1] = range(1);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const float px = static_cast<float>(x) + .5f, py = static_cast<float>(y) + .5f;
        const float a = cross(q[1], q[2], px, py) / area, b = cross(q[2], q[0], px, py) / area, c = 1 - a - b;
        if (a < 0 || b < 0 || c < 0) continue;
        const float z = a * q[0].z() + b * q[1].z() + c * q[2].z();
        float& nearest = depth_[y * kPixels + x];
        if (z < nearest) nearest = z, facing_[y * kPixels + x] = facing;
      }
  }

  const Camera& camera_;
  float scale_, distance_ = 1;  // pixels a metre at the body; metres from camera to body
  std::vector<float> depth_, facing_;
};

struct Hole {
  Vec3 centre;
  float radius;
};

std::vector<Hole> holes(const Points& vertices, int count, Rng& rng) {
  std::vector<Hole> result;
  result.reserve(count);
  for (int i = 0; i < count; ++i)
    result.push_back({vertices.row(rng.below(vertices.rows())).transpose(), rng.uniform(.03f, .07f)});
  return result;
}

bool lost(const Vec3& p, const std::vector<Hole>& spots, Rng& rng) {
  for (const Hole& hole : spots)
    if ((p - hole.centre).norm() < hole.radius) return rng.chance(0.92f);
  return false;
}

/// Points of the floor in patches about the body, and strays in the air.
void add_clutter(const Vec3& centre, float size, int body_count, const CaptureOptions& options, Rng& rng,
                 std::vector<Vec3>& points) {
  const auto share = [&](float part) {
    return static_cast<int>(std::lround(part * static_cast<float>(body_count) * rng.uniform(.7f, 1.3f)));
  };
  const float turn = rng.uniform(0, 2 * kPi);
  for (int i = share(options.floor); i > 0; --i) {
    const float angle = turn + 2.2f * (rng.uniform() + rng.uniform()),
                radius = (.08f + .22f * std::sqrt(rng.uniform())) * size;
    points.emplace_back(centre.x() + radius * std::cos(angle), options.noise * rng.normal(),
                        centre.z() + radius * std::sin(angle));
  }
  for (int i = share(options.outliers); i > 0; --i) {
    const Vec3 off(rng.normal(), rng.normal(), rng.normal());
    Vec3 p = centre + .28f * size * off;
    p.y() = std::max(p.y(), 0.0f);
    points.push_back(p);
  }
}

}  // namespace

Mesh simulated_capture(const Points& vertices, const Faces& faces, int frame, const CaptureOptions& options) {
  US_CHECK(faces.rows() > 0 && vertices.rows() > 0, "a mesh without faces cannot be captured");
  US_CHECK(options.views >= 1 && options.points >= 1 && options.noise >= 0 && options.outliers >= 0 &&
               options.floor >= 0,
           "the capture's options are out of range");
  US_CHECK(vertices.allFinite(), "the body to capture has numbers that are not finite");
  Rng rng(options.seed * 1000003u + static_cast<uint64_t>(frame) * 7919u + 5);
  const Vec3 low = vertices.colwise().minCoeff(), high = vertices.colwise().maxCoeff(),
             centre = 0.5f * (low + high);
  const float size = (high - low).norm();

  std::vector<Sighting> seen;
  for (const Camera& camera : rig(Vec3(centre.x(), centre.y(), centre.z()), options))
    DepthView(camera, vertices, faces, size).sightings(rng.uniform(.75f, 1.0f), rng, seen);
  const std::vector<Hole> spots = holes(vertices, options.holes, rng);

  const float keep = static_cast<float>(options.points) * rng.uniform(.84f, 1.16f) /
                     static_cast<float>(std::max<size_t>(seen.size(), 1));
  std::vector<Vec3> points;
  for (const Sighting& s : seen) {
    if (!rng.chance(keep) || lost(s.point, spots, rng)) continue;
    const Vec3 side(rng.normal(), rng.normal(), rng.normal());
    points.push_back(s.point + options.noise * rng.normal() * s.ray + 0.3f * options.noise * side);
  }
  add_clutter(centre, size, points.size(), options, rng, points);
  for (int i = points.size() - 1; i > 0; --i) std::swap(points[i], points[rng.below(i + 1)]);

  Mesh cloud;
  cloud.vertices.resize(points.size(), 3);
  for (size_t i = 0; i < points.size(); ++i) cloud.vertices.row(i) = points[i].transpose();
  return cloud;
}

}  // namespace understudy
