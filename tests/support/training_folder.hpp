// A tiny data folder in the layout that training reads, made on the spot.
#pragma once

#include <string>

namespace understudy::test {

/// Writes a body of a few boxes, eight shapes, poses of its hands, one dressed person and two clips under
/// `folder`.
void write_training_folder(const std::string& folder);

/// The built-in walk as a clip (AMASS-format): somebody steps in it, as in none of that folder's own.
void write_walk_clip(const std::string& path);

}  // namespace understudy::test
