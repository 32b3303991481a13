// The open study before its participants: as a folder for browsers, or on this screen.
#pragma once

#include <string>

#include "app/session/commands.hpp"
#include "app/session/study_state.hpp"

namespace understudy::app {

/// Those that the study used last. Until it has: what is beside its file, clips only where they are there.
StudyFolders folders_of(const StudyState& state);

/// Of P01, P02 and so on the first whose answers are not in the folder.
std::string next_participant(const std::string& answers);

/// Why the study cannot be shown to participants as it is, one sentence; empty: it can.
std::string why_not_shown(const StudyState& state);

/// study.web and study.run.
void add_study_showing(Commands& commands);

}  // namespace understudy::app
