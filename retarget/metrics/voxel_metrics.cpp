#include "retarget/metrics/voxel_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr int kDrawnPoints = 20000, kDraws = 10;
constexpr double kOneEmpty = 4;

double mean_squared(const Points& from, const Points& to) {
  const IntMatrix nearest = nearest_neighbours(to, from, 1);
  double sum = 0;
  for (Eigen::Index i = 0; i < from.rows(); ++i)
    sum += static_cast<double>((from.row(i) - to.row(nearest(i, 0))).squaredNorm());
  return sum / static_cast<double>(from.rows());
}

/// Those of a that are not in b.
VoxelSet without(const VoxelSet& a, const VoxelSet& b) {
  VoxelSet rest;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
  return rest;
}

/// Cells with at least so many of the points.
VoxelSet full_cells(const VoxelGrid& grid, const Points& points, int least) {
  std::vector<int> counts(static_cast<size_t>(kVoxels) * kVoxels * kVoxels, 0);
  for (const int cell : grid.cells_of_each(points)) ++counts[cell];
  VoxelSet full;
  for (size_t cell = 0; cell < counts.size(); ++cell)
    if (counts[cell] >= least) full.push_back(static_cast<int>(cell));
  return full;
}

/// Cells that at least `least` of `drawn` points on each surface are in.
std::vector<VoxelSet> cells_of(const std::vector<Points>& vertices, const Faces& faces, const VoxelGrid& grid,
                               int drawn, int least) {
  std::vector<VoxelSet> sets;
  for (const Points& frame : vertices) {
    Rng rng(1);  // in each frame alike: what stands still has the same points
    sets.push_back(faces.rows() > 0 ? full_cells(grid, sample_points({frame, faces}, drawn, rng), least)
                                    : grid.cells(frame));
  }
  return sets;
}

}  // namespace

VoxelGrid::VoxelGrid(const std::vector<Points>& frames, int edge) : edge_(edge) {
  Vec3 low = Vec3::Constant(std::numeric_limits<float>::infinity()), high = -low;
  for (const Points& frame : frames) {
    if (frame.rows() == 0) continue;
    low = low.cwiseMin(frame.colwise().minCoeff().transpose());
    high = high.cwiseMax(frame.colwise().maxCoeff().transpose());
  }
  US_CHECK(low.allFinite() && high.allFinite() && low != high, "no box is about these frames");
  middle_ = (low + high) / 2;
  half_ = (high - low).maxCoeff() / 2;
}

VoxelSet VoxelGrid::cells(const Points& points) const {
  VoxelSet cells = cells_of_each(points);
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::vector<int> VoxelGrid::cells_of_each(const Points& points) const {
  std::vector<int> cells;
  cells.reserve(points.rows());
  for (const auto& point : points.rowwise()) {
    if (!point.allFinite()) continue;
    const Vec3 at = ((point.transpose() - middle_) / half_).cwiseMax(-1.0f).cwiseMin(1.0f);
    const Eigen::Array3i cell =
        ((at.array() + 1) * (0.5f * static_cast<float>(edge_ - 1))).round().cast<int>();
    cells.push_back((cell.z() * edge_ + cell.y()) * edge_ + cell.x());
  }
  return cells;
}

Points VoxelGrid::centres(const VoxelSet& cells, int edge) {
  Points centres(cells.size(), 3);
  for (size_t i = 0; i < cells.size(); ++i)
    centres.row(i) =
        Eigen::RowVector3i(cells[i] % edge, cells[i] / edge % edge, cells[i] / (edge * edge)).cast<float>();
  return (centres.array() * (2.0f / static_cast<float>(edge - 1)) - 1).matrix();
}

Points VoxelGrid::scaled(const Points& world) const {
  return (world.rowwise() - middle_.transpose()) / half_;
}

Points VoxelGrid::world(const Points& scaled) const {
  return (half_ * scaled).rowwise() + middle_.transpose();
}

double voxel_distance(const VoxelSet& a, const VoxelSet& b, int edge) {
  if (a.empty() && b.empty()) return 0;
  if (a.empty() || b.empty()) return kOneEmpty;
  const Points in_a = VoxelGrid::centres(a, edge), in_b = VoxelGrid::centres(b, edge);
  return mean_squared(in_a, in_b) + mean_squared(in_b, in_a);
}

VoxelErrors voxel_errors(const std::vector<VoxelSet>& found, const std::vector<VoxelSet>& truth) {
  US_CHECK(!truth.empty() && found.size() == truth.size(), found.size(), " frames cannot be compared with ",
           truth.size());
  const auto frames = static_cast<double>(truth.size());
  VoxelErrors errors;
  for (size_t t = 0; t < truth.size(); ++t) {
    errors.cd_1e4 += 1e4 * voxel_distance(found[t], truth[t]) / frames;
    if (t == 0) continue;
    errors.m_cd += voxel_distance(without(found[t], found[t - 1]), without(truth[t], truth[t - 1])) +
                   voxel_distance(without(found[t - 1], found[t]), without(truth[t - 1], truth[t]));
  }
  errors.m_cd = truth.size() > 1 ? errors.m_cd / (frames - 1) : std::nan("");
  return errors;
}

VoxelErrors voxel_errors(const std::vector<Points>& found, const Faces& found_faces,
                         const std::vector<Points>& truth, const Faces& true_faces) {
  const VoxelGrid grid(truth);
  // Of kDrawnPoints none is in a cell with probability exp(-expected number): one half at log 2.
  const int likely = static_cast<int>(std::ceil(kDraws * std::log(2.0)));
  return voxel_errors(cells_of(found, found_faces, grid, kDraws * kDrawnPoints, likely),
                      cells_of(truth, true_faces, grid, kDrawnPoints, 1));
}

}  // namespace understudy
