// How well the frames in gaps were made: errors of the frames that were not known, and of the seams.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "retarget/metrics/joint_metrics.hpp"

namespace understudy {

/// A gap with what is known beside it, filled.
struct FilledGap {
  JointSequence joints, truth;  ///< of all its frames, known ones too; world, metres
  int first = 0, last = 0;      ///< the frames that were not known
  std::vector<float> doubt;     ///< [frames] the error expected of each, metres
  std::vector<double> vertex_errors =
      {};  ///< mean of each frame that was not known, metres; empty: no surface
};

/// Collects gaps. Each figure is of the frames that were not known alone, but for chamfer_m.
class GapScore {
 public:
  /// Throws Error when the parts do not fit.
  void push(const FilledGap& gap, double fps);
  /// How far the surface of any frame is from the true one (chamfer_distance), metres; of known frames, too.
  void push_surface(double chamfer_m) { means_["chamfer_m"].add(chamfer_m); }
  void append(const GapScore& other);
  bool empty() const { return means_.empty(); }

  /// By key, those that are defined: gap_mpjpe_m, mean over frames and joints; gap_rel_mpjpe_m, the same less
  /// the pelvis' place; mve_m, mean over frames and vertices; mve_3_m, mve_8_m and mve_15_m, the mean over
  /// vertices of the 3rd, 8th and 15th frame of those gaps after which nothing is known; chamfer_m, mean over
  /// the frames that were pushed; spread, the rank correlation over frames of doubt and gap_mpjpe_m's error.
  /// Means over gaps: gap_foot_skate and gap_acc of the gap and a frame on each side of it
  /// (joint_metrics.hpp), gap_foot_skate_true the truth's; seam_m, |D2 p - D2 q| over joints and the two
  /// frames at each end of the gap, the last that is known and the first that is not, D2 the second
  /// difference at 30 frames/s.
  std::map<std::string, double> figures() const;

 private:
  struct Mean {
    double sum = 0;
    int64_t count = 0;
    void add(double value);  // unless it is NaN
  };
  void push_frames(const FilledGap& gap);
  void push_seams(const FilledGap& gap, double fps);

  std::map<std::string, Mean> means_;
  std::vector<double> errors_, doubts_;
};

}  // namespace understudy
