#include <filesystem>

#include "app/session/command_sets.hpp"
#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

void run_export(Call& c) {
  std::vector<size_t> takes = {c.take_number()};
  const std::string path = c.path(1);
  const ExportChoice choice = export_choice(path, {c.arguments.begin() + 2, c.arguments.end()});
  for (const std::string& name : choice.takes) takes.push_back(take_called(c.document, name));
  const ExportFormat& format = *choice.format;
  US_CHECK(takes.size() == 1 || format.is_character, path, ": ", format.label, " holds one motion, not ",
           takes.size());
  const auto input = std::make_shared<ExportInput>(export_input(c.session, takes, choice));
  check_export(path, format);
  const auto cost = std::make_shared<ExportCost>();
  c.studio.jobs().start(
      "Exporting " + file_name(path),
      [input, path, &format, cost](JobControl& control) {
        input->body.file.progress = [&control](float done) {
          control.check();
          control.progress(done);
        };
        *cost = export_motion(path, format, *input);
      },
      [&studio = c.studio, path, cost] {
        studio.notify("Exported " + file_name(path) + ": " + sentence(*cost), false, showing(path));
      });
  c.session.settings.export_format = format.name;
}

void export_figures(Call& c) {
  const TakeState& state = c.take_state();
  US_CHECK(!state.series.empty(), "there are no figures yet");
  const std::string path = c.path(1);
  c.studio.jobs().start(
      "Exporting " + file_name(path),
      [path, series = state.series, fps = c.session.source.fps](JobControl&) {
        write_csv(path, series, fps);
      },
      [&studio = c.studio, path] { studio.notify("Exported " + file_name(path), false, showing(path)); });
  c.session.settings.export_format = "csv";
}

}  // namespace

void add_export_commands(Commands& commands) {
  commands.add({"export.run", "Export animation",
                "TAKE PATH [format=NAME] [rig=theirs|ours] [influences=4|8] [morphs=COUNT] [reduce=MM] "
                "[in_place=on] [t_pose=on] [keep_clips=on] [take=NAME ...: more clips]"},
               run_export);
  commands.add({"export.csv", "Export figures as CSV", "TAKE PATH"}, export_figures);
}

}  // namespace understudy::app
