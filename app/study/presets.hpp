// Studies of papers, ready to be run with the bundled samples and to be changed.
#pragma once

#include <string>
#include <vector>

#include "app/study/study.hpp"

namespace understudy::app {

struct StudyPreset {
  const char *name, *label;                   ///< "rekik" in commands, "Rekik et al. 2024" on the screen
  const char* sentence;                       ///< what it is, without a full stop
  Study (*make)(const std::string& samples);  ///< from the folder of the bundled samples
};
const std::vector<StudyPreset>& study_presets();
/// Throws Error with the names that there are.
const StudyPreset& study_preset(const std::string& name);

}  // namespace understudy::app
