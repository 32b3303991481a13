#include "app/cli/study_design.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "app/cli/options.hpp"
#include "app/study/presets.hpp"
#include "app/study/trial_exports.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

struct NewOptions {
  std::string preset, out;
};

int make_study(const NewOptions& options) {
  std::error_code ignored;
  US_CHECK(!std::filesystem::exists(options.out, ignored), options.out, ": is there already");
  const Study study = study_preset(options.preset).make(samples_folder());
  write_study(options.out, study);
  std::printf("%s: %s\n", options.out.c_str(), size_in_words(study).c_str());
  return 0;
}

struct TrialsOptions {
  std::string study, participant, format = "table", out;
  bool without_files = false;
};

int list_trials(const TrialsOptions& options) {
  check_writable(options.out);
  const Study study = read_study(options.study);
  if (!options.without_files) {
    check_files(study);
    check_lengths(study);
  }
  const std::vector<Trial> trials =
      options.participant.empty() ? all_trials(study) : trials_of(study, options.participant);
  const std::string text = trial_format(options.format).text(study, trials);
  if (options.out.empty())
    std::fputs(text.c_str(), stdout);
  else
    write_file(options.out, text);
  log::info(options.study + ": " + size_in_words(study));
  return 0;
}

}  // namespace

void add_study_new(CLI::App& study, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<NewOptions>();
  CLI::App& command = *study.add_subcommand("new", "writes a study of a paper, with the bundled samples");
  std::vector<std::string> names;
  std::string help;
  for (const StudyPreset& preset : study_presets()) {
    names.emplace_back(preset.name);
    append_item(help, std::string(preset.name) + ": " + preset.label + ", " + preset.sentence, "; ");
  }
  command.add_option("--preset", options->preset, help)->required()->check(CLI::IsMember(names));
  command.add_option("--out", options->out, "the .study file")->required();
  command.callback([options, chosen] { *chosen = [options] { return make_study(*options); }; });
}

void add_study_trials(CLI::App& study, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<TrialsOptions>();
  CLI::App& command = *study.add_subcommand("trials", "lists the trials of a study, for any runner");
  command.add_option("study", options->study, "the .study file")->required();
  command.add_option("--participant", options->participant,
                     "whose trials, in their order (default: all of the design); names that end in "
                     "consecutive numbers are balanced against each other");
  std::vector<std::string> names;
  for (const TrialFormat& format : trial_formats()) names.emplace_back(format.name);
  command
      .add_option("--format", options->format,
                  "table, csv, jspsych (a timeline as JSON) or psychopy (a conditions file)")
      ->check(CLI::IsMember(names));
  command.add_option("--out", options->out, "file that is written (default: standard output)");
  command.add_flag("--without-files", options->without_files,
                   "lists them although sources, targets or animations are gone or of other lengths");
  command.callback([options, chosen] { *chosen = [options] { return list_trials(*options); }; });
}

}  // namespace understudy::app
