// What an export needs from a take: shared by the studio and the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/exports.hpp"
#include "app/session/session.hpp"

namespace understudy::app {

/// A format and its options, as commands name them.
struct ExportChoice {
  const ExportFormat* format = &export_formats().front();
  CharacterExportOptions file;
  std::optional<bool> theirs;      ///< drive the character's own bones; none: where the take performs on them
  std::vector<std::string> takes;  ///< more takes, by name or number from 0, each a clip of its own
};

/// key=value words: format=NAME, rig=theirs|ours, influences=4|8, morphs=COUNT, reduce=MM, in_place=on|off,
/// t_pose=on|off, keep_clips=on|off, and any number of take=NAME for more clips; without a format the path's
/// suffix decides. Throws Error for any other.
ExportChoice export_choice(const std::string& path, const std::vector<std::string>& words);

/// The take with that name, or else with that number, counted from `first`. Throws Error, listing the takes,
/// when there is none or several have the name.
size_t take_called(const Document& document, const std::string& name, int first = 0);

/// Takes that can be clips of one file with this one, itself too: the same target with the same joints and
/// weights, with or without offsets alike.
std::vector<size_t> takes_of_one_body(const Document& document, size_t take);

/// Copied for another thread: the shown motions without what trim and skip leave out, on the target with its
/// moved joints and painted weights. A take alone is a clip of the source's name, each of several one of its
/// own. Throws Error when nothing has been performed yet, or the takes are not of one body.
ExportInput export_input(const Session& session, const std::vector<size_t>& takes,
                         const ExportChoice& choice);

}  // namespace understudy::app
