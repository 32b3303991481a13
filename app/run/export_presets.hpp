// What other programs read of an animated character: a row of options for each.
#pragma once

#include <string>
#include <vector>

#include "app/run/exports.hpp"

namespace understudy::app {

/// The options of a file that a program reads whole.
/// glTF is always in metres with y up: nothing to choose there.
struct ExportPreset {
  const char* name;    ///< "three", as in --preset and commands
  const char* label;   ///< "three.js"
  const char* words;   ///< why these, one sentence
  const char* format;  ///< name of an ExportFormat that is a character
  int influences, shapes;
  float reduce_mm;
  bool t_pose_clip, root_motion;
};

/// All of them, in the order of menus.
const std::vector<ExportPreset>& export_presets();
/// Throws Error, listing the presets, for another name.
const ExportPreset& export_preset(const std::string& name);
/// "three|unity|...".
std::string names_of_presets();
/// "three: 4 bones per vertex ...; unity: ...", for help.
std::string help_of_presets();

/// Sets the preset's options; the others stay, but a file with root motion is not in place.
void apply(const ExportPreset& preset, CharacterExportOptions& file);
/// The preset whose options these are; null: none.
const ExportPreset* preset_of(const ExportFormat& format, const CharacterExportOptions& file);

}  // namespace understudy::app
