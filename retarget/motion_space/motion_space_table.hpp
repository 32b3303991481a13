// The table of ways to complete a motion: what a command line, a document or a report may choose.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/pipeline/motion_space.hpp"

namespace understudy {

/// One row.
struct MotionSpaceChoice {
  const char *name, *label;  ///< "hermite" in documents and commands, "Hermite curves" on buttons
  const char* sentence;      ///< what it does, for help and tooltips, without its full stop
  const char* weights;       ///< its file in the folder of weights; null: it has no network
  bool needs_clips = false;  ///< it looks into a folder of people and motions: for comparisons
  /// One without a network. `data`: the folder (retarget/body/data_folder.hpp) where it needs clips, whose
  /// split "train" it looks into. Null: it has a network (nn::load_motion_space).
  std::unique_ptr<MotionSpace> (*make)(const std::string& data) = nullptr;
};

/// All rows, the plainest first.
const std::vector<MotionSpaceChoice>& motion_spaces();
/// The name of the one that is taken where none is named.
constexpr const char* kDefaultMotionSpace = "space";

/// Throws Error with the names that there are.
const MotionSpaceChoice& motion_space_named(const std::string& name);
/// "hold, slerp".
std::string motion_space_names();
/// For help: "hold: what it does; slerp: what it does".
std::string motion_space_help();

/// Throws Error where there is none of this name, where it needs clips and `data` is empty, and where it has
/// a network.
std::unique_ptr<MotionSpace> make_motion_space(const std::string& name, const std::string& data = {});

}  // namespace understudy
