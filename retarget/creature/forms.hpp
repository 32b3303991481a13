// What there is to say of a kind of creature: how it is built, how it moves. A kind is one file that gives a
// CreatureForm, and a row of the table in creature.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/creature/plan.hpp"
#include "retarget/creature/puppet.hpp"

namespace understudy {

/// Poses a puppet that is at rest for a moment, seconds from the clip's begin.
using Performance = std::function<void(Puppet& puppet, float seconds)>;

struct CreatureMotion {
  std::string name;
  Performance (*begin)(const Rig& rig, Rng& rng);
};

struct CreatureForm {
  CreaturePlan (*plan)(Rng& rng);
  std::vector<CreatureMotion> motions;
  std::vector<std::string> breathing;  ///< joints whose flesh breathes
  bool flesh = true;                   ///< it wobbles
};

CreatureForm arm_form();
CreatureForm lamp_form();
CreatureForm excavator_form();
CreatureForm hand_form();
CreatureForm quadruped_form();
CreatureForm insect_form();
CreatureForm bird_form();
CreatureForm snake_form();

}  // namespace understudy
