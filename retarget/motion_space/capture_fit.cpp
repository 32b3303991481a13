#include "retarget/motion_space/capture_fit.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/body/marker_places.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kSliding = 0.15f;        // of a point along the surface, against across it
constexpr float kMostTurn = 0.5f;        // radians a joint turns in one step
constexpr float kIndependent = 250;      // points of a scan that tell something of their own
constexpr float kMarker_m = 0.015f;      // of a marker about its place on the skin
constexpr float kMarkerPlace_m = 0.03f;  // of that place about where it is on the mean person
constexpr float kPatient = 2.5f;         // errors from which what was extracted counts less
constexpr int kCoverStride = 4;          // of the vertices that points are looked for at
constexpr float kSwelling_m = 0.015f;    // of the skin about the shaped body
constexpr float kWrinkle_m = 0.003f;     // from one vertex to the next

/// Rotation vectors of each joint about its parent's axes: mean and standard deviation over the poses of 201
/// captured clips and their mirror images (the pelvis apart), no deviation below 0.06.
struct Habit {
  float mean[3], spread[3];
};
constexpr Habit kHabits[kJointCount] = {{{0, 0, 0}, {0, 0, 0}},
                                        {{-0.45f, 0.05f, 0.08f}, {0.41f, 0.21f, 0.21f}},
                                        {{-0.45f, -0.05f, -0.08f}, {0.41f, 0.21f, 0.21f}},
                                        {{0.12f, 0, 0}, {0.25f, 0.13f, 0.11f}},
                                        {{0.78f, -0.01f, 0}, {0.46f, 0.06f, 0.06f}},
                                        {{0.78f, 0.01f, 0}, {0.46f, 0.06f, 0.06f}},
                                        {{-0.04f, 0, 0}, {0.11f, 0.06f, 0.07f}},
                                        {{-0.19f, 0.09f, 0.01f}, {0.27f, 0.24f, 0.20f}},
                                        {{-0.19f, -0.09f, -0.01f}, {0.27f, 0.24f, 0.20f}},
                                        {{-0.01f, 0, 0}, {0.12f, 0.06f, 0.06f}},
                                        {{0.03f, 0, 0}, {0.19f, 0.06f, 0.06f}},
                                        {{0.03f, 0, 0}, {0.19f, 0.06f, 0.06f}},
                                        {{0.11f, 0, 0}, {0.19f, 0.19f, 0.15f}},
                                        {{0, 0, 0}, {0.06f, 0.06f, 0.06f}},
                                        {{0, 0, 0}, {0.06f, 0.06f, 0.06f}},
                                        {{-0.09f, 0, 0}, {0.30f, 0.25f, 0.40f}},
                                        {{0.18f, -0.53f, -0.97f}, {0.58f, 0.51f, 0.56f}},
                                        {{0.18f, 0.53f, 0.97f}, {0.58f, 0.51f, 0.56f}},
                                        {{-0.10f, -0.94f, 0.51f}, {0.09f, 0.55f, 0.34f}},
                                        {{-0.10f, 0.94f, -0.51f}, {0.09f, 0.55f, 0.34f}},
                                        {{-0.02f, 0.02f, 0.07f}, {0.52f, 0.21f, 0.20f}},
                                        {{-0.02f, -0.02f, -0.07f}, {0.52f, 0.21f, 0.20f}}};
constexpr float kLoose = 1.2f;  // poses that were not captured then

/// How much speeds change: the power of accelerations, m^2/s^3 of the root, rad^2/s^3 of joints; from second
/// differences over 67 ms in the same clips.
constexpr float kRootPower = 0.6f;
constexpr std::array<float, kJointCount> kTurnPower = {
    8, 26, 26, 7, 25, 25, 1.3f, 41, 41, 1.3f, 24, 24, 4.5f, 0.6f, 0.6f, 6.5f, 28, 28, 12, 12, 38, 38};

/// Geman and McClure's weight.
float robust(float squared, float reach) {
  const float share = reach * reach / (reach * reach + squared);
  return share * share;
}

void add_habits(const Pose& pose, FrameEquations& to) {
  for (int j = 1; j < kJointCount; ++j) {
    const Vec3 turned = rotation_to_axis_angle(pose.local[j]);
    for (int k = 0; k < 3; ++k) {
      const float spread = kLoose * kHabits[j].spread[k];
      const double weight = 1 / static_cast<double>(spread * spread);
      to.H(3 + 3 * j + k, 3 + 3 * j + k) += weight;
      to.g[3 + 3 * j + k] += weight * static_cast<double>(kHabits[j].mean[k] - turned[k]);
    }
  }
  to.H.diagonal().head(6).array() += 1e-3;
}

float habit_misfit(const Pose& pose) {
  float sum = 0;
  for (int j = 1; j < kJointCount; ++j) {
    const Vec3 turned = rotation_to_axis_angle(pose.local[j]);
    for (int k = 0; k < 3; ++k) {
      const float off = (turned[k] - kHabits[j].mean[k]) / (kLoose * kHabits[j].spread[k]);
      sum += 0.5f * off * off;
    }
  }
  return sum;
}

void move(const Eigen::VectorXd& by, Pose& pose) {
  Vec3 way = by.head<3>().cast<float>();
  if (way.norm() > 0.3f) way *= 0.3f / way.norm();
  pose.root += way;
  for (int j = 0; j < kJointCount; ++j) {
    Vec3 turn = by.segment<3>(3 + 3 * j).cast<float>();
    if (turn.norm() > kMostTurn) turn *= kMostTurn / turn.norm();
    pose.local[j] =
        Eigen::Quaternionf(rotation_from_axis_angle(turn) * pose.local[j]).normalized().toRotationMatrix();
  }
}

Points every(int stride, const Points& points) {
  Points some((points.rows() + stride - 1) / stride, 3);
  for (Eigen::Index i = 0; i < some.rows(); ++i) some.row(i) = points.row(stride * i);
  return some;
}

/// A share for each point, so that many points of a scan do not outweigh all else: their errors are alike.
float point_share(Eigen::Index points) {
  return std::min(1.0f, kIndependent / static_cast<float>(std::max<Eigen::Index>(1, points)));
}

}  // namespace

Pose usual_pose() {
  Pose pose;
  for (int j = 0; j < kJointCount; ++j)
    pose.local[j] =
        rotation_from_axis_angle(Vec3(kHabits[j].mean[0], kHabits[j].mean[1], kHabits[j].mean[2]));
  return pose;
}

CaptureFit::CaptureFit(std::shared_ptr<const PersonModel> model, std::vector<Evidence> frames)
    : shape(Eigen::VectorXf::Zero(model->parameters())),
      swelling(Eigen::VectorXf::Zero(model->vertices.rows())),
      poses(frames.size()),
      model_(std::move(model)),
      frames_(std::move(frames)) {
  const float leg = leg_length(model_->whole.joints);
  for (const MarkerPlace& place : kMarkerPlaces)
    marker_offsets_.push_back(leg * Vec3(place.offset[0], place.offset[1], place.offset[2]));
}

void CaptureFit::add_points(const FitRound& round, const Evidence& seen, const PosedPerson& person,
                            FrameEquations& to) const {
  if (seen.points.rows() == 0 || round.reach <= 0) return;
  const Points& vertices = person.vertices();
  std::vector<float> weight(static_cast<size_t>(vertices.rows()), 0);
  Points pull = Points::Zero(vertices.rows(), 3);
  const auto match = [&](Eigen::Index v, const Vec3& to_point, float share) {
    const Vec3 off = to_point - vertices.row(v).transpose();
    const float w = share * robust(off.squaredNorm(), round.reach);
    weight[v] += w;
    pull.row(v) += w * off.transpose();
  };
  const float unit = 1 / (round.surface_m * round.surface_m);
  const float share = unit * point_share(seen.points.rows());
  const IntMatrix nearest = nearest_neighbours(vertices, seen.points, 1);
  for (Eigen::Index i = 0; i < seen.points.rows(); ++i) match(nearest(i, 0), seen.points.row(i), share);
  if (round.cover > 0) {
    const Points some = every(kCoverStride, vertices);
    const IntMatrix back = nearest_neighbours(seen.filled, some, 1);
    const float each =
        round.cover * share * static_cast<float>(seen.points.rows()) / static_cast<float>(some.rows());
    for (Eigen::Index v = 0; v < some.rows(); ++v) match(kCoverStride * v, seen.filled.row(back(v, 0)), each);
  }
  constexpr float kAlong = kSliding * kSliding;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    if (weight[v] <= 0) continue;
    const Vec3 n = person.normals().row(v);
    const Mat3 across = kAlong * Mat3::Identity() + (1 - kAlong) * n * n.transpose();
    to.add_vertex(static_cast<int>(v), weight[v] * across, across * pull.row(v).transpose());
  }
}

void CaptureFit::add_seen(const FitRound& round, const Evidence& seen, const PosedPerson& person,
                          FrameEquations& to) const {
  if (seen.seen && round.seen > 0) {
    const Extraction& joints = *seen.seen;
    for (int j = 0; j < kJointCount; ++j) {
      const float error = std::max(0.008f, expected_error_for(joints.confidence[j]));
      const Vec3 off = (joints.joints.row(j) - person.skeleton().joints.row(j)).transpose();
      to.add_joint(j, round.seen * robust(off.squaredNorm(), kPatient * 2 * error) / (error * error), off);
      if (!joints.global) continue;
      const Vec3 turn = rotation_to_axis_angle((*joints.global)[j] * person.skeleton().global[j].transpose());
      const float turn_error = seen.turn_error;
      to.add_turn(j,
                  round.seen * robust(turn.squaredNorm(), kPatient * turn_error) / (turn_error * turn_error),
                  turn);
    }
  }
  for (const Evidence::Marked& marked : seen.markers) {
    const int bone = kMarkerPlaces[marked.marker].joint;
    const Vec3 at = person.skeleton().joints.row(bone).transpose() +
                    person.skeleton().global[bone] * marker_offsets_[marked.marker];
    const Vec3 off = marked.place - at;
    const float error = std::max(kMarker_m, round.surface_m);
    to.add_carried(bone, marker_offsets_[marked.marker],
                   robust(off.squaredNorm(), 10 * error) / (error * error), off);
  }
}

FrameEquations CaptureFit::equations(const FitRound& round, int frame, const PosedPerson& person) const {
  FrameEquations result(person, round.shape);
  add_points(round, frames_[frame], person, result);
  add_seen(round, frames_[frame], person, result);
  result.parent_axes();
  return result;
}

/// White accelerations: over frames a, b, c the change of speed has a variance of power x (c - a) / 3.
void CaptureFit::tie(BandedBlocks& blocks, Eigen::VectorXd& pull) const {
  for (int b = 1; b + 1 < ssize(poses); ++b) {
    const double since = frames_[b].seconds - frames_[b - 1].seconds,
                 until = frames_[b + 1].seconds - frames_[b].seconds;
    const std::array<double, 3> slope = {1 / since, -1 / since - 1 / until, 1 / until};
    const auto add = [&](int unknown, const Vec3& before, const Vec3& on, double power) {
      const double weight = 3 / (power * (since + until));
      for (int k = 0; k < 3; ++k) {
        const int i = unknown + k;
        const double off = static_cast<double>(on[k]) / until - static_cast<double>(before[k]) / since;
        for (int x = 0; x < 3; ++x) {
          blocks.own[b - 1 + x](i, i) += weight * slope[x] * slope[x];
          pull[(b - 1 + x) * kPoseUnknowns + i] -= weight * slope[x] * off;
        }
        blocks.next[b - 1][i] += weight * slope[0] * slope[1];
        blocks.next[b][i] += weight * slope[1] * slope[2];
        blocks.second[b - 1][i] += weight * slope[0] * slope[2];
      }
    };
    const Pose &past = poses[b - 1], &now = poses[b], &next = poses[b + 1];
    add(0, now.root - past.root, next.root - now.root, static_cast<double>(kRootPower));
    for (int j = 0; j < kJointCount; ++j)
      add(3 + 3 * j, rotation_to_axis_angle(now.local[j] * past.local[j].transpose()),
          rotation_to_axis_angle(next.local[j] * now.local[j].transpose()),
          static_cast<double>(kTurnPower[j]));
  }
}

void CaptureFit::step(const FitRound& round) {
  const int count = ssize(poses), shapes = round.shape ? model_->parameters() : 0;
  BandedBlocks blocks(count, kPoseUnknowns);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(count * kPoseUnknowns);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(pull.size(), 1 + shapes);
  Eigen::MatrixXd of_shape = Eigen::MatrixXd::Zero(shapes, shapes);
  Eigen::VectorXd shape_pull = Eigen::VectorXd::Zero(shapes);
  const Points rest = model_->shaped(shape, swelling);
  for (int t = 0; t < count; ++t) {
    const PosedPerson person(*model_, shape, rest, poses[t]);
    FrameEquations frame = equations(round, t, person);
    add_habits(poses[t], frame);
    blocks.own[t] = frame.H.topLeftCorner(kPoseUnknowns, kPoseUnknowns);
    pull.segment(t * kPoseUnknowns, kPoseUnknowns) = frame.g.head(kPoseUnknowns);
    right.block(t * kPoseUnknowns, 1, kPoseUnknowns, shapes) = frame.H.topRightCorner(kPoseUnknowns, shapes);
    of_shape += frame.H.bottomRightCorner(shapes, shapes);
    shape_pull += frame.g.tail(shapes);
  }
  if (round.together) tie(blocks, pull);
  for (int s = 0; s < shapes; ++s) {
    const double weight = 1 / std::pow(static_cast<double>(model_->spread[s]), 2);
    of_shape(s, s) += weight;
    shape_pull[s] -= weight * static_cast<double>(shape[s]);
  }
  if (!blocks.factor()) return;
  right.col(0) = pull;
  const Eigen::MatrixXd cross = right.rightCols(shapes);
  blocks.solve(right);
  Eigen::VectorXd poses_by = right.col(0);
  if (shapes > 0) {
    const Eigen::MatrixXd reduced = of_shape - cross.transpose() * right.rightCols(shapes);
    const Eigen::VectorXd change = reduced.ldlt().solve(shape_pull - cross.transpose() * right.col(0));
    if (!change.allFinite()) return;
    poses_by -= right.rightCols(shapes) * change;
    shape += change.cast<float>();
    for (int s = 0; s < shapes; ++s)
      shape[s] = std::clamp(shape[s], -4 * model_->spread[s], 4 * model_->spread[s]);
  }
  if (!poses_by.allFinite()) return;
  for (int t = 0; t < count; ++t) move(poses_by.segment(t * kPoseUnknowns, kPoseUnknowns), poses[t]);
}

/// Where the points lie about the shaped surface, on average over all frames, smoothed over neighbours.
void CaptureFit::swell() {
  const Points rest = model_->shaped(shape, swelling);
  const Eigen::Index count = rest.rows();
  Eigen::ArrayXf weight = Eigen::ArrayXf::Zero(count), sum = weight;
  for (int t = 0; t < ssize(poses); ++t) {
    const Points& points = frames_[t].points;
    if (points.rows() == 0) continue;
    const PosedPerson person(*model_, shape, rest, poses[t]);
    const IntMatrix nearest = nearest_neighbours(person.vertices(), points, 1);
    const float share = point_share(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const int v = nearest(i, 0);
      const Vec3 off = (points.row(i) - person.vertices().row(v)).transpose();
      const float w = share * robust(off.squaredNorm(), 0.06f);
      const float along = off.dot(person.normals().row(v).transpose()) + swelling[v];
      for (const int side : {v, model_->mirror[v]}) weight[side] += w, sum[side] += w * along;
    }
  }
  constexpr float kPoint_m = 0.02f;  // of a point: the pose is off, too
  const Eigen::ArrayXf known = weight / (kPoint_m * kPoint_m), pull = sum / (kPoint_m * kPoint_m);
  const float own = 1 / (kSwelling_m * kSwelling_m), beside = 1 / (kWrinkle_m * kWrinkle_m);
  for (int sweep = 0; sweep < 200; ++sweep)  // Gauss-Seidel
    for (Eigen::Index v = 0; v < count; ++v) {
      float around = 0;
      for (const int n : model_->near[v]) around += swelling[n];
      swelling[v] = (pull[v] + beside * around) / (known[v] + own + 6 * beside);
    }
  Eigen::VectorXf even = swelling;
  for (Eigen::Index v = 0; v < count; ++v) even[v] = 0.5f * (swelling[v] + swelling[model_->mirror[v]]);
  swelling = even;
}

/// Markers are where they were on average over the frames, near their usual places.
void CaptureFit::settle_markers() {
  const float leg = leg_length(rest());
  std::array<Vec3, kMarkerCount> sum;
  std::array<float, kMarkerCount> weight;
  const float usual = kMarker_m * kMarker_m / (kMarkerPlace_m * kMarkerPlace_m);
  for (int m = 0; m < kMarkerCount; ++m) {
    const auto& offset = kMarkerPlaces[m].offset;
    sum[m] = usual * leg * Vec3(offset[0], offset[1], offset[2]);
    weight[m] = usual;
  }
  for (int t = 0; t < ssize(poses); ++t) {
    if (frames_[t].markers.empty()) continue;
    const PosedSkeleton posed = forward_kinematics(rest(), poses[t]);
    for (const Evidence::Marked& marked : frames_[t].markers) {
      const int bone = kMarkerPlaces[marked.marker].joint;
      sum[marked.marker] +=
          posed.global[bone].transpose() * (marked.place - posed.joints.row(bone).transpose());
      weight[marked.marker] += 1;
    }
  }
  for (int m = 0; m < kMarkerCount; ++m) marker_offsets_[m] = sum[m] / weight[m];
}

void CaptureFit::run(const FitRound& round) {
  for (int i = 0; i < round.steps; ++i) {
    step(round);
    if (round.shape) settle_markers();
  }
  if (round.swell) swell();
}

float CaptureFit::run_alone(const FitRound& round, int frame, Pose& pose) const {
  const Points rest = model_->shaped(shape, swelling);
  FitRound alone = round;
  alone.shape = false;
  for (int i = 0; i < round.steps; ++i) {
    const PosedPerson person(*model_, shape, rest, pose);
    FrameEquations frame_equations = equations(alone, frame, person);
    add_habits(pose, frame_equations);
    const Eigen::VectorXd by =
        frame_equations.H.selfadjointView<Eigen::Lower>().ldlt().solve(frame_equations.g);
    if (!by.allFinite()) break;
    move(by, pose);
  }
  float misfit = habit_misfit(pose);
  const Points& points = frames_[frame].points;
  const PosedPerson person(*model_, shape, rest, pose);
  for (const Evidence::Marked& marked : frames_[frame].markers) {
    const int bone = kMarkerPlaces[marked.marker].joint;
    const Vec3 at = person.skeleton().joints.row(bone).transpose() +
                    person.skeleton().global[bone] * marker_offsets_[marked.marker];
    misfit += std::min(0.04f, (marked.place - at).squaredNorm()) / (2 * round.surface_m * round.surface_m);
  }
  const float share = point_share(points.rows()) / (2 * round.surface_m * round.surface_m);
  if (points.rows() > 0) {
    const IntMatrix nearest = nearest_neighbours(person.vertices(), points, 1);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      misfit += share * std::min(0.02f, (points.row(i) - person.vertices().row(nearest(i, 0))).squaredNorm());
    const Points some = every(kCoverStride, person.vertices());
    const IntMatrix back = nearest_neighbours(frames_[frame].filled, some, 1);
    const float each = 0.3f * share * static_cast<float>(points.rows()) / static_cast<float>(some.rows());
    for (Eigen::Index v = 0; v < some.rows(); ++v)
      misfit += each * std::min(0.02f, (frames_[frame].filled.row(back(v, 0)) - some.row(v)).squaredNorm());
  }
  return misfit;
}

std::vector<float> CaptureFit::expected_errors(const FitRound& round) const {
  std::vector<float> errors;
  const Points rest = model_->shaped(shape, swelling);
  for (int t = 0; t < ssize(poses); ++t) {
    FitRound alone = round;
    alone.shape = false;
    const PosedPerson person(*model_, shape, rest, poses[t]);
    FrameEquations frame = equations(alone, t, person);
    add_habits(poses[t], frame);
    const Eigen::MatrixXd covariance = frame.H.selfadjointView<Eigen::Lower>().ldlt().solve(
        Eigen::MatrixXd::Identity(kPoseUnknowns, kPoseUnknowns));
    double sum = 0;
    for (int j = 0; j < kJointCount; ++j) {
      Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(3, kPoseUnknowns);
      slope.leftCols<3>().setIdentity();
      for (int k = kParents[j]; k >= 0; k = kParents[k]) {
        const Vec3 arm = (person.skeleton().joints.row(j) - person.skeleton().joints.row(k)).transpose();
        Mat3 cross;
        cross << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
        const Mat3 up = kParents[k] < 0 ? Mat3(Mat3::Identity()) : person.skeleton().global[kParents[k]];
        slope.middleCols<3>(3 + 3 * k) = (cross * up).cast<double>();
      }
      sum += std::sqrt(std::max(0.0, (slope * covariance * slope.transpose()).trace()));
    }
    errors.push_back(static_cast<float>(sum / kJointCount));
  }
  return errors;
}

}  // namespace understudy
