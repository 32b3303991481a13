#include "retarget/creature/creature.hpp"

#include "retarget/base/error.hpp"
#include "retarget/creature/flesh.hpp"
#include "retarget/creature/forms.hpp"

namespace understudy {
namespace {

const CreatureForm& form_of(CreatureKind kind) {
  static const std::array<CreatureForm, kCreatureNames.size()> forms = {
      arm_form(),       lamp_form(),   excavator_form(), hand_form(),
      quadruped_form(), insect_form(), bird_form(),      snake_form()};
  return forms.at(static_cast<size_t>(kind));
}

}  // namespace

Rig make_creature(CreatureKind kind, uint64_t seed) {
  Rng rng(seed * 0x9e3779b97f4a7c15ull + static_cast<uint64_t>(kind));
  return rig_of(form_of(kind).plan(rng), kCreatureNames.at(static_cast<size_t>(kind)));
}

const std::vector<std::string>& creature_motions(CreatureKind kind) {
  static const auto names = [] {
    std::array<std::vector<std::string>, kCreatureNames.size()> all;
    for (size_t k = 0; k < all.size(); ++k)
      for (const CreatureMotion& motion : form_of(static_cast<CreatureKind>(k)).motions)
        all[k].push_back(motion.name);
    return all;
  }();
  return names.at(static_cast<size_t>(kind));
}

RigMotion creature_motion(CreatureKind kind, const Rig& rig, int motion, int frames, double fps,
                          uint64_t seed) {
  const auto& motions = form_of(kind).motions;
  US_CHECK(motion >= 0 && motion < static_cast<int>(motions.size()), rig.name, " has ", motions.size(),
           " motions, no number ", motion);
  US_CHECK(frames >= 1 && fps > 0, "a clip of ", frames, " frames at ", fps, " a second");
  Rng rng(seed ^ 0x706572666f726d73ull);
  const Performance perform = motions[static_cast<size_t>(motion)].begin(rig, rng);
  RigMotion clip;
  clip.fps = fps;
  for (int frame = 0; frame < frames; ++frame) {
    Puppet puppet(rig);
    perform(puppet, static_cast<float>(frame / fps));
    clip.poses.push_back(puppet.pose);
  }
  return clip;
}

std::vector<Points> creature_surfaces(CreatureKind kind, const Rig& rig, const RigMotion& motion,
                                      uint64_t seed) {
  const CreatureForm& form = form_of(kind);
  std::vector<Points> surfaces;
  const Flesh flesh(rig, form.breathing, seed);
  for (size_t frame = 0; frame < motion.poses.size(); ++frame) {
    const auto seconds = static_cast<float>(static_cast<double>(frame) / motion.fps);
    surfaces.push_back(skinned(form.flesh ? flesh.at(seconds) : rig.surface.vertices, rig.skin,
                               bone_motions(rig, motion.poses[frame])));
  }
  return surfaces;
}

}  // namespace understudy
