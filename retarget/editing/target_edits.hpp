// Edits of the target: T-pose joints moved, skin weights painted, smoothed, mirrored.
#pragma once

#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/geometry/brush_mode.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// A T-pose joint put somewhere else.
struct JointMove {
  int joint = 0;
  Vec3 position = Vec3::Zero();  ///< metres, in the T-pose
  bool mirror = true;            ///< the other side's joint follows; a joint of the spine stays in the middle
};
template <class V, class S>
FieldsOf<S, JointMove> fields(V& visit, S& move) {
  visit("joint", move.joint, Within<int>{0, kJointCount - 1});
  visit("position", move.position);
  visit("mirror", move.mirror);
}

/// x of the plane that a body in T-pose is symmetric about: the mean over joints and their mirror images.
float symmetry_centre(const Joints& rest);
/// The joints after the moves, in their order; mirrored about symmetry_centre(rest). Throws Error for a joint
/// that is none or a position that is not finite.
Joints apply(const std::vector<JointMove>& moves, const Joints& rest);

/// A bone of the rest pose turned by the hand; the bones after it come along.
struct BoneTurn {
  int joint = 0;
  Vec3 axis_angle = Vec3::Zero();  ///< radians, in the joint's own frame
};
template <class V, class S>
FieldsOf<S, BoneTurn> fields(V& visit, S& turn) {
  visit("joint", turn.joint, Within<int>{0, kJointCount - 1});
  visit("axis_angle", turn.axis_angle);
}

/// Local rotations of a rest pose against the T-pose. Throws Error for a joint that is none or an angle that
/// is not finite.
Rotations rest_rotations(const std::vector<BoneTurn>& turns);
/// A rest pose in which one more bone is turned, after what turned it before: one turn a joint. mirror: the
/// bone on the other side is turned as seen in a mirror.
std::vector<BoneTurn> turned(const std::vector<BoneTurn>& turns, const BoneTurn& more, bool mirror);

/// Rows of a [V, 22] weight matrix that replace those there: what documents keep.
struct WeightRows {
  std::vector<int> vertex;         ///< ascending, each once
  RowMatrix rows{0, kJointCount};  ///< [vertex.size(), 22], not negative, sums 1
  Points places{0, 3};             ///< [vertex.size(), 3] where they were painted, T-pose; empty: not known
  int of = 0;                      ///< vertices of the target that was painted; 0: not known
  bool empty() const { return vertex.empty(); }
};
template <class V, class S>
FieldsOf<S, WeightRows> fields(V& visit, S& edit) {
  visit("vertex", edit.vertex);
  visit("rows", edit.rows);
  visit("places", edit.places);
  visit("of", edit.of);
}

/// Puts the rows in. Throws Error when they were painted on other vertices than these, or the columns differ.
void apply(const WeightRows& edit, RowMatrix& weights);
/// With what is needed to bring the rows to another surface, should the target's file change. vertices:
/// [V, 3] of the target in T-pose, metres.
WeightRows placed(WeightRows edit, const Points& vertices);
/// The same on another surface [V, 3] in T-pose: a row goes to the vertex nearest to where it was painted; of
/// several at one vertex the mean. Throws Error where it is not known where they were painted.
WeightRows reprojected(const WeightRows& edit, const Points& vertices);
/// Both; where both have a vertex, the newer row. The places are not kept.
WeightRows merged(const WeightRows& older, const WeightRows& newer);

/// Which vertices are joined, from the faces; vertices at one place (seams of textures) are joined too. Of a
/// cloud: the six nearest. Make it once per target.
struct Neighbours {
  std::vector<int> start;  ///< [V + 1]: those of v are index[start[v]] .. index[start[v + 1]]
  std::vector<int> index;
  static Neighbours from(const Mesh& mesh);
  int vertices() const { return start.size() - 1; }
};

struct Brush {
  int joint = 0;  ///< the one painted; Smooth smooths all
  float radius_m = 0.05f;
  float strength = 0.5f;  ///< 0..1, of one dab at its centre
  BrushMode mode = BrushMode::Add;
};

/// A mesh to paint on; keeps references.
struct PaintSurface {
  const Points& vertices;
  const Neighbours& neighbours;
};

/// One dab at `hit`, a point on the surface: the changed rows. Strength falls off smoothly to 0 at the
/// radius, and only the surface that hangs together with the hit within about the radius is painted: a dab
/// on one thigh leaves the other. Add takes from the other joints in proportion; Subtract gives to them,
/// where there are none to the joint's parent (the pelvis: spine1). Throws Error for sizes that disagree or a
/// brush out of range.
WeightRows stroke(const RowMatrix& weights, const PaintSurface& surface, const Vec3& hit, const Brush& brush);

/// The whole of each row towards its neighbours' mean by `strength` 0..1, `rounds` times. `vertex`: which
/// ones, all when empty.
WeightRows smoothed(const RowMatrix& weights, const Neighbours& neighbours, const std::vector<int>& vertex,
                    float strength, int rounds = 1);

enum class BodySide { Left, Right };
/// Rows of the other side made from `from`: each vertex takes the row of the vertex nearest to its mirror
/// image about x = `centre`, joints exchanged; vertices on the plane take the mean of both. Cloud or mesh.
WeightRows mirrored_weights(const RowMatrix& weights, const Points& vertices, BodySide from,
                            float centre = 0);

}  // namespace understudy
