// Options that several subcommands take, and the samples that they take where none are given.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/run/flat_performance.hpp"
#include "app/run/method.hpp"
#include "app/run/pose_choice.hpp"
#include "app/run/source.hpp"
#include "app/run/target_file.hpp"
#include "app/run/tempo_choice.hpp"
#include "retarget/editing/target_edits.hpp"
#include "retarget/networks/networks.hpp"

namespace CLI {
class App;
}

namespace understudy::app {

/// What help calls the value of an option that is a path (or a word in its place), and what `batch` knows it
/// by: one that is read, one that is written.
constexpr const char *kReadPath = "PATH", *kWrittenPath = "NEW-PATH";

/// What takes a floor or a second person out of scans.
void add_scan_options(CLI::App& command, ScanEdits& edits);

/// All options of a source but --source itself.
void add_source_options(CLI::App& command, SourceOptions& source);

/// All options of a target but --target itself.
void add_target_options(CLI::App& command, TargetOptions& target);

/// A method, and where its weights are.
struct MethodOptions {
  Method method;
  std::string weights;                      ///< folder; empty: beside the program
  std::string engine_file, extractor_file;  ///< in place of the folder's; empty: the folder's
  std::vector<BoneTurn> rest_pose;          ///< of the target
  bool engine_is_asked = false;             ///< by its name; else it is the default of what the source is
};
void add_method_options(CLI::App& command, MethodOptions& how);
/// The engine of 2D poses: --engine, or the default. Throws Error where --engine is for what moves in space.
std::string flat_engine(const MethodOptions& how);
/// Loaded with the weights that `how` says.
FlatTools flat_tools(const MethodOptions& how);
/// --tempo and --delay.
void add_tempo_options(CLI::App& command, TempoChoice& tempo);
/// As --rest-pose takes it: "left_shoulder=0,0,-30".
std::string turn_words(const BoneTurn& turn);
/// What pose pictures show: --camera, --canvas, --rate, --count and how they are drawn.
void add_pose_options(CLI::App& command, PoseChoice& poses);
nn::NetworkOptions network_options(const MethodOptions& how);
/// What reports say of a style: its name, strength, licence; null without one.
nlohmann::ordered_json style_json(const StyleChoice& style);
/// What a file that was made in a style has to say of rights; empty where there is nothing to be said.
std::string style_rights(const StyleChoice& style);
/// Loads what fills frames between scans, with the same weights.
std::function<std::shared_ptr<MotionSpace>()> motion_space_loader(const MethodOptions& how);
/// What sources are completed and lifted with, from the same weights; the extractor is the retargeter's.
SourceTools source_tools(const MethodOptions& how);
/// The options of the pipeline, networks apart.
RetargetOptions retarget_options(const MethodOptions& how);

/// The folder of the bundled samples (see program_files). Throws Error when there is none.
std::string samples_folder();

}  // namespace understudy::app
