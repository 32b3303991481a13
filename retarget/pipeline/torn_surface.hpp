// Notices a body whose pieces part while it performs: a rig mapped wrongly, or weights that are none of its.
#pragma once

#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Pieces that move as one, and the links between them: edges of faces, and places where pieces that share
/// none touch at rest. A smooth skin is one piece and costs nothing.
class TornSurface {
 public:
  /// How far pieces may part, as a share of the body's height.
  static constexpr float kMost = 0.03f;

  TornSurface() = default;
  /// rest: the body at rest, where it is whole; weights [V, 22] of its skin. Clouds have no pieces.
  TornSurface(const Mesh& rest, const RowMatrix& weights);

  /// By how much pieces that are linked at rest have parted, as a share of the height: 0 where all that are
  /// larger than a hundredth of the body hold together by some link that has grown by less than kMost.
  /// vertices: [V, 3] of all.
  float parted(const Points& vertices) const;
  /// The same of a pose, by linear blend skinning. rest_joints: of the rest that it was made with.
  float parted(const Joints& rest_joints, const Pose& pose) const;

 private:
  struct Link {
    int a, b;      // rows of `ends_`
    float length;  // at rest
  };
  float parted_ends(const Points& ends) const;

  float height_ = 0;
  std::vector<Link> links_;
  std::vector<int> end_vertices_;  // of the body
  std::vector<int> piece_;         // of each end
  std::vector<int> size_;          // of each piece, vertices
  int smallest_ = 0;               // that counts
  Points ends_{0, 3};              // at rest
  RowMatrix weights_;              // of the ends
};

}  // namespace understudy
