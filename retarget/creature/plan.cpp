#include "retarget/creature/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/geometry/implicit_surface.hpp"

namespace understudy {
namespace {

constexpr int kCellsAlong = 28;  // of the look-up grid, along its longest side
constexpr float kBeyond = 0.4f;  // how much farther: share of the way beyond
constexpr float kSlack = 1.2f;   // the pieces' distances are not exact

float reach_of(const SolidPart& part) {
  const float wide = part.half.norm() + part.round;
  const bool box_like = part.shape == SolidPart::Shape::Box || part.shape == SolidPart::Shape::Ellipsoid;
  return box_like ? wide : part.length + std::max(part.from, part.to) + part.round;
}

/// All pieces of a plan as one solid; each point asks only the pieces near it.
class JoinedParts {
 public:
  explicit JoinedParts(const CreaturePlan& plan) : plan_(plan) {
    low_ = Vec3::Constant(1e9f);
    high_ = -low_;
    for (const SolidPart& part : plan.parts) {
      if (part.carved) continue;
      low_ = low_.cwiseMin(part.origin - Vec3::Constant(reach_of(part)));
      high_ = high_.cwiseMax(part.origin + Vec3::Constant(reach_of(part)));
    }
    grid_low_ = low_;
    side_ = (high_ - low_).maxCoeff() / kCellsAlong;
    for (int axis = 0; axis < 3; ++axis)
      count_[axis] = static_cast<int>(std::ceil((high_[axis] - low_[axis]) / side_)) + 1;
    near_.resize(static_cast<size_t>(count_[0]) * count_[1] * count_[2]);
    size_t cell = 0;
    for (int z = 0; z < count_[2]; ++z)
      for (int y = 0; y < count_[1]; ++y)
        for (int x = 0; x < count_[0]; ++x) look_up(grid_low_ + side_ * Vec3(x, y, z), near_[cell++]);
    shrink_to_surface();
  }

  float value(const Vec3& p) const {
    float d = 1e9f;
    for (int i : near(p)) {
      const SolidPart& part = plan_.parts[static_cast<size_t>(i)];
      const float other = distance_to(part, p);
      d = part.carved ? -smooth_minimum(-d, other, part.blend) : smooth_minimum(d, other, part.blend);
    }
    return d;
  }

  /// Of the pieces near p: distance and number, nearest first. Beyond its ends a piece counts as farther than
  /// it is: of two bones with round ends each has its own side of their joint.
  std::vector<std::pair<float, int>> pieces(const Vec3& p) const {
    std::vector<std::pair<float, int>> found;
    for (int i : near(p)) {
      const SolidPart& part = plan_.parts[static_cast<size_t>(i)];
      const float d = distance_to(part, p);
      found.emplace_back((part.carved ? std::abs(d) : d) + kBeyond * beyond_ends(part, p), i);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  float thickness(const Vec3& p) const {
    float nearest = 1e9f, thick = 1;
    for (int i : near(p)) {
      const SolidPart& part = plan_.parts[static_cast<size_t>(i)];
      const float d = part.carved ? std::abs(distance_to(part, p)) : distance_to(part, p);
      if (d >= nearest) continue;
      nearest = d;
      thick = part.thickness;
    }
    return thick;
  }

  const Vec3& low() const { return low_; }
  const Vec3& high() const { return high_; }

 private:
  const std::vector<int>& near(const Vec3& p) const {
    std::array<int, 3> at;
    for (int axis = 0; axis < 3; ++axis)
      at[static_cast<size_t>(axis)] =
          std::clamp(static_cast<int>(std::lround((p[axis] - grid_low_[axis]) / side_)), 0, count_[axis] - 1);
    return near_[static_cast<size_t>(at[0]) +
                 static_cast<size_t>(count_[0]) * (at[1] + static_cast<size_t>(count_[1]) * at[2])];
  }

  /// The pieces that can matter within half a cell of `centre`.
  void look_up(const Vec3& centre, std::vector<int>& found) {
    const float half = 0.87f * side_ * kSlack;
    std::vector<float> d;
    float nearest = 1e9f;
    for (const SolidPart& part : plan_.parts) {
      d.push_back(distance_to(part, centre));
      if (!part.carved) nearest = std::min(nearest, d.back());
    }
    for (size_t i = 0; i < d.size(); ++i) {
      const SolidPart& part = plan_.parts[i];
      const float limit = part.carved ? half + part.blend : nearest + 2 * half + 2 * part.blend;
      if (d[i] < limit) found.push_back(static_cast<int>(i));
    }
  }

  /// The pieces' boxes are generous: takes the box to where something is.
  void shrink_to_surface() {
    Vec3 low = high_, high = low_;
    size_t cell = 0;
    for (int z = 0; z < count_[2]; ++z)
      for (int y = 0; y < count_[1]; ++y)
        for (int x = 0; x < count_[0]; ++x, ++cell) {
          const Vec3 centre = grid_low_ + side_ * Vec3(x, y, z);
          if (value(centre) > side_) continue;
          low = low.cwiseMin(centre - Vec3::Constant(side_));
          high = high.cwiseMax(centre + Vec3::Constant(side_));
        }
    low_ = low;
    high_ = high;
  }

  const CreaturePlan& plan_;
  Vec3 low_, high_, grid_low_;
  float side_ = 0;
  std::array<int, 3> count_{};
  std::vector<std::vector<int>> near_;  // [cells] numbers of pieces, ascending
};

ImplicitSolid solid_of(const CreaturePlan& plan, const JoinedParts& parts) {
  ImplicitSolid solid;
  solid.value = [&parts](const Vec3& p) { return parts.value(p); };
  solid.warp = [](const Vec3& p) { return p; };
  solid.detail = [&](const Vec3& p) {
    return std::clamp(parts.thickness(p) / plan.coarse_at, plan.finest, 1.0f);
  };
  solid.low = parts.low();
  solid.high = parts.high();
  if (plan.mirrored) solid.low.x() = 0;
  solid.cell = plan.cell;
  solid.vertices = plan.vertices;
  solid.mirrored = plan.mirrored;
  return solid;
}

bool related(const std::vector<RigJoint>& joints, int a, int b) {
  const int up_a = joints[static_cast<size_t>(a)].parent, up_b = joints[static_cast<size_t>(b)].parent;
  return a == b || up_a == b || up_b == a || up_a == up_b;
}

/// Weights of one point: each bone by how near its pieces come, against the nearest; of bones that meet.
void weigh(const CreaturePlan& plan, const std::vector<std::pair<float, int>>& pieces,
           Eigen::Ref<Eigen::RowVectorXf> row) {
  const SolidPart& nearest = plan.parts[static_cast<size_t>(pieces.front().second)];
  const float soft = plan.softness * std::max(nearest.thickness, 0.02f);
  for (const auto& [d, i] : pieces) {
    const int joint = plan.parts[static_cast<size_t>(i)].joint;
    if (!related(plan.joints, nearest.joint, joint)) continue;
    row[joint] = std::max(row[joint], std::exp(-(d - pieces.front().first) / soft));
  }
  row /= row.sum();
}

/// Each vertex takes half of what its neighbours have: no jumps where the choice of bones changes.
void soften(RowMatrix& weights, const Faces& faces, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    RowMatrix sum = RowMatrix::Zero(weights.rows(), weights.cols());
    Eigen::VectorXf count = Eigen::VectorXf::Zero(weights.rows());
    for (Eigen::Index f = 0; f < faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) {
        sum.row(faces(f, c)) += weights.row(faces(f, (c + 1) % 3));
        count[faces(f, c)] += 1;
      }
    for (Eigen::Index v = 0; v < weights.rows(); ++v)
      weights.row(v) = 0.5f * weights.row(v) + 0.5f / count[v] * sum.row(v);
  }
}

SkinWeights skin_of(const CreaturePlan& plan, const JoinedParts& parts, const Mesh& surface) {
  const Eigen::Index count = surface.vertices.rows();
  RowMatrix weights = RowMatrix::Zero(count, static_cast<Eigen::Index>(plan.joints.size()));
  std::vector<int> bones;
  for (Eigen::Index v = 0; v < count; ++v) {
    const auto pieces = parts.pieces(surface.vertices.row(v).transpose());
    bones.push_back(plan.parts[static_cast<size_t>(pieces.front().second)].joint);
    if (!plan.machine) weigh(plan, pieces, weights.row(v));
  }
  if (plan.machine) return SkinWeights::rigid(bones);
  soften(weights, surface.faces, 4);
  weights = (weights.array() < 5e-3f).select(0.0f, weights);
  return SkinWeights::from(weights);
}

}  // namespace

int CreaturePlan::joint(const std::string& name, const std::string& parent, JointKind kind, const Vec3& rest,
                        const Vec3& axis) {
  joints.push_back({name, parent.empty() ? -1 : number(parent), kind, rest, axis.normalized()});
  return static_cast<int>(joints.size()) - 1;
}

SolidPart& CreaturePlan::add(const std::string& name, SolidPart part, float blend) {
  part.joint = number(name);
  if (blend >= 0) part.blend = blend;
  parts.push_back(part);
  return parts.back();
}

SolidPart& CreaturePlan::carve(const std::string& name, SolidPart part, float blend) {
  SolidPart& carved = add(name, std::move(part), blend);
  carved.carved = true;
  return carved;
}

int CreaturePlan::number(const std::string& name) const {
  for (size_t j = 0; j < joints.size(); ++j)
    if (joints[j].name == name) return static_cast<int>(j);
  throw Error("the creature has no joint '" + name + "'");
}

Rig rig_of(const CreaturePlan& plan, const std::string& name) {
  const JoinedParts parts(plan);
  Rig rig;
  rig.name = name;
  rig.joints = plan.joints;
  rig.surface = polygonise(solid_of(plan, parts));
  rig.skin = skin_of(plan, parts, rig.surface);
  const Vec3 up(0, -rig.surface.vertices.col(1).minCoeff(), 0);  // onto the floor
  rig.surface.vertices.rowwise() += up.transpose();
  rig.surface.vertices *= plan.scale;
  for (RigJoint& joint : rig.joints) joint.rest = plan.scale * (joint.rest + up);
  check_rig(rig);
  return rig;
}

}  // namespace understudy
