// What an export needs of a take: the same for the studio and for a document on the command line.
#pragma once

#include <optional>
#include <string>

#include "app/run/exports.hpp"
#include "app/session/session.hpp"

namespace understudy::app {

/// A format and its options, as commands say them.
struct ExportChoice {
  ExportFormat format = ExportFormat::Glb;
  CharacterExportOptions file;
  std::optional<bool> theirs;  ///< drive the character's own bones; none: where the take performs on them
};

/// key=value words: format=NAME, rig=theirs|ours, influences=4|8, morphs=COUNT, reduce=MM, in_place=on|off,
/// t_pose=on|off, keep_clips=on|off; without a format the path's suffix decides. Throws Error for any other.
ExportChoice export_choice(const std::string& path, const std::vector<std::string>& words);

/// Copied for another thread: the shown motion without what trim and skip leave out, on the target with its
/// moved joints and painted weights. Throws Error when nothing has been performed yet.
ExportInput export_input(const Session& session, size_t take, const ExportChoice& choice);

}  // namespace understudy::app
