#include "retarget/motion_space/step_score.hpp"

#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

/// The skeleton and some vertices of a body.
struct Shown {
  Joints joints;
  Points vertices;
};

class Performed {
 public:
  Performed(const ShapedBody& body, int every) : rest_(body.joints) {
    const Eigen::Index count = (body.vertices.rows() + every - 1) / every;
    vertices_.resize(count, 3);
    weights_.resize(count, kJointCount);
    for (Eigen::Index i = 0; i < count; ++i) {
      vertices_.row(i) = body.vertices.row(i * every);
      weights_.row(i) = body.weights.row(i * every);
    }
  }
  Shown at(const Pose& pose) const {
    const PosedSkeleton posed = forward_kinematics(rest_, pose);
    return {posed.joints, linear_blend_skinning(vertices_, weights_, rest_, posed)};
  }

 private:
  Joints rest_;
  Points vertices_;
  RowMatrix weights_;
};

/// By the number of its poses instead of their times.
TimedPoses evenly_timed(TimedPoses movement) {
  for (size_t t = 0; t < movement.seconds.size(); ++t)
    movement.seconds[t] = static_cast<float>(t) / static_cast<float>(movement.seconds.size() - 1);
  return movement;
}

void add(const StepErrors& step, StepErrors& sum) {
  sum.steps += step.steps;
  sum.joints_mm += step.joints_mm;
  sum.vertices_mm += step.vertices_mm;
  sum.duration_ms += step.duration_ms;
}

StepErrors mean_of(StepErrors sum) {
  const double count = std::max(1, sum.steps);
  return {sum.steps, sum.joints_mm / count, sum.vertices_mm / count, sum.duration_ms / count};
}

}  // namespace

StepScore score_steps(MotionCoder& coder, const std::vector<StepClip>& clips, const ShapedBody& body,
                      const StepScoreOptions& options) {
  const Performed performed(body, options.every_vertex);
  const float mean_leg = leg_length(body.joints);
  const auto apart_mm = [](const auto& a, const auto& b) {
    return 1000 * static_cast<double>((a - b).rowwise().norm().mean());
  };
  StepScore score;
  for (const StepClip& clip : clips)
    for (const Step& step : clip.steps) {
      const float back = mean_leg / leg_length(clip.rest);
      const TimedPoses truth = performed_step(clip, step, mean_leg),
                       made = coder.decode(coder.encode(truth, clip.rest).mean, clip.rest);
      const TimedPoses true_frames = evenly_timed(truth), made_frames = evenly_timed(made);
      StepErrors errors{1, 0, 0, 1000 * std::abs(static_cast<double>(made.duration() - truth.duration()))};
      for (int t = 0; t < options.frames; ++t) {
        const float at = static_cast<float>(t) / static_cast<float>(options.frames - 1);
        Pose was = pose_at(true_frames, at), is = pose_at(made_frames, at);
        was.root *= back, is.root *= back;
        const Shown a = performed.at(was), b = performed.at(is);
        errors.joints_mm += apart_mm(a.joints, b.joints) / options.frames;
        errors.vertices_mm += apart_mm(a.vertices, b.vertices) / options.frames;
      }
      add(errors, score.all);
      if (clip.walks) add(errors, score.walks);
    }
  return {mean_of(score.all), mean_of(score.walks)};
}

}  // namespace understudy
