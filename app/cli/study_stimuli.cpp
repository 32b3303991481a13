#include "app/cli/study_stimuli.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "app/cli/progress.hpp"
#include "app/cli/studio.hpp"
#include "app/run/interrupt.hpp"
#include "app/stimuli/stimuli.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

struct Options {
  std::string study, weights;
  StimuliOptions stimuli;
};

/// One line for each thing that is done.
auto progress_lines() {
  struct Line {
    std::string what;
    std::optional<Progress> progress;
  };
  return [line = std::make_shared<Line>()](const std::string& what, int64_t done, int64_t total) {
    if (line->what != what || !line->progress) {
      line->progress.emplace(what, total);
      line->what = what;
    }
    line->progress->step(done);
    if (done == total) line->progress.reset();
  };
}

int make(const Options& options) {
  const Study study = read_study(options.study);
  check_files(study);
  check_lengths(study);
  const StudioServices program = studio_services(options.weights);
  StimuliOptions how = options.stimuli;
  how.study_folder = folder_of_file(options.study);
  how.made_by = program.weights();
  const StimuliReport report =
      make_stimuli(study, {program.networks, progress_lines(), program.motion_coder}, how);
  std::printf("%s: %d clips", how.out.c_str(), report.clips);
  if (report.made == 0)
    std::printf(", all were there\n");
  else
    std::printf(", %d made now: %.0f s of retargeting, %.0f s of drawing (%.1f frames/s)\n", report.made,
                report.stage_s, report.render_s, static_cast<double>(report.frames) / report.render_s);
  return 0;
}

}  // namespace

void add_study_stimuli(CLI::App& study, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<Options>();
  CLI::App& command = *study.add_subcommand(
      "stimuli", "renders every clip of a study; what is there already and has not changed stays");
  command.add_option("study", options->study, "the .study file")->required();
  command
      .add_option("--out", options->stimuli.out, "the folder: clips/NAME.mp4, manifest.json and manifest.csv")
      ->required();
  command.add_flag("--separate", options->stimuli.separate,
                   "writes each pane as a film of its own, too: panes/NAME-source.mp4 ...");
  command.add_option("--weights", options->weights, "folder of the weights (default: beside the program)");
  command.callback([options, chosen] { *chosen = [options] { return make(*options); }; });
}

}  // namespace understudy::app
