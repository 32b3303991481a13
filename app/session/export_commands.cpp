#include <filesystem>

#include "app/session/command_sets.hpp"
#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {

namespace fs = std::filesystem;
namespace {

size_t take_number(Studio& studio, const Arguments& a) {
  take_argument(studio.session(), a, 0);
  return whole_number(a, 0, "take");
}

std::string whole_path(const Arguments& a) {
  return fs::absolute(word(a, 1, "path")).lexically_normal().string();
}

void run_export(Studio& studio, const Arguments& a) {
  const size_t take = take_number(studio, a);
  const std::string path = whole_path(a);
  const ExportChoice choice = export_choice(path, {a.begin() + 2, a.end()});
  const Session& session = studio.session();
  std::vector<size_t> takes = {take};
  for (const std::string& name : choice.takes) takes.push_back(take_called(session.document, name));
  const ExportFormat& format = *choice.format;
  US_CHECK(takes.size() == 1 || format.is_character, path, ": ", format.label,
           " holds one motion, these are ", takes.size());
  const auto input = std::make_shared<ExportInput>(export_input(session, takes, choice));
  check_export(path, format);
  const std::string name = fs::path(path).filename().string();
  const auto cost = std::make_shared<ExportCost>();
  studio.jobs().start(
      "Exporting " + name,
      [input, path, &format, cost](JobControl& control) {
        input->body.file.progress = [&control](float done) {
          control.check();
          control.progress(done);
        };
        *cost = export_motion(path, format, *input);
      },
      [&studio, name, cost] { studio.notify("Exported " + name + ": " + sentence(*cost)); });
}

void export_figures(Studio& studio, const Arguments& a) {
  const TakeState& state = studio.session().takes[take_number(studio, a)];
  US_CHECK(!state.series.empty(), "there are no figures yet");
  const std::string path = whole_path(a), name = fs::path(path).filename().string();
  studio.jobs().start(
      "Exporting " + name,
      [path, series = state.series, fps = studio.session().source.fps](JobControl&) {
        write_csv(path, series, fps);
      },
      [&studio, name] { studio.notify("Exported " + name); });
}

}  // namespace

void add_export_commands(Commands& commands) {
  commands.add({"export.run", "Export animation",
                "TAKE PATH [format=NAME] [rig=theirs|ours] [influences=4|8] [morphs=COUNT] [reduce=MM] "
                "[in_place=on] [t_pose=on] [keep_clips=on] [take=NAME ...: more clips]",
                "", false, false, run_export});
  commands.add({"export.csv", "Export figures as CSV", "TAKE PATH", "", false, false, export_figures});
}

}  // namespace understudy::app
