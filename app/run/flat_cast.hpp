// People and clips of a split that simulated 2D poses are made of.
#pragma once

#include <vector>

#include "app/run/case_maker.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/body/data_folder.hpp"
#include "retarget/pose2d/flat_people.hpp"

namespace understudy::app {

constexpr float kFlatRate = 30;  ///< frames of a case, a second

class FlatCast {
 public:
  /// Runs are as long as the options' frames, or `seconds` where that is more. Throws Error when the split
  /// has fewer than two people or long clips.
  FlatCast(const SuiteOptions& options, float seconds);

  int people() const { return static_cast<int>(split_.betas.size()); }
  FlatPerson person(int row) const;
  const Eigen::VectorXf& betas(int row) const { return split_.betas[static_cast<size_t>(row)]; }
  const Body& body() const { return body_; }
  int runs() const { return static_cast<int>(runs_.size()); }
  /// `count` poses of a run, `rate` a second, on the legs of the body's mean person.
  std::vector<Pose> poses(int run, int count, float rate) const;

 private:
  DataSplit split_;
  Body body_;
  HeadVertices head_;
  std::vector<Clip> clips_;
  std::vector<ClipRun> runs_;
};

/// Of where the pelvis is, metres.
Vec3 middle_of(const std::vector<Pose>& poses);

}  // namespace understudy::app
