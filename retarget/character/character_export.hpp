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
  std::vector<MadeFrames> made{};  ///< which of them were not captured; told in the file's extras
  /// When pose `i` is.
  float seconds(size_t i) const { return static_cast<float>(static_cast<double>(i) / fps); }
};

struct CharacterExportOptions {
  bool their_rig = true;  ///< drive the character's own bones; needs a rigged character
  int influences = 4;     ///< 4 or 8 bones a vertex; their own skin stays as it is where nobody painted it
  int shapes = 0;         ///< morph targets for the pose-corrective offsets, 0: none
  float reduce_mm = 0;    ///< removes keys while no vertex moves further than this; 0: all keys stay
  bool in_place = false;  ///< the path over the floor is taken out
  bool root_motion =
      false;  ///< a bone above all others carries it: the character's own, else one named "Root"
  bool t_pose_clip = false;  ///< the first clip is the T-pose
  bool keep_clips = false;   ///< the file's own animations stay, after ours
  std::string rights{};      ///< the file's copyright, with that of others in it; empty: it says none
  /// T-pose joints that the screen was bound to, where they are others than the character's.
  std::optional<Joints> joints;
  std::function<void(float)>
      progress;  ///< called with 0..1; what it throws ends the export, nothing is written
};

/// Size of the written file, and its difference from the vertices on screen over frames of all clips of all
/// performers.
struct ExportCost {
  bool measured = false;  ///< false: the format holds no surface that could be compared
  double mean_mm = 0, largest_mm = 0;
  int64_t frames = 0, keys = 0, bytes = 0;  ///< frames: that were compared, or written
};

/// Leaves out keys of a linear track that its neighbours give back within the tolerance: radians for
/// rotations, the track's own unit otherwise. First and last stay; a track that does not change keeps one
/// key. Throws Error for tracks that are not linear.
CharacterTrack reduced(const CharacterTrack& track, float tolerance);

/// Pose-corrective offsets of a motion as a few shapes with weights over time.
struct CorrectiveShapes {
  std::vector<Points> shapes;               ///< [V, 3] each, metres, T-pose axes, small offsets cut to zero
  std::vector<std::vector<float>> weights;  ///< [poses][shapes]
};
/// `count` shapes for the offsets in these poses: the first is there in all of them with weight 1, the others
/// are the principal ways in which the poses differ, with weights in 0..1. No weights is no offset. Up to 120
/// poses are looked at for the shapes. progress: called with 0..1, may throw.
CorrectiveShapes corrective_shapes(const Deformer& deformer, const std::vector<Pose>& poses, int count,
                                   const std::function<void(float)>& progress = {});

/// Puts skin weights that a user painted for the 22 joints into a character's own skins: changes joints and
/// weights of `out`, a copy of character.character, at the vertices whose row of `weights` [V, 22], those on
/// screen, differs from the rig's own. A joint's weight is shared among its bones as they share the vertex
/// now; where none of them pulls yet, the joint's own bone does.
/// `most`: bones a vertex, unless the part has more.
/// Parts that followed a node alone become skinned.
void apply_painted_weights(const PreparedCharacter& character, const RowMatrix& weights, int most,
                           Character& out);

/// What one character performs. Refers to character and screen, which must outlive it.
struct CharacterPerformance {
  const PreparedCharacter& character;
  const Deformer& screen;  ///< bound to the character's target, as it deforms on screen
  std::vector<CharacterClip> clips;
  CharacterExportOptions options;  ///< progress: the first performance's is called, for all of them
  std::string name = {};           ///< of the performer, in a file of several
};

/// The animated character in memory; of several performances one document in which their clips play at once,
/// the first ones of all together, and so on. One alone is as its file has it. Each of several is below a
/// node with the performer's name, which stands on the floor where their first pose does: what a performance
/// is without its path (in place, the T-pose) is there. Throws Error: no rig to drive, poses that are not
/// finite.
Character animated_character(const std::vector<CharacterPerformance>& performances);

/// Reads what it is about to write and measures it, then writes it beside the path and renames. The suffix
/// decides between GLB and glTF. Throws Error as animated_character does, and where the file cannot be
/// written.
ExportCost export_character(const std::string& path, const std::vector<CharacterPerformance>& performances);

}  // namespace understudy
