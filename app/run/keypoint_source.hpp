// 2D poses as a source for every target in space: one person of a file, lifted frame by frame.
#pragma once

#include "app/run/source.hpp"

namespace understudy::app {

/// Whether a source is 2D poses; its content alone tells.
bool is_keypoint_source(const SourceOptions& options);

/// Throws Error naming the file where an option is about something that 2D poses do not have.
void check_keypoint_options(const SourceOptions& options);
/// The other way round: of a source that is no 2D poses.
void check_no_picture(const SourceOptions& options);

/// Opens the file and cleans the track of who performs (KeypointFilter). Frames have skeletons that a Lifter
/// makes, `exact` is false; it is made by the tools of set_tools() when the first frame is asked for. A frame
/// that the filter cannot use is not usable, with its sentence. No frame depends on a later one, and each is
/// the same in whatever order they are asked for. Throws Error naming the file; in next() without a lifter.
std::unique_ptr<Source> open_keypoint_source(const SourceOptions& options);

}  // namespace understudy::app
