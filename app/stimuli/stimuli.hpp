// All clips of a study: rendered, encoded and listed.
#pragma once

#include <string>

#include "app/stimuli/stage.hpp"

namespace understudy::app {

struct StimuliOptions {
  std::string study_folder;  ///< that the study's file is in: checksums are of paths relative to it
  std::string out;           ///< folder; made where it is not there
  bool separate = false;     ///< each pane as a film of its own, too: panes/NAME-source.mp4 ...
  std::string made_by;       ///< what else clips depend on: which weights
};

struct StimuliReport {
  int clips = 0, made = 0;  ///< of the study; rendered now, the rest were there
  int64_t frames = 0;       ///< of the clips made
  double stage_s = 0;       ///< reading and retargeting
  double render_s = 0;      ///< drawing and encoding
};

/// Writes out/clips/NAME.mp4 of every clip of the study (H.264, constant frame rate, no sound), then
/// out/manifest.json and .csv. Clips that are there already, made from the same, stay; each appears when it
/// is whole. The same study gives the same bytes on one machine. Throws Error: the folder cannot be written,
/// the disk is full, there is no H.264 encoder, as StageMaker::stage(); "interrupted: ..." after Ctrl-C
/// (catch_interrupts()).
StimuliReport make_stimuli(const Study& study, const StimulusServices& services,
                           const StimuliOptions& options);

}  // namespace understudy::app
