#include "retarget/geometry/ground_finder.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr float kLevel = 0.966f;               // cosine of 15 degrees
constexpr float kNear = 0.02f, kBand = 0.08f;  // metres: on a plane; noise that still belongs to it
constexpr float kLeastArea = 0.15f;            // square metres
constexpr float kBareFrom = 0.1f, kBareTo = 0.4f;
constexpr int kTries = 200, kLooked = 1500;
constexpr float kFollow = 0.1f;  // share of a frame's own plane

/// Cells with nothing right above them: of a ground most, of a body shoulders and the like.
std::vector<int> bare_cells(const Cells& cells) {
  const int from = static_cast<int>(std::ceil(kBareFrom / cells.size_m())),
            to = static_cast<int>(std::ceil(kBareTo / cells.size_m()));
  std::vector<int> bare;
  for (int c = 0; c < cells.count(); ++c) {
    bool covered = false;
    for (int up = from; up <= to && !covered; ++up)
      covered = cells.find(cells.place(c) + CellMap::Place(0, up, 0)) >= 0;
    if (!covered) bare.push_back(c);
  }
  return bare;
}

Points picked(const Points& all, size_t most, Rng& rng) {
  if (all.rows() <= static_cast<Eigen::Index>(most)) return all;
  Points some(most, 3);
  for (auto row : some.rowwise()) row = all.row(rng.below(all.rows()));
  return some;
}

/// Columns of cells of which one at least is within `band` of the plane: what noise spreads over several
/// layers counts once.
float area_of(const Cells& cells, const std::vector<int>& which, const FloorPlane& plane, float band) {
  CellMap columns(which.size());
  for (const int c : which)
    if (std::abs(plane.above(cells.mean(c))) < band)
      columns.at({cells.place(c).x(), 0, cells.place(c).z()}, 0);
  return static_cast<float>(columns.size()) * cells.size_m() * cells.size_m();
}

/// Least squares through the bare cells near a plane, and how far they scatter about it.
Ground refined(const Cells& cells, const std::vector<int>& bare, const FloorPlane& near, float band) {
  std::vector<int> on;
  for (const int c : bare)
    if (std::abs(near.above(cells.mean(c))) < band) on.push_back(c);
  Ground ground{near, kNear, area_of(cells, on, near, band)};
  if (on.size() < 8) return ground;
  const Points p = cells.means()(on, Eigen::all);
  const Vec3 mean = p.colwise().mean().transpose();
  const Points centred = p.rowwise() - mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(Mat3(centred.transpose() * centred));
  Vec3 normal = solver.eigenvectors().col(0);
  if (normal.y() < 0) normal = -normal;
  // A narrow strip tells no tilt across it.
  const bool wide = solver.eigenvalues()[1] > 0.01f * solver.eigenvalues()[2];
  if (normal.y() < kLevel || !wide) return ground;
  ground.plane = {normal, normal.dot(mean)};
  const float scatter = std::sqrt(solver.eigenvalues()[0] / static_cast<float>(on.size()));
  ground.thickness_m = std::clamp(2.5f * scatter, kNear, 0.06f);
  return ground;
}

/// The level plane that most bare cells are on and hardly any cell is below.
std::optional<FloorPlane> search(const Cells& cells, const std::vector<int>& bare) {
  Rng rng(1);
  const Points open = picked(cells.means()(bare, Eigen::all), kLooked, rng),
               all = picked(cells.means(), kLooked, rng);
  const float per_open = static_cast<float>(bare.size()) / static_cast<float>(open.rows()),
              per_all = static_cast<float>(cells.count()) / static_cast<float>(all.rows());
  FloorPlane best;
  float best_score = 0;
  for (int t = 0; t < kTries; ++t) {
    const Vec3 a = open.row(rng.below(open.rows())), b = open.row(rng.below(open.rows())),
               c = open.row(rng.below(open.rows()));
    Vec3 n = (b - a).cross(c - a);
    if (n.norm() < 1e-3f) continue;
    n = n.normalized() * (n.y() < 0 ? -1.0f : 1.0f);
    if (n.y() < kLevel) continue;
    const float height = n.dot(a);
    const auto on = static_cast<float>((((open * n).array() - height).abs() < kNear).count());
    const auto below = static_cast<float>((((all * n).array() - height) < -kBand).count());
    const float score = on * per_open - 2 * below * per_all;
    if (score > best_score) best_score = score, best = {n, height};
  }
  if (best_score * cells.size_m() * cells.size_m() < kLeastArea) return std::nullopt;
  return best;
}

}  // namespace

const std::optional<Ground>& GroundFinder::push(const Cells& cells) {
  const std::vector<int> bare = bare_cells(cells);
  const float least_cells = kLeastArea / (cells.size_m() * cells.size_m());
  if (static_cast<float>(bare.size()) < least_cells) return ground_;
  if (ground_) {
    const Ground now = refined(cells, bare, ground_->plane, std::max(kNear, ground_->thickness_m));
    if (now.area_m2 < kLeastArea) return ground_;
    const Vec3 normal = (1 - kFollow) * ground_->plane.normal + kFollow * now.plane.normal;
    const Vec3 centre = cells.means().colwise().mean().transpose();  // where the two planes are mixed
    const float height = (1 - kFollow) * ground_->plane.above(centre) + kFollow * now.plane.above(centre);
    ground_->plane.normal = normal.normalized();
    ground_->plane.height_m = ground_->plane.normal.dot(centre) - height;
    ground_->thickness_m += kFollow * (now.thickness_m - ground_->thickness_m);
    ground_->area_m2 = now.area_m2;
    return ground_;
  }
  const auto found = search(cells, bare);
  if (!found) return ground_;
  Ground ground = refined(cells, bare, *found, 2 * kNear);
  ground = refined(cells, bare, ground.plane, kBand / 2);
  if (ground.area_m2 >= kLeastArea) ground_ = ground;
  return ground_;
}

}  // namespace understudy
