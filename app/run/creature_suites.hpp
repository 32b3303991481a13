// Suites of bodies of every kind that move: made by code, and people among them.
#pragma once

#include <optional>

#include "app/run/case_maker.hpp"
#include "retarget/body/data_folder.hpp"

namespace understudy::app {

constexpr int kCreatureFrames = 60;

/// Whether a suite is made here: "creatures", "creatures-captured", "creatures-pairs",
/// "marionette-gaps".
bool is_creature_suite(const std::string& suite);
/// As make_suite. The split "train" has the seeds 0 to 99 of each kind, "dev" 100 to 109, each with one of
/// the kind's motions in turn; `people`, whose motions are known, are one kind more, ten of them. Throws
/// Error for another split. Of pairs each creature has the next one of its kind (the next with the thumb on
/// the same side) as its target, which moves in its own way; their truth is what the target does under the
/// first one's true angles.
int make_creature_suite(const SuiteOptions& options, const std::optional<DataSplit>& people,
                        const std::function<void(const std::string&)>& done);

}  // namespace understudy::app
