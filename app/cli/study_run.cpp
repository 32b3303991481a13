#include "app/cli/study_run.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/run/fields_json.hpp"
#include "app/studio/study_player.hpp"
#include "app/study/clip_check.hpp"
#include "app/study/trial_exports.hpp"

namespace understudy::app {
namespace {

struct RunOptions {
  std::string study, participant, clips, answers;
  bool in_window = false, software = false;
};

int run_study(const RunOptions& options) {
  const std::string folder = folder_of_file(options.study);
  StudyRun run(read_study(options.study), folder, options.participant, options.answers);
  std::vector<std::string> clips;
  for (const Trial& trial : run.trials()) clips.push_back(clip_path(run.study(), trial));
  check_clips(clips, run.study(), options.study, options.clips);
  render::WindowOptions window;
  window.full_screen = !options.in_window;
  window.software = options.software;
  StudyPlayer(run, options.clips, std::make_unique<WindowSurface>(window)).run();
  const bool done = run.screen() == RunScreen::End;
  std::printf("%s: %s\n", run.answers_path().c_str(),
              done ? "all trials are answered" : "not all trials are answered; run it again to go on");
  return 0;
}

}  // namespace

void add_study_run(CLI::App& study, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App& command = *study.add_subcommand("run", "shows the study to a participant, on the whole screen");
  command.add_option("study", options->study, "the .study file")->required();
  command.add_option("--participant", options->participant, "who: their file of answers is called so")
      ->required();
  command.add_option("--clips", options->clips, "folder that `study stimuli` has made")->required();
  command.add_option("--answers", options->answers, "folder of the files of answers")->required();
  command.add_flag("--window", options->in_window, "in a window");
  command.add_flag("--software", options->software, "draws without the graphics driver");
  command.callback([options, chosen] { *chosen = [options] { return run_study(*options); }; });
}

}  // namespace understudy::app
