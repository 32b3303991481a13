// A character with motions as a file that every engine opens: on its own skeleton, or on the 22 joints.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "retarget/character/prepared_character.hpp"

namespace understudy {

struct CharacterClip {
  std::string name = "motion";
  double fps = 30;
  std::vector<Pose> poses;
};

struct CharacterExportOptions {
  bool their_rig = true;     ///< drive the character's own bones; needs a rigged character
  int influences = 4;        ///< 4 or 8 bones a vertex; their own skin stays as it is where nobody painted it
  int shapes = 0;            ///< morph targets for the pose-corrective offsets, 0: none
  float reduce_mm = 0;       ///< keys may go while no vertex moves further than this; 0: all keys stay
  bool in_place = false;     ///< the path over the floor is taken out
  bool t_pose_clip = false;  ///< the first clip is the T-pose
  bool keep_clips = false;   ///< the file's own animations stay, after ours
  /// T-pose joints that the screen was bound to, where they are others than the character's.
  std::optional<Joints> joints;
  std::function<void(float)> progress;  ///< told 0..1; what it throws ends the export, nothing is written
};

/// What the written file costs: its own evaluation against the vertices on screen, over frames of all clips.
struct ExportCost {
  bool measured = false;  ///< false: the format holds no surface that could be compared
  double mean_mm = 0, largest_mm = 0;
  int64_t frames = 0, keys = 0, bytes = 0;
};

/// The animated character in memory. screen: bound to the character's target, as it deforms on screen.
Character animated_character(const PreparedCharacter& character, const Deformer& screen,
                             const std::vector<CharacterClip>& clips, const CharacterExportOptions& options);

/// Reads what it is about to write and measures it, then writes it beside the path and renames. The suffix
/// decides between GLB and glTF. Throws Error: no rig to drive, poses that are not finite, a file that cannot
/// be written.
ExportCost export_character(const std::string& path, const PreparedCharacter& character,
                            const Deformer& screen, const std::vector<CharacterClip>& clips,
                            const CharacterExportOptions& options);

}  // namespace understudy
