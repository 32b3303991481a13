#include "retarget/metrics/rig_truth.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr double kStillTurn = 5 * M_PI / 180, kStillSlide = 0.01;
constexpr int kComparedFrames = 300;

/// At most `count` of the frames, evenly from the first to the last.
std::vector<int> even_frames(int frames, int count) {
  std::vector<int> chosen;
  chosen.reserve(static_cast<size_t>(std::min(frames, count)));
  for (int i = 0; i < std::min(frames, count); ++i)
    chosen.push_back(frames <= count ? i : i * (frames - 1) / (count - 1));
  return chosen;
}

bool is_still(const RigTruth& truth, int j, double size) {
  std::vector<Mat3> turns;
  std::vector<Vec3> places;
  for (const int t : even_frames(truth.frames(), kComparedFrames)) {
    const RigidMotion& parent = truth.bones[t][truth.parents[j]];
    turns.emplace_back(parent.R.transpose() * truth.bones[t][j].R);
    places.emplace_back(parent.inverse()(truth.joints[t].row(j).transpose()));
  }
  for (size_t a = 0; a < turns.size(); ++a)
    for (size_t b = 0; b < a; ++b)
      if (static_cast<double>(geodesic_angle(turns[a], turns[b])) >= kStillTurn ||
          static_cast<double>((places[a] - places[b]).norm()) >= kStillSlide * size)
        return false;
  return true;
}

}  // namespace

void check_rig_truth(const RigTruth& truth) {
  const int J = truth.count(), T = truth.frames();
  const Eigen::Index V = truth.rest.rows();
  US_CHECK(T > 0 && J > 0 && V > 0, "a truth of ", T, " frames, ", J, " joints and ", V, " vertices");
  for (int j = 0; j < J; ++j)
    US_CHECK(j == 0 ? truth.parents[j] == -1 : truth.parents[j] >= 0 && truth.parents[j] < j, "true joint ",
             j, " hangs on ", truth.parents[j], ", which does not come before it");
  US_CHECK(ssize(truth.joints) == T && ssize(truth.bones) == T, "true vertices of ", T, " frames, joints of ",
           truth.joints.size(), ", bones of ", truth.bones.size());
  US_CHECK(ssize(truth.axes) == J, truth.axes.size(), " true axes of ", J, " joints");
  US_CHECK(truth.weights.rows() == V && truth.weights.cols() == J && truth.weights.allFinite(),
           "true weights of ", truth.weights.rows(), " vertices and ", truth.weights.cols(), " joints, not ",
           V, " and ", J);
  US_CHECK(truth.faces.size() == 0 || (truth.faces.minCoeff() >= 0 && truth.faces.maxCoeff() < V),
           "a true face names a vertex that is not there");
  for (int t = 0; t < T; ++t) {
    US_CHECK(truth.vertices[t].rows() == V && truth.joints[t].rows() == J && ssize(truth.bones[t]) == J,
             "the truth's frame ", t, " is of another size");
    US_CHECK(truth.vertices[t].allFinite() && truth.joints[t].allFinite(), "the truth's frame ", t,
             " is not finite");
  }
}

RigTruth truth_of(const RiggedMotion& performed) {
  const Rig& rig = performed.rig;
  check_rig(rig);
  RigTruth truth;
  truth.faces = rig.surface.faces;
  truth.rest = rig.surface.vertices;
  truth.weights = rig.skin.dense(rig.count());
  for (const RigJoint& joint : rig.joints) {
    truth.parents.push_back(joint.parent);
    truth.axes.push_back(joint.kind == JointKind::Hinge ? joint.axis : Vec3::Zero());
  }
  for (const RigPose& pose : performed.motion.poses) {
    const BoneMotions bones = bone_motions(rig, pose);
    truth.vertices.push_back(skinned(truth.rest, rig.skin, bones));
    truth.joints.push_back(joint_places(rig, bones));
    truth.bones.push_back(bones);
  }
  return truth;
}

double body_size(const std::vector<Points>& vertices) {
  US_CHECK(!vertices.empty(), "a body without frames has no size");
  double sum = 0;
  for (const Points& frame : vertices) {
    US_CHECK(frame.rows() > 0, "a body without vertices has no size");
    sum += static_cast<double>(box_diagonal(frame));
  }
  US_CHECK(sum > 0 && std::isfinite(sum), "a body that is one point has no size");
  return sum / static_cast<double>(vertices.size());
}

RigTruth merged_truth(const RigTruth& truth) {
  check_rig_truth(truth);
  const double size = body_size(truth.vertices);
  std::vector<int> kept, part;  // joints that stay; of each joint the one of them that it is part of
  for (int j = 0; j < truth.count(); ++j) {
    const bool still = j > 0 && is_still(truth, j, size);
    part.push_back(still ? part[truth.parents[j]] : static_cast<int>(kept.size()));
    if (!still) kept.push_back(j);
  }
  RigTruth merged;
  merged.vertices = truth.vertices;
  merged.faces = truth.faces;
  merged.rest = truth.rest;
  merged.weights = RowMatrix::Zero(truth.weights.rows(), ssize(kept));
  for (int j = 0; j < truth.count(); ++j) merged.weights.col(part[j]) += truth.weights.col(j);
  for (const int j : kept) {
    merged.parents.push_back(j == 0 ? -1 : part[truth.parents[j]]);
    merged.axes.push_back(truth.axes[j]);
  }
  for (int t = 0; t < truth.frames(); ++t) {
    merged.joints.emplace_back(truth.joints[t](kept, Eigen::all));
    BoneMotions& bones = merged.bones.emplace_back();
    for (const int j : kept) bones.push_back(truth.bones[t][j]);
  }
  return merged;
}

}  // namespace understudy
