// Cases of 2D poses: what one person does in a picture, another is to do who is known from a picture or a
// track.
#pragma once

#include <functional>
#include <string>

#include "app/run/case_maker.hpp"

namespace understudy::app {

/// Whether a suite's name is one of make_flat_suite's.
bool is_flat_suite(const std::string& suite);

/// People and clips of the split; FlatCase says what is known of them. Each pair twice: the target known from
/// one pose (tag "picture"), and from ten of two seconds of another clip, seen from elsewhere ("track"). The
/// truth is the same local rotations on the target's bones before the source's camera. The suites:
///   pose2d: as people are
///   pose2d-odd: bones of every target and of every second source are scaled apart (random_scales)
///   pose2d-noisy: the same, seen with 15 mm of jitter
///   pose2d-seen: the same, with 8 % of the points missing, sides of 2 % of the limbs exchanged, every sixth
///     source cut at the hips; "track" alone
/// Throws Error naming what is missing.
int make_flat_suite(const SuiteOptions& options, const std::function<void(const std::string& name)>& done);

}  // namespace understudy::app
