// People posed in double precision: for truths, whose random scans must not depend on the last digit of a
// float.
#pragma once

#include <memory>
#include <vector>

#include "retarget/body/body.hpp"

namespace understudy {

using Points64 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Joints64 = Eigen::Matrix<double, kJointCount, 3, Eigen::RowMajor>;
using Rotations64 = std::array<Eigen::Matrix3d, kJointCount>;

/// ShapedBody in double precision.
struct ExactPerson {
  Points64 vertices;
  Joints64 joints;
  Faces faces;
  RowMatrix weights;
  std::shared_ptr<const Eigen::MatrixXd> pose_dirs;  ///< [3V, 189]; may be null

  double leg() const;
};

/// Shapes people of one parametric body.
class ExactBody {
 public:
  explicit ExactBody(const Body& body);
  ExactPerson shaped(const Eigen::VectorXf& betas) const;

 private:
  const Body& body_;
  std::shared_ptr<const Eigen::MatrixXd> pose_dirs_;
};

/// A person with skin weights and no pose-corrective offsets.
ExactPerson exact_person(const ShapedBody& body);

/// A body's motion: local rotations and the pelvis in the world.
struct ExactMotion {
  std::vector<Rotations64> local;
  std::vector<Eigen::Vector3d> root;
};

/// Rodrigues' formula; the length is the angle.
Eigen::Matrix3d exact_rotation(const Eigen::Vector3d& axis_angle);
/// Frames `start` to `start + frames` (fewer where the clip ends) of an AMASS-format clip at 30 frames a
/// second, y up: faster clips are thinned, z-up ones turned. Throws Error naming the file when it ends
/// before `start`.
ExactMotion read_exact_motion(const std::string& path, int start, int frames);

/// All frames of a performance.
struct Performance {
  std::vector<Points64> vertices;
  std::vector<Joints64> joints;
};

/// The person performs the motion with its path scaled; the soles stand on the floor: the 2nd percentile of
/// the frames' lowest points is 0.
Performance perform(const ExactPerson& person, const ExactMotion& motion, double path_scale);
/// The same with other T-pose vertices in each frame, as of a person whose fingers move.
Performance perform(const ExactPerson& person, const std::vector<Points64>& shapes, const ExactMotion& motion,
                    double path_scale);

}  // namespace understudy
