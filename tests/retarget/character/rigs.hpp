// Rigs as many people would make them: bones and skin of a person in a convention of names, with all that
// hangs on such rigs, and the joints that a careful rigger would say.
#pragma once

#include <array>
#include <string>

#include "retarget/character/character.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::tests {

enum class Convention {
  Mixamo,
  Biped,  ///< 3ds Max: the collars hang on the neck, in old files the thighs on the spine
  Cat,    ///< 3ds Max: limbs are numbered
  Unreal,
  Rigify,  ///< the trunk is called spine from pelvis to head
  HumanIk,
  Daz,  ///< the thighs hang on a pelvis beside the spine
  MakeHuman,
  Vrm,
  Mmd,  ///< Japanese; the thighs hang on the lower body, beside the upper
  MmdEnglish,
  BlenderLr,
  Joints,  ///< by the joints, and what is between them: hip, knee, ankle, shoulder, bicep, elbow
  Source,
  AutoRig,
  Maya,   ///< Advanced Skeleton
  Glued,  ///< lfemur, ltibia: lower case in one piece
  Plain,  ///< leg and arm in words, with the character's name before
  Smpl,
  Numbers,  ///< names without meaning
  Unnamed
};
constexpr int kConventions = 21;
const char* convention_name(Convention convention);

struct MadeRig {
  Character character;
  std::array<int, kJointCount> truth;  ///< nodes, -1 where the rig has none
  std::string description;
};

/// Drawn at random: spine of 1 to 6 bones, collars, toes, fingers, twist bones beside or between, roots,
/// tail, wings, skirt, hair, brows, eyes, ribbons, handles, side words that contradict the shape, pose
/// between T and A, up axis, heading, 0.1 to 500 units.
MadeRig make_rig(Convention convention, unsigned seed);

}  // namespace understudy::tests
