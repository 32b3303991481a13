// What the suites of frames that are to be made have in common: clips to choose from, and truths.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/run/case_maker.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/body/data_folder.hpp"
#include "retarget/body/exact_body.hpp"
#include "retarget/formats/npz.hpp"

namespace understudy::app {

struct LabelledClip {
  std::string path;
  std::vector<std::string> labels;
  Clip clip;

  std::string name() const;  ///< of the file
};

/// Calls visit(clip) for each clip of the split; of SuiteOptions::walks for each that says it is a walk or
/// run. Throws Error where one is not at 30 frames/s.
void each_clip(const SuiteOptions& options, const DataSplit& split,
               const std::function<void(const LabelledClip& clip)>& visit);
bool is_walk(const std::vector<std::string>& labels);

/// Tags of a clip: the suite's name, what it shows, and "travels" where the pelvis goes at more than 0.6 m/s
/// across the floor half of the time, or the clip is a walk or run.
std::vector<std::string> gap_tags(const std::string& suite, const Motion& motion,
                                  const std::vector<std::string>& labels);

/// The motion on the person, its soles on the floor; without vertices where these are not wanted.
Performance grounded(const ExactPerson& person, const ExactMotion& motion, bool with_vertices);

/// rotations, joints, source_joints, target_joints, and some points of the skin (SkinSample); vertices where
/// the performance has them.
Npz gap_truth(const ExactPerson& person, const ExactMotion& motion, const Performance& shown);

}  // namespace understudy::app
