// Figures of a rig that was found in scans, against the true one.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/metrics/rig_truth.hpp"

namespace understudy {

// s is body_size() of the true vertices. All but sc are against merged_truth(). Joints are those of the tree
// but its root: where two parts meet.

/// True joints and found ones, one to one, so that the sum of e = mean over frames of |found - true| / s is
/// least; beyond 0.1 e hardly counts more. Else one joint that is missed and one too many would push all
/// pairs of the chain between them one further.
struct JointPairs {
  std::vector<int> found;  ///< [J] of each true joint the found one, -1: none; of the root -1
  std::vector<double> e;   ///< [J] beside it; infinite where there is none
  int found_count = 0;     ///< without the root
  /// Pairs with e < 0.05.
  int good() const;
  double recall() const;     ///< good pairs a true joint; NaN where the truth has none
  double precision() const;  ///< good pairs a found joint; 0 where there are only true ones, NaN where none
  double error_pct() const;  ///< median of 100 e of the good pairs; NaN where there are none
};
constexpr double kJointFound = 0.05;
JointPairs pair_joints(const RigTruth& found, const RigTruth& truth);

/// Mean angle between the true axes of hinges and the found ones, over frames and pairs with e < 0.05,
/// degrees, 0..90: a found Hinge's own axis, of another joint the principal axis of its turns against the
/// parent (90 where it never turns). NaN where no true hinge has a pair.
double hinge_error_deg(const RiggedMotion& found, const RigTruth& truth, const JointPairs& pairs);

/// Share of pairs of points that both labellings put together or both apart (Rand index), and the same beyond
/// what chance gives (Hubert and Arabie 1985; 1 where neither divides the points).
struct RandIndex {
  double plain = 1, adjusted = 1;
};
/// Labels from 0 of the same points, at least two. Throws Error where they are of different numbers.
RandIndex rand_index(const std::vector<int>& a, const std::vector<int>& b);

/// Of scan points the bone of largest weight at the nearest place on the surface, in the found rig and in the
/// truth: 2,000 points of each of five frames, evenly; those further than 2 % of s from the true surface
/// (floor, outliers) are of no part and left out.
struct PartLabels {
  std::vector<int> found, truth;
};
PartLabels part_labels(const RigTruth& found, const RigTruth& truth, const std::vector<Mesh>& scans);

/// F1 of the edges between parts, which are paired one to one by most points in common; an edge is right
/// where the truth joins the partners of its ends. Parts without a point are one with their parents. 1 where
/// neither tree has an edge.
double tree_f1(const std::vector<int>& found_parents, const std::vector<int>& true_parents,
               const PartLabels& labels);

/// 100 mean |x' - x| / s: 2,000 points x of the true surface, laid on the nearest places of the found surface
/// as it is in `rest_frame`, and carried by the found rig as x'.
double track_error_pct(const RigTruth& found, int rest_frame, const RigTruth& truth);

/// 100 / s times the mean of both directions' mean distances between the surface and the scans: from up to
/// 4,000 scan points to the surface, and from 4,000 of the surface to the scan (of a cloud its points, so
/// that half their spacing remains). Frames with an empty scan are left out; NaN where all are. Throws Error
/// for different numbers of frames.
double surface_error_pct(const std::vector<Points>& vertices, const Faces& faces,
                         const std::vector<Mesh>& scans, double size);

/// 100 mean |vertex - true one| / s after each frame's best similarity: of a body that performs what another
/// did, against the same under the source's true angles. Throws Error for different sizes.
double retarget_error_pct(const std::vector<Points>& vertices, const std::vector<Points>& truth);

/// The same of a rig that was found in scans and performs: 2,000 points of the true surface as it was in
/// `frame` of its own motion, laid on the nearest places of the found surface in that pose (`found_there`,
/// the performing rig's vertices), against where they are in `truth`, the true surface's performance.
double performance_error_pct(const RiggedMotion& performed, const Points& found_there, const RigTruth& own,
                             int frame, const std::vector<Points>& truth);

/// Whether the same keypoint is always nearest to a joint (paper 3, eq. 21), over all frames that are pushed,
/// of whatever sequences have the same keypoints and joints. It says nothing of accuracy, and few keypoints
/// score easily: tell their number beside it.
class SemanticConsistency {
 public:
  /// keypoints [K, 3], joints [J, 3]. Throws Error for other numbers than before, or none.
  void push(const Points& keypoints, const Points& joints);
  /// The keypoint that is the nearest to a joint in most frames, and their share.
  struct Steadiest {
    int keypoint = -1;
    double share = 0;
  };
  /// [J]; nothing before any frame.
  std::vector<Steadiest> joints() const;
  /// Mean over joints of that share; NaN before any.
  double value() const;

 private:
  Eigen::MatrixXd nearest_;  // [J, K] frames
  int frames_ = 0;
};

/// All figures by their keys in the metric table; undefined ones are left out: joint_recall, joint_precision,
/// joint_error_pct, hinge_deg, part_ri, part_ari, tree_f1, track_pct, surface_pct, sc and sc_keypoints,
/// cd_1e4, m_cd, true_parts, found_parts. rest_frame: in which the found surface is the scan. The scans are
/// the truth's frames. Throws Error where numbers of frames disagree.
std::vector<std::pair<std::string, double>> rig_figures(const RiggedMotion& found, int rest_frame,
                                                        const std::vector<Mesh>& scans,
                                                        const RigTruth& truth);

}  // namespace understudy
