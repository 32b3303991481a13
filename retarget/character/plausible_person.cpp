#include "retarget/character/plausible_person.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/formats/mesh_reader.hpp"

namespace understudy {
namespace {

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
  const Points points = finite_points(mesh.vertices);
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
  const Eigen::Matrix2f spread = floor.transpose() * floor;
  const Eigen::Matrix2f axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(spread).eigenvectors();
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
           " apart, as those of an animal or a table";
  return s.length > 1.8f ? tall + centimetres(s.length, s.height) + " long" : "";
}

std::string doubt(const Stance& s) {
  if (!refusal(s).empty()) return refusal(s);
  if (s.feet > 0.75f) return "its feet are " + centimetres(s.feet, s.height) + " apart";
  if (s.length > 1.35f || s.width > 0.7f)
    return "it is " + centimetres(1, s.height) + " tall, " + centimetres(s.length, s.height) + " wide and " +
           centimetres(s.width, s.height) + " deep";
  return {};
}

}  // namespace understudy
