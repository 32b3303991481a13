#include <CLI/CLI.hpp>

#include "app/cli/options.hpp"
#include "retarget/character/bone_choices.hpp"

namespace understudy::app {

void add_target_options(CLI::App& command, TargetOptions& target) {
  command
      .add_option("--rig", target.rig,
                  "theirs: the character's own bones and weights; ours: 22 joints (default: theirs, if any)")
      ->check(CLI::IsMember({"auto", "theirs", "ours"}));
  command.add_option_function<std::string>(
      "--map", [&target](const std::string& path) { target.bones = read_bone_choices(path); },
      R"(JSON that names the character's bones: {"left_wrist": "Hand.L"})");
  command.add_option("--betas", target.betas, "shape parameters of an SMPL-format target")->delimiter(',');
  command.add_option("--target-units", target.import.units, "the target's units: auto, m, dm, cm, mm, in");
  command.add_option("--target-up", target.import.up, "the target's up axis: auto, y (default), z, ...");
  command.add_option_function<float>(
      "--target-yaw",
      [&target](float yaw_deg) {
        target.import.yaw_deg = yaw_deg;
        target.forward = false;
      },
      "turns the target about y, degrees (default: so that it faces forward)");
}

}  // namespace understudy::app
