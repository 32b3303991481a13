// A tiny data folder in the layout that training reads, made on the spot.
#pragma once

#include <string>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::test {

/// Writes a body of a few boxes, eight shapes, poses of its hands, one dressed person and two clips under
/// `folder`.
void write_training_folder(const std::string& folder);

/// Writes the built-in walk as a clip (AMASS-format) and gives it: somebody steps in it, as in none of that
/// folder's own. Its file does not say that it is a walk.
Motion write_walk_clip(const std::string& path);

}  // namespace understudy::test
