#include "app/study/answer_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <utility>

#include "app/study/study_analysis.hpp"
#include "app/study/trial_exports.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

void check_name(const std::string& participant) {
  constexpr size_t kLongest = 100;
  const bool is_fit = !participant.empty() && participant.size() <= kLongest && participant[0] != '.' &&
                      std::none_of(participant.begin(), participant.end(), [](char c) {
                        return c == '/' || c == '\\' || static_cast<unsigned char>(c) < 0x20;
                      });
  US_CHECK(is_fit, "\"", excerpt(participant),
           "\" cannot be a participant's name, since the file of the answers is called so");
}

}  // namespace

class AnswerFile::Lock {
 public:
  /// Whoever held it before may remove the file at this moment: then it is another file's lock, and the next
  /// round gets the right one.
  Lock(std::string path, const std::string& participant) : path_(std::move(path)) {
    while (!is_taken(participant)) ::close(file_);
  }
  ~Lock() {
    ::unlink(path_.c_str());
    ::close(file_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  bool is_taken(const std::string& participant) {
    file_ = ::open(path_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    US_CHECK(file_ >= 0, path_, ": cannot be written (", std::strerror(errno), ")");
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      ::close(file_);
      throw Error("participant " + participant + " is answering in another window (" + path_ + ")");
    }
    struct stat held {};
    struct stat there {};
    return ::fstat(file_, &held) == 0 && ::stat(path_.c_str(), &there) == 0 && held.st_ino == there.st_ino;
  }

  std::string path_;
  int file_ = -1;
};

AnswerFile::AnswerFile(const std::string& folder, const std::string& participant, const Study& study,
                       const std::string& study_folder)
    : participant_(participant), design_(digest_of(study, study_folder)) {
  check_name(participant);
  std::error_code failed;
  fs::create_directories(folder, failed);
  US_CHECK(!failed, folder, ": cannot be made (", failed.message(), ")");
  path_ = (fs::path(folder) / (participant + ".csv")).string();
  lock_ = std::make_unique<Lock>((fs::path(folder) / ("." + participant + ".lock")).string(), participant);
  check_writable(path_);
  if (fs::exists(path_)) read(study, study_folder);
}
AnswerFile::~AnswerFile() = default;

void AnswerFile::read(const Study& study, const std::string& study_folder) {
  std::vector<std::string> factors;
  ParticipantAnswers before = read_participant(path_, factors);
  US_CHECK(before.participant == participant_, path_, ": holds the answers of \"",
           excerpt(before.participant), "\"");
  US_CHECK(factors == trial_factor_names() && !before.design.empty(), path_,
           ": was not written here: it has other columns");
  check_design(path_, before.design, study, study_folder);
  answers_ = std::move(before.answers);
}

std::vector<StudyAnswer> AnswerFile::answers_to(const Trial& trial, const Study& study) const {
  std::vector<StudyAnswer> given;
  for (const int question : trial.questions) {
    const std::string& name = study.questions[question].name;
    const auto at = std::find_if(answers_.begin(), answers_.end(), [&](const StudyAnswer& one) {
      return one.trial == trial.id && one.question == name;
    });
    StudyAnswer none;
    none.trial = trial.id, none.question = name;
    given.push_back(at != answers_.end() ? *at : none);
  }
  return given;
}

bool AnswerFile::has(const Trial& trial, const Study& study) const {
  const std::vector<StudyAnswer> given = answers_to(trial, study);
  return std::none_of(given.begin(), given.end(), [](const StudyAnswer& one) { return one.answer.empty(); });
}

void AnswerFile::save(const Trial& trial, const Study& study, std::vector<StudyAnswer> answers) {
  std::vector<StudyAnswer> all;
  std::copy_if(answers_.begin(), answers_.end(), std::back_inserter(all),
               [&](const StudyAnswer& one) { return one.trial != trial.id; });
  for (StudyAnswer& one : answers) {
    one.trial = trial.id;
    one.levels = trial_factors(study, trial);
    all.push_back(std::move(one));
  }
  write_file(path_, text_of(all));
  answers_ = std::move(all);
}

std::string AnswerFile::text_of(const std::vector<StudyAnswer>& answers) const {
  std::string text = "participant,trial,question,answer,rt_ms,replays,shown_at";
  for (const std::string& factor : trial_factor_names()) text += "," + csv_cell(factor);
  text += ",design\n";
  for (size_t i = 0; i < answers.size(); ++i) {
    const StudyAnswer& one = answers[i];
    for (const std::string& cell : {participant_, one.trial, one.question, one.answer,
                                    std::isfinite(one.rt_ms) ? printed("%.0f", one.rt_ms) : std::string(),
                                    std::to_string(one.replays), one.shown_at})
      text += csv_cell(cell) + ",";
    for (const std::string& level : one.levels) text += csv_cell(level) + ",";
    text += (i == 0 ? csv_cell(design_) : "") + "\n";
  }
  return text;
}

}  // namespace understudy::app
