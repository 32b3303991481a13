#include "app/session/study_showing.hpp"

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "app/session/child_program.hpp"
#include "app/session/command_sets.hpp"
#include "app/study/web_study.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/program_files.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// As it is in its file. Throws Error where none is open, or it is not saved or not complete.
const Study& shown_study(const StudyState& state) {
  const std::string problem = why_not_shown(state);
  US_CHECK(problem.empty(), problem);
  return *state.study;
}

/// The folder of clips that the call names, else the one that is known.
std::string clips_of(const Call& c, size_t i) {
  if (c.arguments.size() > i) return c.path(i);
  std::string known = folders_of(c.session.study).clips;
  US_CHECK(!known.empty(), "the folder of clips is not known: render the stimuli, or name it");
  return known;
}

void write_web(Call& c) {
  const StudyState& state = c.session.study;
  const Study& study = shown_study(state);
  WebStudyOptions options;
  options.page = program_files("study_web").string();
  US_CHECK(!options.page.empty(), "the page for browsers is missing: there is no folder study_web");
  options.out = c.path(0, "folder");
  options.clips = clips_of(c, 1);
  options.participants = study.plan.participants;
  c.session.study.folders[state.path].clips = options.clips;
  c.studio.jobs().start(
      "Making " + file_name(options.out),
      [study, file = state.path, options](JobControl&) { write_web_study(study, file, options); },
      [&studio = c.studio, options] {
        const std::string index = options.out + "/index.html";
        studio.notify("Made the web page for P01 to " + web_participant(options.participants), false,
                      Offer{"Open the page", join_line("file.open", {index}), true});
      });
  remember_folder(c.studio, options.out);
}

/// "all trials are answered" of "/a/P01.csv: all trials are answered".
std::string after_path(const std::string& line) {
  const size_t at = line.rfind(": ");
  return at == line.npos ? line : line.substr(at + 2);
}

/// What a run of the participant came to. Throws Error with the sentence of one that failed.
std::string outcome(const std::string& participant, const ChildProgram::End& end) {
  const std::string program = "understudy: ";
  if (end.code == 0) return participant + ": " + (end.out.empty() ? "done" : after_path(end.out));
  US_CHECK(end.code >= 0 && !end.err.empty(), "the run of ", participant,
           " has crashed; its answers so far are saved: run it again to go on");
  throw Error(end.err.rfind(program, 0) == 0 ? end.err.substr(program.size()) : end.err);
}

/// [PARTICIPANT [CLIPS [ANSWERS]]]. Not on the thread of the job, whose priority the runner would have.
void run_participant(Call& c) {
  StudyState& state = c.session.study;
  shown_study(state);
  StudyFolders folders;
  folders.clips = clips_of(c, 1);
  folders.answers = c.arguments.size() > 2 ? c.path(2) : folders_of(state).answers;
  const bool is_named = !c.arguments.empty() && !c.arguments[0].empty();
  const std::string participant = is_named ? c.arguments[0] : next_participant(folders.answers);
  state.folders[state.path] = folders;
  const std::string& program = c.studio.services().program;
  const auto child = std::make_shared<ChildProgram>(std::vector<std::string>{
      program.empty() ? "/proc/self/exe" : program, "study", "run", state.path,
      "--participant=" + participant, "--clips=" + folders.clips, "--answers=" + folders.answers});
  const auto sentence = std::make_shared<std::string>();
  c.studio.jobs().start(
      "Running " + participant,
      [child, participant, sentence](JobControl& control) {
        std::optional<ChildProgram::End> end;
        while (!(end = child->end())) {
          if (control.cancelled()) child->stop();
          control.check();
          std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        *sentence = outcome(participant, *end);
      },
      [&studio = c.studio, sentence] { studio.notify(*sentence); });
}

}  // namespace

StudyFolders folders_of(const StudyState& state) {
  StudyFolders folders;
  if (const auto used = state.folders.find(state.path); used != state.folders.end()) folders = used->second;
  if (state.path.empty()) return folders;
  const std::string stem = fs::path(state.path).replace_extension().string();
  std::error_code failed;
  if (folders.clips.empty() && fs::exists(stem + " stimuli/manifest.json", failed))
    folders.clips = stem + " stimuli";
  if (folders.answers.empty()) folders.answers = stem + " answers";
  return folders;
}

std::string next_participant(const std::string& answers) {
  int number = 1;
  std::error_code failed;
  while (fs::exists(answers + "/" + web_participant(number) + ".csv", failed)) ++number;
  return web_participant(number);
}

std::string why_not_shown(const StudyState& state) {
  if (!state.study) return "no study is open";
  if (!state.problem.empty()) return state.problem;
  if (state.path.empty()) return "the study has no file yet: save it under a name";
  return state.changed ? "the study is not saved: participants see what is in its file" : "";
}

void add_study_showing(Commands& commands) {
  commands.add({"study.web", "Web page of study",
                "FOLDER [CLIPS]: a folder for any browser; clips: those rendered last by default"},
               write_web);
  commands.add({"study.run", "Run study",
                "[PARTICIPANT [CLIPS [ANSWERS]]]: on the whole screen; the next one, with the folders that "
                "were used last, by default"},
               run_participant);
}

}  // namespace understudy::app
