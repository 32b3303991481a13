#include "retarget/character/stance.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/character/rest_pose.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/observer.hpp"

namespace understudy {
namespace {

constexpr float kReach = 75 * kPi / 180;  // from the guess
constexpr size_t kSides = std::tuple_size_v<SideViews>;
constexpr float kUpsideDown = 0.4f;  // of the legs: those who stand have 0.75 to 0.9 and 1

float turn_of(size_t side) {
  return 2 * kPi * static_cast<float>(side) / kSides;
}

/// Mean distance of points to their mirror image about the upright plane through the middle that faces this
/// way; far ones count as 5 % of the height, so that one odd limb does not decide.
float asymmetry(const Points& points, float heading, float tall) {
  const Mat3 turn = rotation_about_y(-heading);
  Points facing = points * turn.transpose();
  Points flipped = facing;
  flipped.col(0) *= -1;
  const auto nearest = nearest_neighbours(facing, flipped, 1);
  float sum = 0;
  for (Eigen::Index i = 0; i < flipped.rows(); ++i)
    sum += std::min(0.05f * tall, (flipped.row(i) - facing.row(nearest(i, 0))).norm());
  return sum / static_cast<float>(points.rows());
}

struct Ends {
  float low = 0, high = 0;
  float size() const { return high - low; }
};

Ends ends_of(const Eigen::VectorXf& column) {
  std::vector<float> values(column.data(), column.data() + column.size());
  std::sort(values.begin(), values.end());
  const size_t stray = values.size() / 500;  // at each end
  return {values[stray], values[values.size() - 1 - stray]};
}

Points evenly(const Mesh& mesh) {
  Points points = finite_points(mesh.vertices);
  US_CHECK(points.rows() > 0, "the body has no finite point");
  if (mesh.faces.rows() == 0 || points.rows() != mesh.vertices.rows()) return points;
  try {
    Rng rng(1);
    return sample_points(mesh, 6000, rng);
  } catch (const Error&) {  // no area
    return points;
  }
}

std::string centimetres(float share, float height) {
  return std::to_string(static_cast<int>(std::lround(100 * share * height))) + " cm";
}

}  // namespace

Stance stance_of(const Mesh& mesh) {
  const Points points = evenly(mesh);
  Stance out;
  const Ends y = ends_of(points.col(1));
  out.height = std::max(y.size(), 1e-12f);
  out.centre = (points.col(1).mean() - y.low) / out.height;
  Eigen::Matrix<float, Eigen::Dynamic, 2> floor(points.rows(), 2);
  floor << points.col(0), points.col(2);
  const Eigen::RowVector2f mean = floor.colwise().mean();
  floor.rowwise() -= mean;
  const Eigen::Matrix2f covariance = floor.transpose() * floor;
  const Eigen::Matrix2f axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(covariance).eigenvectors();
  const Eigen::VectorXf across = floor * axes.col(0), along = floor * axes.col(1);
  out.length = ends_of(along).size() / out.height;
  out.width = ends_of(across).size() / out.height;
  Ends feet{1e30f, -1e30f};
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points(i, 1) < y.low + 0.07f * out.height)
      feet = {std::min(feet.low, along[i]), std::max(feet.high, along[i])};
  out.feet = std::max(0.0f, feet.size()) / out.height;
  return out;
}

bool lies_down(const Stance& stance) {
  return stance.length > 1 / 0.33f;
}

std::string refusal(const Stance& s) {
  const std::string tall = "it is " + centimetres(1, s.height) + " tall and ";
  if (lies_down(s)) return "it lies down: " + tall + centimetres(s.length, s.height) + " long";
  if (s.feet > 0.8f && s.length > 1.1f)
    return tall + "its feet are " + centimetres(s.feet, s.height) +
           " apart, like those of an animal or a table";
  return s.length > 1.8f ? tall + centimetres(s.length, s.height) + " long" : "";
}

std::string implausibility(const Stance& s) {
  if (!refusal(s).empty()) return refusal(s);
  if (s.feet > 0.75f) return "its feet are " + centimetres(s.feet, s.height) + " apart";
  if (s.length > 1.35f || s.width > 0.7f)
    return "it is " + centimetres(1, s.height) + " tall, " + centimetres(s.length, s.height) + " wide and " +
           centimetres(s.width, s.height) + " deep";
  return {};
}

std::string doubt(const Stance& s) {
  std::string why = implausibility(s);
  if (!why.empty() || s.feet <= 0.4f) return why;
  return "its feet are " + centimetres(s.feet, s.height) + " apart";
}

bool shows_nobody(const SideViews& seen) {
  const auto nobody = [](const Extraction& view) {
    Observation observation;
    static_cast<Extraction&>(observation) = view;
    return !refusal(observation).empty() || is_implausible(view);
  };
  return std::count_if(seen.begin(), seen.end(), nobody) + 1 >= static_cast<long>(kSides);
}

float symmetric_heading(const Points& points, float guess) {
  US_CHECK(points.rows() > 0, "a body without points has no heading");
  Points centred = points;
  const Eigen::RowVector3f middle(points.col(0).mean(), 0, points.col(2).mean());
  centred.rowwise() -= middle;
  const float tall = points.col(1).maxCoeff() - points.col(1).minCoeff();
  float best = guess, least = 1e9f;
  const auto consider = [&](float heading) {
    const float far = std::remainder(heading - guess, 2 * kPi) / kReach;
    const float cost = asymmetry(centred, heading, tall) * (1 + 0.3f * far * far);
    if (cost < least) {
      least = cost;
      best = heading;
    }
  };
  const float at_guess = asymmetry(centred, guess, tall);
  constexpr int kCoarse = 12;
  for (int i = -kCoarse; i <= kCoarse; ++i) consider(guess + kReach * static_cast<float>(i) / kCoarse);
  const float near = best;
  for (int i = -4; i <= 4; ++i) consider(near + kReach / kCoarse * static_cast<float>(i) / 5);
  return least < 0.8f * at_guess ? best : guess;
}

SideViews seen_from_sides(const Mesh& mesh, SkeletonExtractor& extractor) {
  SideViews views;
  Mesh seen = mesh;
  for (size_t side = 0; side < kSides; ++side) {
    seen.vertices = mesh.vertices * rotation_about_y(turn_of(side)).transpose();
    views[side] = extractor.extract(seen);
  }
  return views;
}

bool is_upside_down(const SideViews& seen) {
  float head = 0, ankles = 0;  // over the pelvis, mean of all sides, shares of the legs
  for (const Extraction& view : seen) {
    const Joints& joints = view.joints;
    const float unit = 1 / (kSides * std::max(leg_length(joints), 1e-6f));
    head += unit * (joints(Head, 1) - joints(Pelvis, 1));
    ankles += unit * (0.5f * (joints(LeftAnkle, 1) + joints(RightAnkle, 1)) - joints(Pelvis, 1));
  }
  return head < -kUpsideDown && ankles > kUpsideDown;
}

float body_heading(const Mesh& mesh, const SideViews& seen) {
  Vec3 sum = Vec3::Zero();
  for (size_t side = 0; side < kSides; ++side) {
    const Extraction& found = seen[side];
    const float heading = heading_of_joints(found.joints) - turn_of(side);
    sum += std::max(0.01f, found.confidence.mean()) * Vec3(std::sin(heading), 0, std::cos(heading));
  }
  const float guess = std::atan2(sum.x(), sum.z());
  Rng rng(20261);
  return symmetric_heading(sample_points(mesh, 700, rng), guess);
}

}  // namespace understudy
