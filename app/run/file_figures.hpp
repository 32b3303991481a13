// Figures of a performance as an exported file holds it, against the truth.
#pragma once

#include "app/run/case_folder.hpp"
#include "app/run/evaluator.hpp"
#include "app/run/exports.hpp"

namespace understudy::app {

/// Makes the GLB of a clip in memory, reads it back and evaluates its surface in each frame as
/// Evaluator does the screen's: file_medl_mm, file_mpvd_m; file_screen_mm is its distance to the screen's
/// surface, file_mb its size, file_s the time to make it. Throws Error when the truth has no
/// vertices, or other frames.
Metrics file_figures(const ExportBody& body, const CharacterClip& clip, const Truth& truth);

}  // namespace understudy::app
