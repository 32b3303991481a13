// A person fitted to all frames of a capture at once: Gauss-Newton steps over every pose and the one body.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "retarget/motion_space/banded_blocks.hpp"
#include "retarget/motion_space/person_equations.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// What is known of a frame.
struct Evidence {
  double seconds = 0;
  Points points{0, 3};             ///< on the surface
  Points filled{0, 3};             ///< the same, with guesses between them: what surface there is
  std::optional<Extraction> seen;  ///< joints, as far as they are believed
  float turn_error = 0.3f;         ///< of the rotations in it, radians
  struct Marked {
    int marker;  ///< in kMarkerPlaces
    Vec3 place;
  };
  std::vector<Marked> markers;
};

/// How terms weigh in a round of steps. Lengths are standard deviations, metres.
struct FitRound {
  int steps = 1;
  float reach = 0.1f;       ///< beyond which a point hardly counts
  float surface_m = 0.01f;  ///< of points about the surface
  float cover = 0;          ///< weight of surface to points against points to surface
  float seen = 1;           ///< of what was extracted
  bool shape = true;        ///< the body changes
  bool together = true;     ///< frames are tied by smoothness; else each is by itself
  bool swell = false;       ///< the surface swells after the steps
};

/// The mean of many captured poses, pelvis at the origin.
Pose usual_pose();

class CaptureFit {
 public:
  CaptureFit(std::shared_ptr<const PersonModel> model, std::vector<Evidence> frames);

  Eigen::VectorXf shape;
  Eigen::VectorXf swelling;
  std::vector<Pose> poses;  ///< of each frame

  void run(const FitRound& round);
  /// The same for one frame alone, whose pose it changes and gives the misfit of: minus the logarithm of how
  /// likely points and pose are.
  float run_alone(const FitRound& round, int frame, Pose& pose) const;
  /// Of each frame the error that its joints are expected to have on average, metres.
  std::vector<float> expected_errors(const FitRound& round) const;
  Joints rest() const { return model_->joints(shape); }
  const std::vector<Evidence>& frames() const { return frames_; }
  /// What was extracted of a frame is evidence from now on; null: nothing is. Rotations err by `turn_error`.
  void believe(int frame, const Extraction* seen, float turn_error) {
    frames_[frame].seen.reset();
    if (seen) frames_[frame].seen = *seen;
    frames_[frame].turn_error = turn_error;
  }

 private:
  FrameEquations equations(const FitRound& round, int frame, const PosedPerson& person) const;
  void add_points(const FitRound& round, const Evidence& seen, const PosedPerson& person,
                  FrameEquations& to) const;
  void add_seen(const FitRound& round, const Evidence& seen, const PosedPerson& person,
                FrameEquations& to) const;
  void tie(BandedBlocks& blocks, Eigen::VectorXd& pull) const;
  void step(const FitRound& round);
  void swell();
  void settle_markers();

  std::shared_ptr<const PersonModel> model_;
  std::vector<Evidence> frames_;
  std::vector<Vec3> marker_offsets_;
};

}  // namespace understudy
