#include "retarget/formats/room.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/geometry/cells.hpp"

namespace understudy {
namespace {

constexpr float kCoarse = 1 / 200.0f;             // of the extent
constexpr float kSmallest = 1.5f, kLargest = 60;  // metres that a room is long
constexpr float kBody_m2 = 0.12f;                 // of a body that is seen at least
constexpr float kLevel = 0.966f;                  // cosine of 15 degrees

Points outside(const Slab& slab, const Points& points) {
  Points off(points.rows(), 3);
  Eigen::Index count = 0;
  for (const auto& row : points.rowwise())
    if (std::abs(row.dot(slab.normal) - slab.height) >= slab.tolerance) off.row(count++) = row;
  off.conservativeResize(count, 3);
  return off;
}

Points inside(const Slab& slab, const Points& points) {
  Points on(points.rows(), 3);
  Eigen::Index count = 0;
  for (const auto& row : points.rowwise())
    if (std::abs(row.dot(slab.normal) - slab.height) < slab.tolerance) on.row(count++) = row;
  on.conservativeResize(count, 3);
  return on;
}

/// Least squares through the points in it; nothing where they are no wider than a strip.
std::optional<Slab> refined(const Slab& slab, const Points& points, float least_deviation) {
  const Points on = inside(slab, points);
  if (on.rows() < 32) return std::nullopt;
  const Vec3 mean = on.colwise().mean().transpose();
  const Points centred = on.rowwise() - mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(Mat3(centred.transpose() * centred));
  if (solver.eigenvalues()[1] < least_deviation * least_deviation * static_cast<float>(on.rows()))
    return std::nullopt;
  const Vec3 normal = solver.eigenvectors().col(0);
  return Slab{normal, normal.dot(mean), slab.tolerance};
}

/// The plane that holds most of the points, and few just beside it: a body that one goes through is as thick
/// as wide. extent: of the scan.
std::optional<Slab> largest_plane(const Points& points, float extent, Rng& rng) {
  constexpr int kTries = 1000, kLooked = 1500;
  constexpr float kNear = 0.35f, kThick = 0.008f, kDeviation = 0.08f, kBeside = 1.5f;
  const int count = static_cast<int>(points.rows());
  std::vector<int> looked(std::min(kLooked, count));
  for (int& i : looked) i = rng.below(count);
  const Points some = points(looked, Eigen::all);
  const auto pick = [&] { return Vec3(some.row(rng.below(static_cast<int>(some.rows()))).transpose()); };
  const auto pick_near = [&](const Vec3& a) {  // more often on the same plane
    Vec3 b = pick();
    for (int t = 0; t < 20 && (b - a).norm() > kNear * extent; ++t) b = pick();
    return b;
  };
  Slab best{Vec3::UnitY(), 0, kThick * extent};
  float most = 0;
  for (int t = 0; t < kTries; ++t) {
    const Vec3 a = pick(), b = pick_near(a), c = pick_near(a);
    const Vec3 normal = (b - a).cross(c - a);
    if (!(normal.norm() > best.tolerance * best.tolerance)) continue;
    const Vec3 unit = normal.normalized();
    const float height = unit.dot(a);
    const auto away = ((some * unit).array() - height).abs().eval();
    const auto on = static_cast<float>((away < best.tolerance).count()),
               near = static_cast<float>((away < 3 * best.tolerance).count());
    const float score = on - kBeside * (near - on);
    if (score > most) most = score, best.normal = unit, best.height = height;
  }
  if (most == 0) return std::nullopt;
  std::optional<Slab> plane = best;
  for (int k = 0; k < 2 && plane; ++k) plane = refined(*plane, points, kDeviation * extent);
  return plane;
}

std::vector<float> to_vector(const Eigen::VectorXf& values) {
  return {values.begin(), values.end()};
}

/// From end to end without a share of the values at either end.
float spread(const Eigen::VectorXf& values, float left_out) {
  std::vector<float> sorted = to_vector(values);
  std::sort(sorted.begin(), sorted.end());
  const auto low = static_cast<size_t>(left_out * static_cast<float>(sorted.size() - 1));
  return sorted[sorted.size() - 1 - low] - sorted[low];
}

float middle(std::vector<float> values) {
  std::nth_element(values.begin(), values.begin() + ssize(values) / 2, values.end());
  return values[values.size() / 2];
}

/// 1: the plane's normal points up, -1: down.
float sense_of(const Slab& plane, const UpAxis& up) {
  return (plane.normal[up.axis] > 0) == up.negative ? -1.0f : 1.0f;
}

/// How many times as wide as all that is on it a ground is; 0: it is not level, or much is below.
float width_of(const RoomView& view, const Slab& plane, const UpAxis& up) {
  constexpr float kBelow = 0.1f, kEnds = 0.05f;  // shares of all points
  if (std::abs(plane.normal[up.axis]) < kLevel) return 0;
  const auto heights = (sense_of(plane, up) * ((view.points * plane.normal).array() - plane.height)).eval();
  const auto below = static_cast<float>((heights < -2 * plane.tolerance).count());
  if (below > kBelow * static_cast<float>(heights.size())) return 0;
  const Points on = inside(plane, view.points);
  float width = 1e9f;
  for (const int axis : {(up.axis + 1) % 3, (up.axis + 2) % 3})
    width = std::min(width, spread(on.col(axis), kEnds) / (spread(view.rest.col(axis), kEnds) + 1e-20f));
  return width;
}

/// Something that is on no plane, as seen from one; the file's units.
struct Body {
  float low, high;  // above the plane
  float wide;       // of the box about it, level
  float area;       // of its surface
};

/// What hangs together.
class Bodies {
 public:
  explicit Bodies(const RoomView& view)
      : cells_(Mesh{view.rest / view.extent}, cell_of(view)),
        extent_(view.extent),
        sets_(connected_sets(cells_, std::vector<char>(cells_.count(), 1))) {}
  std::vector<Body> over(const Slab& plane, const UpAxis& up) const;

 private:
  /// Of the extent: points beside one another are not apart.
  static float cell_of(const RoomView& view);

  Cells cells_;
  float extent_;
  std::vector<CellSet> sets_;
};

float Bodies::cell_of(const RoomView& view) {
  constexpr float kFinest = 0.01f, kCoarsest = 0.04f;
  constexpr Eigen::Index kLooked = 500;
  const Eigen::Index step = std::max<Eigen::Index>(1, view.rest.rows() / kLooked);
  const Points some = view.rest(Eigen::seq(0, view.rest.rows() - 1, step), Eigen::all);
  const IntMatrix nearest =
      nearest_neighbours(view.rest, some, std::min<int>(2, static_cast<int>(view.rest.rows())));
  const Points beside = view.rest(nearest.rightCols(1).col(0), Eigen::all);
  return std::clamp(2 * middle(to_vector((beside - some).rowwise().norm())) / view.extent, kFinest,
                    kCoarsest);
}

std::vector<Body> Bodies::over(const Slab& plane, const UpAxis& up) const {
  const float sense = sense_of(plane, up), side = cells_.size_m() * extent_;
  std::vector<Body> bodies;
  for (const CellSet& set : sets_) {
    Vec3 low = Vec3::Constant(1e30f), high = -low;
    for (const int c : set) {
      const Vec3 p = extent_ * cells_.mean(c);
      const Vec3 own(p[(up.axis + 1) % 3], sense * (plane.normal.dot(p) - plane.height),
                     p[(up.axis + 2) % 3]);
      low = low.cwiseMin(own), high = high.cwiseMax(own);
    }
    const Vec3 size = high - low;
    bodies.push_back(
        {low.y(), high.y(), std::max(size.x(), size.z()), static_cast<float>(set.size()) * side * side});
  }
  return bodies;
}

/// What of the surface of all bodies is of people who stand on the plane, if a unit is so many metres; a
/// little of what else stands there. room: height and people are written.
float score_of(const std::vector<Body>& bodies, float metres, float touches, Room& room) {
  constexpr float kTallest = 2.6f, kWidest = 3, kLowest = 0.15f;
  float score = 0, area = 1e-20f;
  std::vector<float> people, all;
  for (const Body& body : bodies) {
    area += body.area;
    const float h = body.high * metres, wide = body.wide * metres;
    if (body.area * metres * metres < kBody_m2 || body.low * metres > touches) continue;
    if (h < kLowest || h > kTallest || wide > kWidest) continue;
    const bool is_adult = h >= 1.2f && h <= 2.1f, is_person = h >= 0.8f && h <= 2.3f;
    score += (is_adult ? 1.0f : is_person ? 0.5f : 0.1f) * body.area;
    all.push_back(body.high);
    if (is_person) people.push_back(body.high);
  }
  if (all.empty()) return 0;
  room.height = middle(people.empty() ? all : people);
  room.people = static_cast<int>(people.size());
  return score / area;
}

}  // namespace

Points outside(const std::vector<Slab>& slabs, Points points) {
  for (const Slab& slab : slabs) points = outside(slab, points);
  return points;
}

RoomView view_room(const Mesh& scan) {
  constexpr size_t kMost = 6;
  constexpr Eigen::Index kShare = 25, kLooked = 50000;
  RoomView view;
  const Points all = finite_points(scan.vertices);
  if (all.rows() == 0) return view;
  const Points some = all(Eigen::seq(0, all.rows() - 1, 1 + all.rows() / kLooked), Eigen::all);
  for (int axis = 0; axis < 3; ++axis) view.extent = std::max(view.extent, spread(some.col(axis), 0.005f));
  const float extent = view.extent;
  if (!(extent > 1e-20f) || extent > 1e30f) return view;
  view.points = extent * Cells(Mesh{scan.vertices / extent, scan.faces}, kCoarse).means();
  view.rest = view.points;
  Rng rng(1);
  while (view.planes.size() < kMost && view.rest.rows() > 0) {
    const std::optional<Slab> plane = largest_plane(view.rest, extent, rng);
    Points off = plane ? outside(*plane, view.rest) : view.rest;
    if (kShare * (view.rest.rows() - off.rows()) < view.points.rows()) break;
    view.planes.push_back(*plane);
    view.rest.swap(off);
  }
  return view;
}

std::optional<Room> find_room(const RoomView& view, const std::vector<float>& metres,
                              const std::vector<UpAxis>& ups) {
  constexpr float kTouches = 0.2f;  // metres that the lowest point of a body is above the ground
  constexpr float kOfPeople = 0.5f, kOfThings = 1.5f;  // times as wide as what is on it
  std::optional<Room> best;
  if (view.planes.empty() || view.rest.rows() == 0) return best;
  const Bodies bodies(view);
  const Vec3 centre = view.points.colwise().mean().transpose();
  float best_score = 0;
  for (const UpAxis& up : ups)
    for (const Slab& plane : view.planes) {
      const float width = width_of(view, plane, up);
      if (width < kOfPeople) continue;
      const std::vector<Body> over = bodies.over(plane, up);
      const float floor = centre[up.axis] - (plane.normal.dot(centre) - plane.height) / plane.normal[up.axis];
      for (const float unit : metres) {
        if (unit * view.extent < kSmallest || unit * view.extent > kLargest) continue;
        Room room{up, unit, up.negative ? -floor : floor};
        const float score = score_of(over, unit, kTouches + plane.tolerance * unit, room);
        if (score > best_score && (room.people > 0 || width >= kOfThings)) best_score = score, best = room;
      }
    }
  return best;
}

}  // namespace understudy
