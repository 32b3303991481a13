#include "retarget/body/fused_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr int kSteps = 5;          // of Newton's method
constexpr float kClose = 0.04f;    // of the level that counts as reached
constexpr float kConcave = 0.03f;  // above the level: what is to be filled

int64_t cell_of(const Eigen::RowVector3f& x, float size) {
  int64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = key * 2097152 + static_cast<int64_t>(std::floor(std::clamp(x[axis] / size, -1e6f, 1e6f))) + 1048576;
  return key;
}

/// 0 up to `low`, 1 from `high` on.
float eased(float x, float low, float high) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

}  // namespace

void keep_rows(OrientedPoints& cloud, const std::vector<int>& kept) {
  cloud.normals = Points(cloud.normals(kept, Eigen::all));
  keep_rows(static_cast<LabelledPoints&>(cloud), kept);
}

SoftSolid::SoftSolid(const Points& points, const Points& normals, float area, float softness)
    : area_(area), softness_(softness) {
  const float size = 4 * softness;
  std::vector<std::pair<int64_t, int>> order;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    order.emplace_back(cell_of(points.row(i), size), static_cast<int>(i));
  std::sort(order.begin(), order.end());
  std::vector<int> rows;  // of one cell
  for (size_t i = 0; i < order.size(); ++i) {
    rows.push_back(order[i].second);
    if (i + 1 < order.size() && order[i + 1].first == order[i].first) continue;
    add_cell(points, normals, rows);
    rows.clear();
  }
}

void SoftSolid::add_cell(const Points& points, const Points& normals, const std::vector<int>& rows) {
  Cell cell{blocks_.size(), 0, Vec3::Zero(), Vec3::Zero(), 0};
  for (size_t i = 0; i < rows.size(); ++i) {
    const Vec3 x = points.row(rows[i]).transpose(), n = area_ * normals.row(rows[i]).transpose();
    if (i % 4 == 0) {  // lanes that stay empty have no area
      const Eigen::Array4f none = Eigen::Array4f::Zero();
      blocks_.push_back({none, none, none, none, none, none});
    }
    Block& block = blocks_.back();
    const auto lane = static_cast<Eigen::Index>(i % 4);
    block.x[lane] = x.x(), block.y[lane] = x.y(), block.z[lane] = x.z();
    block.nx[lane] = n.x(), block.ny[lane] = n.y(), block.nz[lane] = n.z();
    cell.middle += x / static_cast<float>(rows.size());
    cell.area += n;
  }
  cell.end = blocks_.size();
  float reach = 0;
  for (const int row : rows)
    reach = std::max(reach, (points.row(row).transpose() - cell.middle).squaredNorm());
  cell.near = 6.25f * reach + softness_ * softness_;
  cells_.push_back(cell);
}

SoftSolid::Value SoftSolid::at(const Vec3& x) const {
  const float s2 = softness_ * softness_;
  float inside = 0;
  Vec3 slope = Vec3::Zero();
  Eigen::Array4f sum = Eigen::Array4f::Zero(), sx = sum, sy = sum, sz = sum;
  for (const Cell& cell : cells_) {
    const Vec3 away = cell.middle - x;
    const float r2 = away.squaredNorm();
    if (r2 > cell.near) {
      const float soft = r2 + s2, weight = 1 / (soft * std::sqrt(soft));
      inside += weight * cell.area.dot(away);
      slope += weight / soft * cell.area;
      continue;
    }
    for (size_t b = cell.begin; b < cell.end; ++b) {
      const Block& q = blocks_[b];
      const Eigen::Array4f dx = q.x - x.x(), dy = q.y - x.y(), dz = q.z - x.z();
      const Eigen::Array4f soft = dx * dx + dy * dy + dz * dz + s2, weight = 1 / (soft * soft.sqrt()),
                           steep = weight / soft;
      sum += weight * (q.nx * dx + q.ny * dy + q.nz * dz);
      sx += steep * q.nx, sy += steep * q.ny, sz += steep * q.nz;
    }
  }
  slope += Vec3(sx.sum(), sy.sum(), sz.sum());
  return {(inside + sum.sum()) / (4 * kPi), -3 * s2 / (4 * kPi) * slope};
}

std::optional<Vec3> SoftSolid::level_point(const Vec3& from, float level, float farthest) const {
  Vec3 x = from;
  for (int i = 0; i < kSteps; ++i) {
    const Value here = at(x);
    const float off = here.inside - level, steep = here.slope.norm();
    if (std::abs(off) < kClose) return x;
    if (steep * softness_ < 0.02f) return std::nullopt;  // between fingers, or far from everything
    const float step = std::clamp(off / steep, -softness_, softness_);
    x -= step / steep * here.slope;
    if ((x - from).norm() > farthest) return std::nullopt;
  }
  if (std::abs(at(x).inside - level) > 2 * kClose) return std::nullopt;
  return x;
}

void weld(OrientedPoints& cloud, const SoftSolid& solid, float level) {
  std::vector<int> kept;
  const Points before = cloud.points;
  for (int i = 0; i < before.rows(); ++i) {
    const Vec3 x = before.row(i).transpose();
    if (solid.at(x).inside > level + kConcave) {
      const auto filled = solid.level_point(x, level, 5 * solid.softness());
      if (!filled) continue;
      cloud.points.row(i) = filled->transpose();
    }
    kept.push_back(i);
  }
  if (kept.size() > cloud.parts.size() / 2) keep_rows(cloud, kept);
}

void fuse_hand(OrientedPoints& cloud, const PosedSkeleton& truth, int side, const SoftSolid& solid,
               float level) {
  const int wrist = LeftWrist + side;
  const Vec3 joint = truth.joints.row(wrist).transpose();
  const Vec3 along = (joint - truth.joints.row(LeftElbow + side).transpose()).normalized();
  const float leg = leg_length(truth.joints);
  std::vector<int> kept;
  for (int i = 0; i < cloud.points.rows(); ++i) {
    const Vec3 x = cloud.points.row(i).transpose();
    const float beyond = std::max((x - joint).dot(along), (x - joint).norm() - 0.04f * leg);
    const float share = cloud.parts[i] == wrist ? eased(beyond / leg, 0.01f, 0.07f) : 0.0f;
    if (share > 0) {
      const auto fused = solid.level_point(x, level, 4 * solid.softness() + 0.01f);
      if (!fused) continue;
      cloud.points.row(i) = ((1 - share) * x + share * *fused).transpose();
    }
    kept.push_back(i);
  }
  keep_rows(cloud, kept);
}

void snap_to_voxels(OrientedPoints& cloud, Rng& rng) {
  const float size = rng.uniform(0.008f, 0.025f), share = rng.uniform(0.4f, 1.0f),
              depth = rng.chance(0.4f) ? share : 0.0f;
  const Vec3 corner(rng.uniform(0, size), rng.uniform(0, size), rng.uniform(0, size));
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    int main = 0;  // a vertex of marching cubes is free along one axis
    cloud.normals.row(i).cwiseAbs().maxCoeff(&main);
    for (int axis = 0; axis < 3; ++axis) {
      float& x = cloud.points(i, axis);
      const float on_grid = corner[axis] + size * std::round((x - corner[axis]) / size);
      x += (axis == main ? depth : share) * (on_grid - x);
    }
  }
}

UnevenSurface::UnevenSurface(const Points& vertices, const Joints& joints, Rng& rng) {
  const float size = leg_length(joints) / 0.85f;
  thicker_.setZero();
  for (int j = 0; j < kJointCount; ++j) {
    const bool is_hand = j == LeftWrist || j == RightWrist;
    if (rng.chance(0.5f))
      thicker_[j] = size * (is_hand ? rng.uniform(-0.003f, 0.008f) : rng.uniform(-0.008f, 0.015f));
  }
  const int patches = rng.below(7);
  for (int i = 0; i < patches; ++i) {
    const Vec3 middle = vertices.row(rng.below(static_cast<int>(vertices.rows()))).transpose();
    patches_.push_back({middle, size * rng.uniform(0.02f, 0.09f), size * rng.uniform(-0.012f, 0.022f)});
  }
}

void UnevenSurface::apply(Points& points, const Points& normals, const RowMatrix& weights) const {
  const Eigen::VectorXf thicker = weights * thicker_;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    float out = thicker[i];
    for (const Patch& patch : patches_) {
      const float d2 =
          (points.row(i).transpose() - patch.middle).squaredNorm() / (patch.radius * patch.radius);
      if (d2 < 6) out += patch.height * std::exp(-0.5f * d2);
    }
    points.row(i) += out * normals.row(i);
  }
}

}  // namespace understudy
