#include "retarget/baselines/body_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kTurns = 3 * kJointCount;       // parameters: place, world turn of each joint, shape
constexpr float kMostTurn = 0.5f;             // radians a joint turns in one step
constexpr float kSliding = 0.1f;              // weight of what lies along the surface, against across it
constexpr float kFar = 0.30f, kNear = 0.05f;  // metres: reach of the robust weight, first and last step
constexpr float kToLast = 0.008f, kToRest = 0.003f, kToMeanShape = 0.0025f;  // weights of the priors

/// Every so many-th of the finite points.
Points thinned_points(const Points& scan, int count) {
  const Points good = finite_points(scan);
  US_CHECK(good.rows() >= 32, "the scan has ", good.rows(), " usable points");
  const Eigen::Index kept = std::min<Eigen::Index>(good.rows(), count);
  Points points(kept, 3);
  for (Eigen::Index i = 0; i < kept; ++i) points.row(i) = good.row(i * good.rows() / kept);
  return points;
}

Rotations arms(float down) {
  Rotations local = identity_rotations();
  local[LeftShoulder] = rotation_from_axis_angle(Vec3(0, 0, -down));
  local[RightShoulder] = rotation_from_axis_angle(Vec3(0, 0, down));
  return local;
}

}  // namespace

FitBody::FitBody(const Body& body, int count) {
  const Points& all = body.template_vertices;
  const auto kept = farthest_points(all, std::min<int>(count, all.rows()));
  std::vector<int> coordinates;  // rows of shape_dirs and pose_dirs
  for (const int v : kept) coordinates.insert(coordinates.end(), {3 * v, 3 * v + 1, 3 * v + 2});
  vertices = all(kept, Eigen::all);
  normals = vertex_normals(all, body.faces)(kept, Eigen::all);
  weights = body.weights(kept, Eigen::all);
  shape_dirs = body.shape_dirs(coordinates, Eigen::all);
  if (body.pose_dirs) pose_dirs = (*body.pose_dirs)(coordinates, Eigen::all);
  joints = body.joint_regressor * all;
  for (Eigen::Index b = 0; b < body.shape_dirs.cols(); ++b) {
    const Eigen::VectorXf dir = body.shape_dirs.col(b);
    joint_dirs.push_back(body.joint_regressor * Eigen::Map<const Points>(dir.data(), all.rows(), 3));
  }
}

/// The body in a state, and what its derivatives need.
struct BodyFit::Posed {
  Joints rest;
  PosedSkeleton skeleton;
  Points vertices, normals;
  Points by_bone[kJointCount];  // w (where the bone alone takes the vertex), [N, 3]
};

/// What a frame is fitted to.
struct BodyFit::Task {
  Points scan;
  const Pose* last;  // null: none
  bool shape;        // whether the shape may change
};

BodyFit::BodyFit(std::shared_ptr<const FitBody> body, const BodyFitOptions& options)
    : body_(std::move(body)), options_(options) {
  last_.betas = Eigen::VectorXf::Zero(
      std::min<Eigen::Index>(options_.shape_parameters, static_cast<Eigen::Index>(body_->joint_dirs.size())));
}

BodyFit::Posed BodyFit::posed(const State& state) const {
  const FitBody& b = *body_;
  Posed p;
  Points rest = b.vertices;
  Eigen::Map<Eigen::VectorXf> flat(rest.data(), rest.size());
  flat += b.shape_dirs.leftCols(state.betas.size()) * state.betas;
  if (b.pose_dirs.size() > 0) flat += b.pose_dirs * pose_features(state.pose.local);
  p.rest = b.joints;
  for (Eigen::Index k = 0; k < state.betas.size(); ++k) p.rest += state.betas[k] * b.joint_dirs[k];
  p.skeleton = forward_kinematics(p.rest, state.pose);
  p.vertices = Points::Zero(rest.rows(), 3);
  p.normals = Points::Zero(rest.rows(), 3);
  for (int j = 0; j < kJointCount; ++j) {
    const Mat3 G = p.skeleton.global[j].transpose();
    p.by_bone[j] = ((rest.rowwise() - p.rest.row(j)) * G).rowwise() + p.skeleton.joints.row(j);
    p.by_bone[j].array().colwise() *= b.weights.col(j).array();
    p.vertices += p.by_bone[j];
    p.normals.array() += (b.normals * G).array().colwise() * b.weights.col(j).array();
  }
  p.normals.rowwise().normalize();
  return p;
}

namespace {

/// One closest pair: a vertex of the body, a point of the scan, and the pair's weight.
struct Pair {
  int vertex;
  Vec3 to;
  float weight;
};

/// Geman and McClure's weight.
float robust(float squared, float reach) {
  const float r = reach * reach / (reach * reach + squared);
  return r * r;
}

std::vector<Pair> closest_pairs(const Points& body, const Points& scan, float reach) {
  std::vector<Pair> pairs;
  const auto to_body = nearest_neighbours(body, scan, 1), to_scan = nearest_neighbours(scan, body, 1);
  for (Eigen::Index i = 0; i < scan.rows(); ++i)
    pairs.push_back({to_body(i, 0), scan.row(i), 1.f / static_cast<float>(scan.rows())});
  for (Eigen::Index v = 0; v < body.rows(); ++v)
    pairs.push_back({static_cast<int>(v), scan.row(to_scan(v, 0)), 0.5f / static_cast<float>(body.rows())});
  for (Pair& pair : pairs)
    pair.weight *= robust((Vec3(body.row(pair.vertex)) - pair.to).squaredNorm(), reach);
  return pairs;
}

/// Mean robust distance: what the steps lower.
float distance_of(const Points& body, const Points& scan) {
  const auto to_body = nearest_neighbours(body, scan, 1), to_scan = nearest_neighbours(scan, body, 1);
  const auto capped = [](const Vec3& d) { return std::min(d.norm(), 0.15f); };
  float there = 0, back = 0;
  for (Eigen::Index i = 0; i < scan.rows(); ++i) there += capped(scan.row(i) - body.row(to_body(i, 0)));
  for (Eigen::Index v = 0; v < body.rows(); ++v) back += capped(body.row(v) - scan.row(to_scan(v, 0)));
  return there / static_cast<float>(scan.rows()) + back / static_cast<float>(body.rows());
}

}  // namespace

/// The normal equations of a step: place, world turn of each joint, shape.
struct BodyFit::Equations {
  Eigen::MatrixXf H;
  Eigen::VectorXf g;
};

BodyFit::Equations BodyFit::data_equations(const State& state, const Posed& p, const Task& task,
                                           float reach) const {
  const int shapes = task.shape ? static_cast<int>(state.betas.size()) : 0, size = 3 + kTurns + shapes;
  // How each joint's turn moves each vertex: omega x lever, lever [N, 3].
  std::vector<Points> lever(p.by_bone, p.by_bone + kJointCount);
  RowMatrix carried = body_->weights;
  for (int j = kJointCount - 1; j > 0; --j) {
    lever[kParents[j]] += lever[j];
    carried.col(kParents[j]) += carried.col(j);
  }
  for (int j = 0; j < kJointCount; ++j) lever[j] -= carried.col(j) * p.skeleton.joints.row(j);
  std::vector<Points> swelling;  // how each shape parameter moves each vertex
  for (int b = 0; b < shapes; ++b) {
    State more = state;
    more.betas[b] += 0.1f;
    swelling.push_back((posed(more).vertices - p.vertices) * 10);
  }

  const std::vector<Pair> pairs = closest_pairs(p.vertices, task.scan, reach);
  RowMatrix J = RowMatrix::Zero(4 * static_cast<Eigen::Index>(pairs.size()), size);
  Eigen::VectorXf r(J.rows());
  for (size_t i = 0; i < pairs.size(); ++i)
    for (int k = 0; k < 4; ++k) {  // across the surface, then along x, y, z
      const int v = pairs[i].vertex;
      const float weight = std::sqrt(pairs[i].weight) * (k == 0 ? 1 : kSliding);
      const Vec3 axis = weight * (k == 0 ? Vec3(p.normals.row(v)) : Vec3(Vec3::Unit(k - 1)));
      const auto row = static_cast<Eigen::Index>(4 * i) + k;
      r[row] = axis.dot(pairs[i].to - Vec3(p.vertices.row(v)));
      J.block<1, 3>(row, 0) = axis.transpose();
      for (int j = 0; j < kJointCount; ++j)
        if (carried(v, j) > 0) J.block<1, 3>(row, 3 + 3 * j) = Vec3(lever[j].row(v)).cross(axis).transpose();
      for (int b = 0; b < shapes; ++b) J(row, 3 + kTurns + b) = swelling[b].row(v).dot(axis);
    }
  return {J.transpose() * J, J.transpose() * r};
}

/// Near the frame before and the T-pose, near the mean shape. A world turn w is R^T w in a joint's own axes.
/// The shape is freed as the surfaces come near each other.
void BodyFit::add_priors(Equations& to, const State& state, const Posed& p, const Task& task,
                         float reach) const {
  const float to_mean = std::pow(kToMeanShape * reach / kNear, 2.f);
  for (int j = 0; j < kJointCount; ++j) {
    const auto pull = [&](const Mat3& toward, float weight) {
      const Vec3 off = rotation_to_axis_angle(toward.transpose() * state.pose.local[j]);
      to.H.block<3, 3>(3 + 3 * j, 3 + 3 * j).diagonal().array() += weight * weight;
      to.g.segment<3>(3 + 3 * j) -= weight * weight * (p.skeleton.global[j] * off);
    };
    if (task.last) pull(task.last->local[j], kToLast);
    if (j != Pelvis) pull(Mat3::Identity(), kToRest);
  }
  for (Eigen::Index b = 0; 3 + kTurns + b < to.g.size(); ++b) {
    to.H(3 + kTurns + b, 3 + kTurns + b) += to_mean;
    to.g[3 + kTurns + b] -= to_mean * state.betas[b];
  }
  to.H.diagonal().array() += 1e-6f;
}

void BodyFit::step(State& state, const Task& task, float reach) const {
  const Posed p = posed(state);
  Equations equations = data_equations(state, p, task, reach);
  add_priors(equations, state, p, task, reach);
  const Eigen::VectorXf x = equations.H.ldlt().solve(equations.g);
  if (!x.allFinite()) return;
  state.pose.root += x.head<3>();
  for (int j = 0; j < kJointCount; ++j) {
    Vec3 turn = x.segment<3>(3 + 3 * j);
    if (turn.norm() > kMostTurn) turn *= kMostTurn / turn.norm();
    const Mat3 up = j == Pelvis ? Mat3(Mat3::Identity()) : p.skeleton.global[kParents[j]];
    state.pose.local[j] =
        nearest_rotation(up.transpose() * rotation_from_axis_angle(turn) * up * state.pose.local[j]);
  }
  state.betas.head(x.size() - 3 - kTurns) += x.tail(x.size() - 3 - kTurns);
}

float BodyFit::improve(State& state, const Task& task, int iterations) const {
  for (int i = 0; i < iterations; ++i) {
    const float share = iterations == 1 ? 1 : static_cast<float>(i) / static_cast<float>(iterations - 1);
    step(state, task, task.last ? kNear : kFar * std::pow(kNear / kFar, share));
  }
  return distance_of(posed(state).vertices, task.scan);
}

BodyFit::State BodyFit::start(const Points& scan) const {
  const Task task{scan, nullptr, true};
  std::vector<std::pair<float, State>> starts;
  for (int heading = 0; heading < 8; ++heading)
    for (const float down : {0.f, 1.1f}) {
      State state = last_;
      state.pose.local = arms(down);
      state.pose.local[Pelvis] = rotation_about_y(static_cast<float>(heading) * kPi / 4);
      state.pose.root.setZero();
      state.pose.root = (scan.colwise().mean() - posed(state).vertices.colwise().mean()).transpose();
      const float distance = improve(state, task, options_.start_iterations);
      starts.emplace_back(distance, std::move(state));
    }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  starts.resize(2);
  for (auto& [distance, state] : starts) distance = improve(state, task, options_.first_iterations);
  return starts[0].first <= starts[1].first ? starts[0].second : starts[1].second;
}

Extraction BodyFit::extract(const Mesh& scan) {
  const Points points = thinned_points(scan.vertices, options_.scan_points);
  if (frames_ == 0) {
    last_ = start(points);
  } else {
    const Pose before = last_.pose;
    improve(last_, {points, &before, frames_ < options_.shape_frames}, options_.iterations);
  }
  ++frames_;
  return exact_extraction(posed(last_).skeleton);
}

}  // namespace understudy
