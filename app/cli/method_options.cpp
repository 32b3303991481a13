#include <CLI/CLI.hpp>

#include "app/cli/options.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

void add_weights_options(CLI::App& command, MethodOptions& how) {
  command.add_option("--weights", how.weights, "folder of the weights (default: beside the program)");
  command.add_option("--engine-weights", how.engine_file,
                     "weights file of the engine in place of the folder's");
  command.add_option("--extractor-weights", how.extractor_file,
                     "weights file of the extractor in place of the folder's");
}

}  // namespace

void add_method_options(CLI::App& command, MethodOptions& how) {
  Method& method = how.method;
  command.add_option("--engine", method.engine, "motion transfer; " + help_of(engines()))
      ->check(CLI::IsMember(names_of(engines())));
  command.add_option("--extractor", method.extractor, "skeleton extraction; " + help_of(extractors()))
      ->check(CLI::IsMember(names_of(extractors())));
  command.add_option("--root", method.root, "path: scaled by leg length, original, in-place")
      ->transform(CLI::CheckedTransformer(std::map<std::string, RootMode>{{"scaled", RootMode::Scaled},
                                                                          {"original", RootMode::Original},
                                                                          {"in-place", RootMode::InPlace}},
                                          CLI::ignore_case));
  command.add_flag("!--no-near", method.near, "limbs and head are not looked at again from near");
  command.add_flag("!--no-swap-repair", method.repair_swaps,
                   "left and right that were taken for each other stay so");
  command.add_flag("!--no-smoothing", method.smooth_joints, "joints stay as noisy as they are extracted");
  command.add_flag("!--no-fixed-lengths", method.fix_lengths, "bones may change their length");
  command.add_flag("!--no-foot-lock", method.lock_feet, "standing feet may slide");
  command.add_flag("!--no-hand-contacts", method.keep_contacts,
                   "hands that touch the source's body need not touch the target's");
  command.add_flag("!--no-offsets", method.offsets, "no pose-corrective offsets");
  add_weights_options(command, how);
}

nn::NetworkOptions network_options(const MethodOptions& how) {
  nn::NetworkOptions options;
  options.weights = how.weights;
  options.engine = how.method.engine;
  options.offsets = how.method.offsets;
  options.near = how.method.near;
  options.extractor = how.method.extractor;
  options.engine_file = how.engine_file;
  options.extractor_file = how.extractor_file;
  return options;
}

}  // namespace understudy::app
