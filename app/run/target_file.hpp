// A target from a file: any character, brought to metres, y up and the T-pose, its bones and joints found.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/character/prepared_character.hpp"
#include "retarget/formats/import.hpp"

namespace understudy::app {

/// The bones that a target performs on.
enum class Rig {
  Auto,  ///< its own, if any
  Own,   ///< its own, with its own skin weights
  Ours   ///< the 22 joints
};
constexpr Names<3> kRigNames{"auto", "own", "22"};
/// Older documents, scripts and command lines call them otherwise: the name of today.
inline std::string present_rig(const std::string& word) {
  return word == "theirs" ? "own" : word == "ours" ? "22" : word;
}

struct TargetOptions {
  std::string path;
  std::vector<float> betas;  ///< of an SMPL-format body
  ImportOptions import;      ///< up is y by default
  bool forward = true;       ///< without a turn it is turned so that it faces +z; false: it stays as it is
  Rig rig = Rig::Auto;
  BoneChoices bones;                                  ///< the user's corrections of which bone is which joint
  NotAPerson not_a_person = NotAPerson::RefuseClear;  ///< Refuse: of what a user opens
};
template <class V, class S>
FieldsOf<S, TargetOptions> fields(V& visit, S& target) {
  visit("path", target.path, FilePath{});
  visit("betas", target.betas);
  visit("import", target.import);
  visit("forward", target.forward);
  visit("rig", target.rig, kRigNames);
  visit("bones", target.bones);
  visit("not_a_person", target.not_a_person, kNotAPersonNames);
}

/// The target as the retargeter needs it. The networks' extractors find the joints of what has no rig; they
/// are only used during the call. Logs what it decided. Throws Error naming the file: it cannot be
/// read, it does not look like a person (NotAPersonError, which names --use-anyway), its own rig is wanted
/// and its bones are not known.
std::shared_ptr<const PreparedCharacter> open_target(const TargetOptions& options, const Networks& networks);

/// The first half of it, which uses no network: as the file has it, upright and at its size, to be shown.
/// Throws Error naming the file.
std::shared_ptr<PreparedCharacter> load_target(const TargetOptions& options);
/// Whether the second half uses the networks' extractors: a mesh without a rig that it performs on.
bool needs_extractor(const TargetOptions& options, const PreparedCharacter& character);
/// The second half, with the same options.
std::shared_ptr<const PreparedCharacter> bind_target(std::shared_ptr<PreparedCharacter> character,
                                                     const TargetOptions& options, const Networks& networks);

/// Whether the target performs on its own bones and skin.
bool on_their_rig(const TargetOptions& options, const PreparedCharacter& character);

/// The file as it is: an SMPL-format body in T-pose with these shape parameters, any other as read_character
/// reads it. Throws Error naming the file.
Character read_target(const std::string& path, const std::vector<float>& betas);

}  // namespace understudy::app
