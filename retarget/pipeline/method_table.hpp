// The tables of engines (motion transfer, in space and in pictures) and extractors: what a take, a command
// line or a report may choose.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// One row. The first of a list is the default.
struct MethodChoice {
  const char *name, *label;  ///< "copy" in documents and commands, "Copy" on buttons
  const char* caption;       ///< over a picture that it made: "copied rotations"
  const char* sentence;      ///< what it does, for help and tooltips, without its full stop
  const char* weights;       ///< its file in the folder of weights; null: it has no network
  /// An engine without a network. The plug-in makes the others (retarget/plugin/plugin.cpp).
  std::unique_ptr<MotionTransfer> (*make)() = nullptr;
  bool own_weights = false;  ///< the program comes without its weights: its user trains them
};
using MethodChoices = std::vector<MethodChoice>;

const MethodChoices& engines();
/// Of 2D poses; nn::load_keypoint_transfer makes them.
const MethodChoices& flat_engines();
const MethodChoices& extractors();
/// How bones of any body are found. Those with weights have a file for each kind of body, FILE_KIND.weights.
const MethodChoices& rig_methods();

/// Throws Error with the names that there are: "there is no engine 'x': " and the names; of an engine
/// of the other kind it says so.
const MethodChoice& engine_named(const std::string& name);
const MethodChoice& flat_engine_named(const std::string& name);
const MethodChoice& extractor_named(const std::string& name);
const MethodChoice& rig_method_named(const std::string& name);

std::vector<std::string> names_of(const MethodChoices& choices);
/// "copy, paper".
std::string names_of(const MethodChoices& choices, const char* between);
std::vector<std::string> labels_of(const MethodChoices& choices);
/// Which of them has the name; -1: none.
int index_of(const MethodChoices& choices, const std::string& name);
/// For a tooltip: "Copy: what it does."
std::string tip_of(const MethodChoice& choice);
/// For help: "copy: what it does; paper: what it does".
std::string help_of(const MethodChoices& choices);

}  // namespace understudy
