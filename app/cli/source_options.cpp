#include <CLI/CLI.hpp>

#include "app/cli/options.hpp"
#include "retarget/character/bone_choices.hpp"

namespace understudy::app {

void add_source_options(CLI::App& command, SourceOptions& source) {
  command.add_option("--motion", source.motion,
                     "AMASS-format motion that an SMPL-format source body performs");
  command.add_option("--source-betas", source.betas, "shape parameters of the source body")->delimiter(',');
  command.add_option("--clip", source.clip,
                     "which animation of a skeletal source: its name or number (default: the longest)");
  CLI::Option* const as_scan =
      command.add_flag("--as-scan", source.as_scan,
                       "the surface of an animated source is looked at as a scan, not its skeleton");
  CLI::Option* const map = command.add_option_function<std::string>(
      "--source-map", [&source](const std::string& path) { source.bones = read_bone_choices(path); },
      R"(JSON that names bones of a skeletal source: {"left_wrist": "Hand.L"})");
  map->excludes(as_scan);
  command.add_flag("--follow", source.follow, "the source folder is still being written");
  command
      .add_option("--fps", source.fps, "frames per second of the source (default: the motion's own, or 30)")
      ->check(CLI::Range(1.0, 1000.0));
  command.add_option("--up", source.import.up, "the source's up axis: auto, x, y, z, -x, -y, -z");
  command.add_option("--units", source.import.units, "the source's units: auto, m, dm, cm, mm, in");
  command.add_option("--yaw", source.import.yaw_deg, "turns the source about y, degrees");
  command.add_option("--floor", source.import.floor,
                     "height of the source's floor, metres (default: the lowest points)");
}

}  // namespace understudy::app
