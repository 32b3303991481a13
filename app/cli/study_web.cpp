#include "app/cli/study_web.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/study/web_study.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/program_files.hpp"

namespace understudy::app {
namespace {

struct StudyWebOptions {
  std::string study;
  WebStudyOptions web;
};

int study_web(const StudyWebOptions& options) {
  const Study study = read_study(options.study);
  WebStudyOptions web = options.web;
  web.page = program_files("study_web").string();
  US_CHECK(!web.page.empty(),
           "the page for browsers is missing: no folder assets/study_web beside the program or above it, nor "
           "../share/understudy/study_web");
  if (web.participants == 0) web.participants = study.plan.participants;
  write_web_study(study, options.study, web);
  std::printf("%s/index.html: participants P01 to %s, %d trials each\n", web.out.c_str(),
              web_participant(web.participants).c_str(), trial_count(study));
  return 0;
}

}  // namespace

void add_study_web(CLI::App& study, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<StudyWebOptions>();
  CLI::App& command = *study.add_subcommand(
      "web", "a folder that runs the study in a browser, from a file or from any web server");
  command.add_option("study", options->study, "the .study file")->required();
  command.add_option("--clips", options->web.clips, "folder that study stimuli wrote")->required();
  command.add_option("--out", options->web.out, "the folder: index.html and all that it needs")->required();
  command
      .add_option("--participants", options->web.participants,
                  "how many may take part, P01, P02 and so on (default: as many as the study plans)")
      ->check(CLI::Range(1, 100000));
  command.callback([options, chosen] { *chosen = [options] { return study_web(*options); }; });
}

}  // namespace understudy::app
