// A body that can be fitted to points: the built-in person, stretched bone by bone, as thick as its samples
// are, and swollen smoothly where the points say so.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "retarget/body/body.hpp"

namespace understudy {

/// A body whose T-pose is linear in a few parameters, each about 0 with its own spread, with as much of its
/// surface as fitting looks at. Left and right are alike.
struct PersonModel {
  ShapedBody whole;          ///< the template, all of its surface
  Points vertices, normals;  ///< [N, 3] of the template, those that are looked at
  struct Skin {              ///< the bones that carry a vertex, at most four
    std::array<int, 4> bone = {};
    std::array<float, 4> weight = {};  ///< 0 where there are fewer; sum 1
  };
  std::vector<Skin> skin;                ///< [N]
  std::vector<Points> vertex_dirs;       ///< what each parameter adds to the vertices, [N, 3]
  std::vector<Joints> joint_dirs;        ///< and to the joints
  std::vector<Points> whole_dirs;        ///< and to all of the surface
  std::vector<float> spread;             ///< standard deviation of each parameter among people
  std::vector<int> mirror;               ///< [N] the vertex on the other side; itself in the middle
  std::vector<std::array<int, 6>> near;  ///< [N] vertices beside each, along the surface

  int parameters() const { return static_cast<int>(spread.size()); }
  Joints joints(const Eigen::VectorXf& shape) const;
  /// T-pose vertices; `swelling` [N] metres along the normals, may be empty.
  Points shaped(const Eigen::VectorXf& shape, const Eigen::VectorXf& swelling) const;
  /// The whole surface of it.
  ShapedBody body(const Eigen::VectorXf& shape, const Eigen::VectorXf& swelling) const;
};

/// The built-in person's: made on first use, which takes seconds, then kept. Safe from several threads.
std::shared_ptr<const PersonModel> builtin_person_model();

}  // namespace understudy
