// A baseline to compare with: a parametric body fitted to every scan by optimisation, the usual way without
// networks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/body/body.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// A parametric body with as much of its surface as fitting looks at.
struct FitBody {
  /// `count` vertices far apart are looked at.
  explicit FitBody(const Body& body, int count = 1200);

  Points vertices, normals;        ///< [N, 3] of the template
  RowMatrix weights;               ///< [N, 22]
  RowMatrix shape_dirs;            ///< [3N, B]
  RowMatrix pose_dirs;             ///< [3N, 189]; empty without
  Joints joints;                   ///< of the template
  std::vector<Joints> joint_dirs;  ///< what each shape parameter adds to the joints
};

struct BodyFitOptions {
  int iterations = 15;        ///< of a frame, from the frame before
  int first_iterations = 40;  ///< of the first frame, from each of the two best starts
  int start_iterations = 10;  ///< of each start: eight headings, arms out and arms down
  int shape_frames = 5;       ///< frames after which the shape is kept
  int shape_parameters = 8;
  int scan_points = 800;  ///< of a scan looked at in a frame
};

/// Pose, place and a few shape parameters of the body by Gauss-Newton steps over closest points of both
/// surfaces, robustly weighed (Geman and McClure), kept near the frame before. Its joints and their rotations
/// are exact: to be copied. Knows no more than the scans.
class BodyFit final : public SkeletonExtractor {
 public:
  explicit BodyFit(std::shared_ptr<const FitBody> body, const BodyFitOptions& options = {});
  Extraction extract(const Mesh& scan) override;
  std::string name() const override { return "body fit"; }

 private:
  struct State {
    Pose pose;
    Eigen::VectorXf betas;
  };
  struct Posed;
  struct Task;
  struct Equations;
  Posed posed(const State& state) const;
  /// Takes the steps; gives the robust mean distance of the surfaces at the end, metres.
  float improve(State& state, const Task& task, int iterations) const;
  Equations data_equations(const State& state, const Posed& posed, const Task& task, float reach) const;
  void add_priors(Equations& to, const State& state, const Posed& posed, const Task& task, float reach) const;
  void step(State& state, const Task& task, float reach) const;
  State start(const Points& scan) const;

  std::shared_ptr<const FitBody> body_;
  BodyFitOptions options_;
  State last_;
  int frames_ = 0;
};

}  // namespace understudy
