// Errors of a surface against the true one, frame by frame, and figures of a surface without truth.
#pragma once

#include <optional>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/metrics/inside.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

// p predicted, q true, both [V, 3] metres in the same vertex order, V >= 1; otherwise Error. Sums are kept in
// double.

/// Mean over vertices of |p - q|, metres.
double mean_vertex_error(const Points& p, const Points& q);
/// The same after the best similarity of p onto q. V >= 3.
double aligned_vertex_error(const Points& p, const Points& q);
/// Edges join each true vertex to its `neighbours` nearest true ones in this frame (fewer vertices: all
/// others). Mean over edges of |length in p - length in q|, metres. 0 for a single vertex.
double edge_length_error(const Points& p, const Points& q, int neighbours = 6);

/// Half the sum of the mean distance from each point of p to the nearest of q and of that from q to p,
/// metres: how far two surfaces are from each other whose points are not each other's (paper 2, section 6.2).
/// Any numbers of points, at least one each; otherwise Error. Surfaces that slide along themselves differ by
/// up to half the distance of their points.
double chamfer_distance(const Points& p, const Points& q);

/// y of the lowest vertex that is finite; none where none is.
std::optional<float> lowest_height(const Points& vertices);
/// How far the lowest vertex lies below the floor (y = 0), metres; 0 when none does.
double floor_penetration(const Points& vertices);

/// How much hands and head, which have no joints of their own that bend them, are stretched in a pose.
class PartStretch {
 public:
  /// A T-pose and its joints: the hands are what lies beyond the wrists, the head what lies above its joint.
  PartStretch(const Points& rest, const Faces& faces, const Joints& rest_joints);
  /// Changes of the edges' lengths together over the lengths together; NaN where the part has no edges.
  double hands(const Points& vertices) const { return stretch(hands_, vertices); }
  double head(const Points& vertices) const { return stretch(head_, vertices); }

 private:
  struct Edge {
    int a, b;
    double length;  // in T-pose, metres
  };
  static double stretch(const std::vector<Edge>& edges, const Points& vertices);
  std::vector<Edge> hands_, head_;
};

/// Evaluates which vertices of a posed surface have entered another part of the same body.
class SelfPenetration {
 public:
  /// `samples` vertices are evaluated, chosen far apart in the T-pose; those inside already in the T-pose
  /// (layers of clothes, eyes, tongues) never count. Throws Error without faces.
  SelfPenetration(const Points& rest, const Faces& faces, int samples = 200);
  /// Share of the evaluated vertices that lie inside the posed surface, 0..1.
  double share(const Points& vertices) const;

 private:
  std::vector<bool> buried(const Points& vertices) const;
  Faces faces_;
  Windings windings_;
  std::vector<int> evaluated_;  // vertex numbers
};

}  // namespace understudy
