#include "app/run/export_presets.hpp"

#include <algorithm>
#include <tuple>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

/// What a preset chooses, of it or of a file's options.
template <class Options>
auto chosen(Options& o) {
  return std::tie(o.influences, o.shapes, o.reduce_mm, o.t_pose_clip, o.root_motion);
}

}  // namespace

const std::vector<ExportPreset>& export_presets() {
  static const std::vector<ExportPreset> presets = {
      {"three", "three.js", "GLTFLoader reads 4 bones per vertex; fewer keys make a small download.", "glb",
       4, 0, 0.5f, false, false},
      {"unity", "Unity",
       "Its glTF importers read 4 bones per vertex. Morph targets become blend shapes, and a root bone "
       "carries the path.",
       "glb", 4, 8, 0, false, true},
      {"unreal", "Unreal",
       "Reads 8 bones per vertex and morph targets, takes root motion from a root bone and reduces keys.",
       "glb", 8, 8, 0, false, true},
      {"blender", "Blender",
       "Reads any number of bones per vertex. Clips and the T-pose become actions, morph targets shape keys.",
       "glb", 8, 16, 0, true, false}};
  return presets;
}

const ExportPreset& export_preset(const std::string& name) {
  for (const ExportPreset& preset : export_presets())
    if (preset.name == name) return preset;
  throw Error("there is no preset '" + name + "', use one of " + names_of_presets());
}

std::string names_of_presets() {
  std::string names;
  for (const ExportPreset& preset : export_presets()) append_item(names, preset.name, "|");
  return names;
}

std::string help_of_presets() {
  std::string help;
  for (const ExportPreset& preset : export_presets()) {
    std::string options = std::to_string(preset.influences) + " bones per vertex";
    if (preset.shapes > 0) options += ", " + std::to_string(preset.shapes) + " morph targets";
    if (preset.reduce_mm > 0)
      options += printed(", keys reduced by %.1f mm", static_cast<double>(preset.reduce_mm));
    if (preset.t_pose_clip) options += ", T-pose clip";
    if (preset.root_motion) options += ", root motion";
    append_item(help, std::string(preset.name) + ": " + options, "; ");
  }
  return help;
}

void apply(const ExportPreset& preset, CharacterExportOptions& file) {
  chosen(file) = chosen(preset);
  if (preset.root_motion) file.in_place = false;
}

const ExportPreset* preset_of(const ExportFormat& format, const CharacterExportOptions& file) {
  if (!format.is_character) return nullptr;
  const auto& presets = export_presets();
  const auto found = std::find_if(presets.begin(), presets.end(),
                                  [&](const ExportPreset& preset) { return chosen(preset) == chosen(file); });
  return found == presets.end() ? nullptr : &*found;
}

}  // namespace understudy::app
