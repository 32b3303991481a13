#include "app/run/export_presets.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

const std::vector<ExportPreset>& export_presets() {
  static const std::vector<ExportPreset> presets = {
      {"three", "three.js",
       "GLTFLoader reads 4 bones per vertex; keys that move nothing by 0.5 mm are left out for a small "
       "download.",
       "glb", 4, 0, 0.5f, false},
      {"unity", "Unity",
       "Unity's glTF importers read 4 bones per vertex; morph targets become blend shapes; every frame is a "
       "key.",
       "glb", 4, 8, 0, false},
      {"unreal", "Unreal",
       "Reads 8 bones per vertex and morph targets; every frame is a key, because Unreal compresses clips "
       "itself.",
       "glb", 8, 8, 0, false},
      {"blender", "Blender",
       "Reads any number of bones per vertex; each clip becomes an action, the T-pose too; morph targets "
       "become "
       "shape keys.",
       "glb", 8, 16, 0, true}};
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
    append_item(help, std::string(preset.name) + ": " + options, "; ");
  }
  return help;
}

void apply(const ExportPreset& preset, CharacterExportOptions& file) {
  file.influences = preset.influences;
  file.shapes = preset.shapes;
  file.reduce_mm = preset.reduce_mm;
  file.t_pose_clip = preset.t_pose_clip;
}

const ExportPreset* preset_of(const ExportFormat& format, const CharacterExportOptions& file) {
  if (!format.is_character) return nullptr;
  const auto& presets = export_presets();
  const auto found = std::find_if(presets.begin(), presets.end(), [&](const ExportPreset& preset) {
    return preset.influences == file.influences && preset.shapes == file.shapes &&
           preset.reduce_mm == file.reduce_mm && preset.t_pose_clip == file.t_pose_clip;
  });
  return found == presets.end() ? nullptr : &*found;
}

}  // namespace understudy::app
