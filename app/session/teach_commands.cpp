// Styles of one's own: fitted to recordings in the background, kept on this machine.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/run/style_teacher.hpp"
#include "app/session/command_sets.hpp"
#include "app/session/taught_styles.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

/// What is asked for, and the job's answer.
struct Teaching {
  StyleLesson lesson;
  std::string file;
  bool replace = false;  // what is there already
  int64_t take = 0;      // that gets the style; 0: none
  std::string fitted_to;
};

std::string kept_folder(const Call& c) {
  std::string folder = styles_folder(c.studio.services().settings_file);
  US_CHECK(!folder.empty(), "taught styles are kept beside the settings, and no settings are kept here");
  return folder;
}

/// joints=, licence=, attribution=, made_from=, replace=.
void set_lesson(Teaching& teaching, const std::string& setting) {
  const size_t equals = setting.find('=');
  US_CHECK(equals != std::string::npos, "a setting is written as joints=all, not ", setting);
  const std::string key = setting.substr(0, equals);
  const ArgumentReader value({setting.substr(equals + 1)});
  StyleLesson& lesson = teaching.lesson;
  if (key == "joints")
    lesson.joints = value.one_of(0, "joints", {"all", "trunk-and-limbs", "upper-body"});
  else if (key == "licence")
    lesson.note.licence = value.arguments[0];
  else if (key == "attribution")
    lesson.note.attribution = value.arguments[0];
  else if (key == "made_from")
    lesson.note.made_from = value.arguments[0];
  else if (key == "replace")
    teaching.replace = value.choice(0, "replace", {"0", "1"}) == 1;
  else
    throw Error("a style has joints, licence, attribution, made_from and replace, not " + excerpt(key));
}

std::shared_ptr<Teaching> asked_teaching(const Call& c) {
  auto teaching = std::make_shared<Teaching>();
  StyleLesson& lesson = teaching->lesson;
  lesson.from = c.path(0, "folder of how they move now");
  lesson.to = c.path(1, "folder of how they shall move");
  lesson.note.label = c.word(2, "name");
  lesson.note.licence = "own recordings";
  for (size_t i = 3; i < c.arguments.size(); ++i) set_lesson(*teaching, c.arguments[i]);
  US_CHECK(!lesson.note.licence.empty(), "the licence of the recordings is missing");
  const std::string problem = why_no_style_name(lesson.note.label);
  US_CHECK(problem.empty(), problem);
  teaching->file = (fs::path(kept_folder(c)) / (lesson.note.label + ".json")).string();
  std::error_code failed;
  US_CHECK(teaching->replace || !fs::exists(teaching->file, failed), "there is a style '", lesson.note.label,
           "' already: replace=1 replaces it");
  check_folders(lesson);
  return teaching;
}

/// Nothing is written before all is fitted.
void teach(Teaching& teaching, const StudioServices& services, JobControl& control) {
  NetworkParts parts;
  parts.extractor = true;
  const MannerFile style = teach_style(
      teaching.lesson, services.networks(Method{}, parts), [&](size_t done, size_t of, const std::string&) {
        control.check();
        control.progress(static_cast<float>(done) / static_cast<float>(of));
        control.tell(detail::join("recording ", std::min(done + 1, of), " of ", of));
      });
  const std::string text = to_json(style);
  teaching.fitted_to = style.origins.at("coupling").source;
  std::error_code failed;  // writing tells what is wrong with the folder
  fs::create_directories(fs::path(teaching.file).parent_path(), failed);
  control.check();
  write_file(teaching.file, text);
}

/// Takes that had a style of that file before perform in the new one.
void perform_anew(Studio& studio, const std::string& file) {
  const auto& takes = studio.session().document.takes;
  const bool any = std::any_of(takes.begin(), takes.end(),
                               [&](const Take& take) { return take.method.style.file == file; });
  if (any) studio.restart_work();
}

void keep_taught(Studio& studio, const Teaching& teaching) {
  studio.session().styles.taught = taught_styles(styles_folder(studio.services().settings_file));
  perform_anew(studio, teaching.file);
  const int take = studio.take_with_id(teaching.take);
  if (take >= 0) studio.run("method.style", {std::to_string(take), teaching.file});
  studio.notify("The style '" + teaching.lesson.note.label + "' was " + teaching.fitted_to);
}

bool is_teaching(const Call& c) {
  const auto jobs = c.studio.jobs().views();
  return std::any_of(jobs.begin(), jobs.end(),
                     [&](const JobView& job) { return job.id == c.session.styles.job; });
}

void start_teaching(Call& c) {
  US_CHECK(!is_teaching(c), "a style is being taught already");
  const auto teaching = asked_teaching(c);
  if (!c.document.takes.empty())
    teaching->take = c.studio.id_of_take(static_cast<size_t>(c.session.selected_take));
  remember_folder(c.studio, teaching->lesson.to);
  c.session.styles.job = c.studio.jobs().start(
      "Teaching " + teaching->lesson.note.label,
      [teaching, services = c.studio.services()](JobControl& control) {
        teach(*teaching, services, control);
      },
      [&studio = c.studio, teaching] { keep_taught(studio, *teaching); });
}

void forget_style(Call& c) {
  const std::string& name = c.word(0, "name");
  const TaughtStyle* const style = taught_style(c.session.styles, name);
  US_CHECK(style != nullptr && style->note.name == name, "no style '", excerpt(name), "' was taught here");
  for (const Take& take : c.document.takes)
    US_CHECK(take.method.style.file != style->file, take.name, " has the style ", name,
             ": it needs another one first");
  ForgottenStyle forgotten{name, style->file, read_file(style->file)};
  std::error_code failed;
  fs::remove(style->file, failed);
  US_CHECK(!failed, style->file, ": cannot be removed: ", failed.message());
  c.session.styles.taught = taught_styles(kept_folder(c));
  c.studio.notify("The style '" + name + "' was forgotten", false,
                  {"Undo", join_line("style.restore", {name})});
  c.session.styles.forgotten = std::move(forgotten);
}

/// Undo is of the document; a style's file is none of it.
void restore_style(Call& c) {
  const std::string& name = c.word(0, "name");
  auto& forgotten = c.session.styles.forgotten;
  US_CHECK(forgotten && forgotten->name == name, "the style '", excerpt(name), "' was not forgotten last");
  std::error_code failed;
  US_CHECK(!fs::exists(forgotten->file, failed), "there is another style '", name, "' by now");
  fs::create_directories(fs::path(forgotten->file).parent_path(), failed);  // writing tells what is wrong
  write_file(forgotten->file, forgotten->text);
  const std::string file = std::exchange(forgotten, std::nullopt)->file;
  c.session.styles.taught = taught_styles(kept_folder(c));
  perform_anew(c.studio, file);
}

}  // namespace

void add_teach_commands(Commands& commands) {
  commands.add({"style.teach", "Teach a style",
                "FROM TO NAME [SETTING=VALUE ...]: folders of recordings of two manners of moving; joints, "
                "licence, attribution, made_from, replace=1"},
               start_teaching);
  commands.add({"style.forget", "Forget a taught style", "NAME: it is removed from this machine"},
               forget_style);
  commands.add({"style.restore", "Bring back a forgotten style", "NAME: the one that was forgotten last"},
               restore_style);
}

}  // namespace understudy::app
