#include "app/studio/study_render.hpp"

#include <cstdio>
#include <memory>

#include "app/session/command_sets.hpp"
#include "app/stimuli/stimuli.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

/// How far all clips are: what is done says "clip 3 of 45".
void tell(JobControl& control, const std::string& what, int64_t done, int64_t total) {
  int clip = 0, clips = 0;
  if (std::sscanf(what.c_str(), "clip %d of %d", &clip, &clips) != 2 || clips < 1 || total < 1) return;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  control.progress(static_cast<float>((clip - 1 + share) / clips));
}

std::string sentence(const StimuliReport& report) {
  const std::string clips = std::to_string(report.clips) + (report.clips == 1 ? " clip" : " clips");
  if (report.made == report.clips) return "Rendered " + clips;
  return clips + " are there, " + std::to_string(report.made) + " of them rendered now";
}

void render_stimuli(Call& c) {
  const StudyState& state = c.session.study;
  US_CHECK(state.study, "no study is open");
  US_CHECK(state.problem.empty(), state.problem);
  StimuliOptions options;
  options.out = c.path(0, "folder");
  options.study_folder = state.path.empty() ? "" : folder_of_file(state.path);
  options.separate = c.has("separate", 1);
  c.session.study.folders[state.path].clips = options.out;
  const auto report = std::make_shared<StimuliReport>();
  c.studio.jobs().start(
      "Rendering " + state.study->name,
      [study = *state.study, options, services = c.studio.services(), report](JobControl& control) mutable {
        check_files(study);
        check_lengths(study);
        if (services.weights) options.made_by = services.weights();
        StimulusServices making;
        making.networks = services.networks;
        making.motion_coder = services.motion_coder;
        making.progress = [&control](const std::string& what, int64_t done, int64_t total) {
          control.check();
          tell(control, what, done, total);
        };
        *report = make_stimuli(study, making, options);
      },
      [&studio = c.studio, report, folder = options.out] {
        studio.notify(sentence(*report), false, showing(folder + "/manifest.json"));
      });
  remember_folder(c.studio, options.out);
}

}  // namespace

void add_study_render(Commands& commands) {
  commands.add(
      {"study.render", "Render stimuli", "FOLDER [separate]: every clip, and each pane as a film of its own"},
      render_stimuli);
}

}  // namespace understudy::app
