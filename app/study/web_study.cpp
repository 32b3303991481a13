#include "app/study/web_study.hpp"

#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "app/study/clip_check.hpp"
#include "app/study/trial_exports.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPageFiles[] = {"study.css", "study.js", "index.html"};

/// Calls see(participant's number, trial) for all that P01 to the last one see.
template <class See>
void for_all_seen(const Study& study, int participants, const See& see) {
  for (int number = 1; number <= participants; ++number)
    for (const Trial& trial : trials_of(study, web_participant(number))) see(number, trial);
}

/// Values that are there once, each by its number.
class Numbered {
 public:
  /// The number of an equal one, which is added where there is none.
  int operator()(const Json& value) {
    const auto [found, is_new] = numbers_.emplace(value.dump(), static_cast<int>(values_.size()));
    if (is_new) values_.push_back(value);
    return found->second;
  }
  const Json& values() const { return values_; }

 private:
  Json values_ = Json::array();
  std::map<std::string, int> numbers_;
};

template <class Named>
Json names_in(const std::vector<Named>& list) {
  Json names = Json::array();
  for (const Named& one : list) names.push_back(one.name);
  return names;
}

/// As participants see it: which answer is right is not told, nor that one is.
Json asked_json(const StudyQuestion& question) {
  Json json = {{"name", question.name}, {"text", question.text}};
  if (question.kind != QuestionKind::Likert) {
    json["options"] = question.options;
    return json;
  }
  json["points"] = question.points;
  json["low"] = question.low;
  json["high"] = question.high;
  return json;
}

std::string colour_text(const Vec3& colour) {
  const auto part = [&](int i) { return static_cast<unsigned>(std::lround(255 * colour[i])); };
  return printed("#%02x%02x%02x", part(0), part(1), part(2));
}

void add_trials(Json& json, const Study& study, int participants) {
  Numbered clips, screens, asked;
  Json orders = Json::array();
  for_all_seen(study, participants, [&](int number, const Trial& trial) {
    const int clip = clips(clip_path(study, trial));
    const Json screen = {trial.id,         trial.condition,        trial.other, trial.motion, trial.target,
                         trial.repetition, int{trial.is_practice}, clip};
    if (static_cast<int>(orders.size()) < number) orders.push_back(Json::array());
    orders.back().push_back(screens(screen));
    orders.back().push_back(asked(trial.questions));
  });
  json["clips"] = clips.values();
  json["screens"] = screens.values();
  json["asked"] = asked.values();
  json["participants"] = orders;
}

/// A file that takes the place of another one when it is whole.
void copy_whole(const std::string& from, const std::string& to) {
  std::error_code failed;
  if (fs::equivalent(from, to, failed)) return;
  const std::string part = to + ".part";
  fs::copy_file(from, part, fs::copy_options::overwrite_existing, failed);
  if (!failed) fs::rename(part, to, failed);
  if (!failed) return;
  std::error_code ignored;
  fs::remove(part, ignored);
  throw Error(to + ": cannot be written (" + failed.message() + ")");
}

void make_folder(const std::string& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  US_CHECK(!failed, path, ": cannot be made (", failed.message(), ")");
}

}  // namespace

std::string web_participant(int number) {
  return printed("P%02d", number);
}

std::string web_data(const Study& study, const std::string& path, int participants) {
  const std::string design = digest_of(study, folder_of_file(path));
  Json json = {{"name", study.name},
               {"consent", study.consent},
               {"design", design},
               {"key", checksum_text(fnv1a(design))},
               {"minutes", std::ceil(minutes_of(study))},
               {"background", colour_text(study.picture.background)},
               {"break_every", study.plan.break_every},
               {"conditions", names_in(study.conditions)},
               {"motions", names_in(study.motions)},
               {"targets", names_in(study.targets)},
               {"questions", Json::array()}};
  for (const StudyQuestion& question : study.questions) json["questions"].push_back(asked_json(question));
  add_trials(json, study, participants);
  return "window.understudyStudy = " + std::string(trim_end(json_text(json))) + ";\n";
}

std::vector<std::string> web_clips(const Study& study, int participants) {
  Numbered clips;
  for_all_seen(study, participants, [&](int, const Trial& trial) { clips(clip_path(study, trial)); });
  return clips.values().get<std::vector<std::string>>();
}

void write_web_study(const Study& study, const std::string& path, const WebStudyOptions& options) {
  const int participants = options.participants > 0 ? options.participants : study.plan.participants;
  const std::string data = web_data(study, path, participants);
  const std::vector<std::string> clips = web_clips(study, participants);
  check_clips(clips, study, path, options.clips);
  make_folder(options.out + "/clips");
  check_writable(options.out + "/data.js");
  for (const std::string& clip : clips) copy_whole(options.clips + "/" + clip, options.out + "/" + clip);
  for (const char* name : kPageFiles)
    write_file(options.out + "/" + name, read_file(options.page + "/" + name));
  write_file(options.out + "/data.js", data);
}

}  // namespace understudy::app
