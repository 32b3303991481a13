// Programs that are not ours, as the tests call them: node with the packages of tests/interop, browsers,
// Blender.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy::tests {

/// Runs a script of tests/interop with node and gives the JSON that it printed. Throws Error in a sentence:
/// node is missing, or the script failed.
nlohmann::json run_node(const std::string& script, const std::vector<std::string>& arguments);
/// The same of a script that gets as its first argument where the npm packages are. Throws Error also where
/// these are missing.
nlohmann::json run_script(const std::string& script, const std::vector<std::string>& arguments);

/// What Khronos' glTF-Validator says of each file: {"errors", "warnings", "messages": [...]}.
nlohmann::json validated(const std::vector<std::string>& paths);

/// One clip that another program plays.
struct PlayJob {
  std::string file, out;  ///< out: float32 [T, V, 3], written by that program
  int clip = 0;
  double fps = 25;
  std::vector<float> times;  ///< seconds
};
/// As a JSON file beside the first output; its path.
std::string write_jobs(const std::vector<PlayJob>& jobs);
/// The positions that the program wrote, one a time. Throws Error where there is none, or of another size.
std::vector<Points> read_positions(const PlayJob& job, Eigen::Index vertices);

}  // namespace understudy::tests
