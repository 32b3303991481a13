#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/run/export_presets.hpp"
#include "app/run/flat_performance.hpp"
#include "app/session/command_sets.hpp"
#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/live/pose_sender.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// Of a flat take: the path's suffix says what is written.
void export_flat(Call& c) {
  const std::string path = c.path(1);
  const ExportChoice choice = export_choice("poses.json", {c.arguments.begin() + 2, c.arguments.end()});
  US_CHECK(choice.takes.empty(), "a file of 2D poses holds one take");
  const auto poses =
      std::make_shared<const KeypointReading>(exported_poses(c.session, c.take_number(), choice.poses.count));
  check_not_read(path, files_read_by(c.document));
  c.studio.jobs().start(
      "Exporting " + file_name(path),
      [path, poses, choice](JobControl&) { write_flat(path, *poses, choice.poses); },
      [&studio = c.studio, path, count = ssize(poses->frames)] {
        studio.notify("Exported " + file_name(path) + ": " + grouped(count) + " frames", false,
                      showing(path));
      });
  remember_folder(c.studio, path);
}

void run_export(Call& c) {
  if (c.take().flat) return export_flat(c);
  std::vector<size_t> takes = {c.take_number()};
  const std::string path = c.path(1);
  const ExportChoice choice = export_choice(path, {c.arguments.begin() + 2, c.arguments.end()});
  for (const std::string& name : choice.takes) takes.push_back(take_called(c.document, name));
  const ExportFormat& format = *choice.format;
  US_CHECK(takes.size() == 1 || format.is_character, path, ": ", format.label, " holds one motion, not ",
           takes.size());
  const auto performers = std::make_shared<std::vector<ExportInput>>(export_inputs(c.session, takes, choice));
  check_not_read(path, files_read_by(c.document));
  check_export(path, format);
  const auto cost = std::make_shared<ExportCost>();
  c.studio.jobs().start(
      "Exporting " + file_name(path),
      [performers, path, &format, cost](JobControl& control) {
        performers->front().body.file.progress = [&control](float done) {
          control.check();
          control.progress(done);
        };
        *cost = export_motion(path, format, *performers);
      },
      [&studio = c.studio, path, cost] {
        studio.notify("Exported " + file_name(path) + ": " + sentence(*cost), false, showing(path));
      });
  c.session.settings.export_format = format.name;
  remember_folder(c.studio, path);
}

std::string counted(size_t takes) {
  return std::to_string(takes) + (takes == 1 ? " take" : " takes");
}

/// What became of an export of all takes, of which one at least was written: a notice, and where some could
/// not be an error with why. problems: as write_takes returns them.
void tell_of_takes(Studio& studio, const std::vector<TakeFile>& files,
                   const std::vector<std::string>& problems) {
  const auto first = std::find(problems.begin(), problems.end(), "");
  const std::string& path = files.at(first - problems.begin()).path;
  const size_t written = std::count(problems.begin(), problems.end(), "");
  const bool is_whole = written == files.size();
  const std::string of_all = is_whole ? "" : std::to_string(written) + " of ";
  const std::string folder = fs::path(path).parent_path().filename().string();
  studio.notify("Exported " + of_all + counted(files.size()) + " to " + folder, !is_whole, showing(path));
  std::string all;
  for (const std::string& problem : problems)
    if (!problem.empty()) append_item(all, problem, "; ");
  US_CHECK(is_whole, counted(files.size() - written), " could not be exported. ", all);
}

/// A file of each take. FOLDER [format=NAME|csv] and the options of export.run.
void export_all(Call& c) {
  const std::string folder = c.path(0, "folder");
  Arguments words(c.arguments.begin() + 1, c.arguments.end());
  const auto figures = std::find(words.begin(), words.end(), "format=csv");
  const bool are_figures = figures != words.end();
  if (are_figures) words.erase(figures);
  words.insert(words.begin(), "format=glb");  // a later one counts
  const ExportChoice choice = export_choice(folder, words);
  US_CHECK(choice.takes.empty(), "take= has no meaning here: all takes are exported");
  const auto files = std::make_shared<const std::vector<TakeFile>>(
      are_figures ? figure_files(c.session, folder) : take_files(c.session, folder, choice));
  US_CHECK(!files->empty(), "there is no take to export");
  const auto problems = std::make_shared<std::vector<std::string>>();
  c.studio.jobs().start(
      "Exporting " + counted(files->size()) + " to " + file_name(folder),
      [files, folder, problems](JobControl& control) {
        *problems = write_takes(folder, *files, [&control](float done) {
          control.check();
          control.progress(done);
        });
      },
      [&studio = c.studio, files, problems] { tell_of_takes(studio, *files, *problems); });
  remember_folder(c.studio, folder);
  c.session.settings.export_format = are_figures ? "csv" : choice.format->name;
}

void export_figures(Call& c) {
  const TakeState& state = c.take_state();
  US_CHECK(!state.series.empty(), "there are no metrics yet");
  const std::string path = c.path(1);
  c.studio.jobs().start(
      "Exporting " + file_name(path),
      [path, series = state.series, times = state.times, fps = c.session.source.fps](JobControl&) {
        write_csv(path, series, fps, times);
      },
      [&studio = c.studio, path] { studio.notify("Exported " + file_name(path), false, showing(path)); });
  c.session.settings.export_format = "csv";
  remember_folder(c.studio, path);
}

}  // namespace

void add_export_commands(Commands& commands) {
  commands.add({"poses.send", "Send poses to an engine", "on|off"},
               [](Call& c) { c.studio.send_poses(c.on(0)); });
  commands.add({"poses.address", "Where poses are sent", "vmc://HOST:PORT|osc://HOST:PORT"}, [](Call& c) {
    c.session.settings.send_to = send_address(c.word(0, "address")).text();
    c.studio.save_settings();
    if (!c.session.sends_to.empty()) c.studio.send_poses(true);
  });
  commands.add(
      {"export.run", "Export animation",
       "TAKE PATH [format=NAME] [preset=" + names_of_presets() +
           "] [bones=own|22] [influences=4|8] [morphs=COUNT] [reduce=MM] "
           "[in_place=on] [root_motion=on] [t_pose=on] [keep_clips=on] [camera=WORDS|FILE|view] "
           "[canvas=WIDTHxHEIGHT] [rate=NUMBER] [count=COUNT|4n+1] [depth=on] [normals=on] [mask=on] "
           "[points=openpose18|body25] [stick_width=PIXELS] [hide_limbs=on] [whole_face=on] "
           "[pose_file=controlnet|openpose|none] "
           "[take=NAME ...: clips of the "
           "same character, or others who perform at once]"},
      run_export);
  commands.add({"export.all", "Export all takes, a file each",
                "FOLDER [format=NAME|csv] and the options of export.run"},
               export_all);
  commands.add({"export.csv", "Export metrics as CSV", "TAKE PATH"}, export_figures);
}

}  // namespace understudy::app
