// What an export needs from a take: shared by the studio and the command line.
#pragma once

#include <functional>
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
  /// the character's own bones; none: those of an animated character, where the take performs on them
  std::optional<bool> own_bones;
  std::vector<std::string> takes;  ///< more takes, by name or number from 0
  PoseChoice poses;                ///< of pose pictures
  bool pane_camera = false;        ///< they are seen as the take's view is seen now
};

/// key=value words, of which a later one counts: format=NAME, preset=NAME, bones=own|22, influences=4|8,
/// morphs=COUNT, reduce=MM, in_place=on|off, root_motion=on|off, t_pose=on|off, keep_clips=on|off, of pose
/// pictures camera=WORDS, canvas=WxH, rate=NUMBER, count=COUNT|4n+1, depth=on|off, normals=on|off,
/// mask=on|off, points=openpose18|body25, stick_width=PIXELS, hide_limbs=on|off, whole_face=on|off,
/// pose_file=controlnet|openpose|none (camera=view: as the take is seen now), and any number of take=NAME for more clips; without a format the path's suffix decides.
/// Throws Error for any other.
ExportChoice export_choice(const std::string& path, const std::vector<std::string>& words);

/// The take with that name, or else with that number, counted from `first`. Throws Error, listing the takes,
/// when there is none or several have the name.
size_t take_called(const Document& document, const std::string& name, int first = 0);

/// Takes that can be in one file with this one, itself too: clips of one character are those in which the
/// same person is performed by the same target with the same joints and weights, with or without offsets
/// alike; a character of another person performs beside it.
std::vector<size_t> takes_of_one_file(const Document& document, size_t take);

/// Copied for another thread: the shown motions without what trim and skip leave out, on the target with its
/// moved joints and painted weights. Takes of one person are clips of one performer, several performers
/// perform at once. A performer's only clip has the source's name, each of several that of its take. Throws
/// Error when nothing has been performed yet, or the takes cannot be in one file.
std::vector<ExportInput> export_inputs(const Session& session, const std::vector<size_t>& takes,
                                       const ExportChoice& choice);

/// Of a flat take: its poses without what trim leaves out, as many as the count says. Throws Error while there are
/// none.
KeypointReading exported_poses(const Session& session, size_t take, const PictureCount& count);

/// The name of a file or folder for something of this name, such that any file system takes it.
std::string safe_file_name(const std::string& name);
/// Of each take the name of its file among those of all: "adult.glb";
/// of the second that is called alike "adult 2.glb".
std::vector<std::string> take_file_names(const Document& document, const std::string& suffix);

/// One take's file among those of all takes.
struct TakeFile {
  std::string path;
  std::string problem;  ///< why it cannot be made, one sentence that names the take; empty: `write` makes it
  /// On any thread; throws Error. What `progress` (0..1) throws ends it, and what was at the path stays.
  std::function<void(const std::function<void(float)>& progress)> write;
};
/// A file of each take in this folder. Options that a take's character cannot have are left out of its file.
std::vector<TakeFile> take_files(const Session& session, const std::string& folder,
                                 const ExportChoice& choice);
/// The same with the figures of every frame, as CSV.
std::vector<TakeFile> figure_files(const Session& session, const std::string& folder);
/// Makes the folder and writes one file after the other; what goes wrong with one keeps no other out. Returns
/// for each file why it could not be made, one sentence; empty: it was. Throws Error where none could, and
/// what `progress` throws after the last one. Folders that it has made and that are empty at the end are gone
/// then.
std::vector<std::string> write_takes(const std::string& folder, const std::vector<TakeFile>& files,
                                     const std::function<void(float)>& progress);

}  // namespace understudy::app
