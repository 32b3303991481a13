// The answers of one participant as they come: saved after each, taken up again later.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/study/answers.hpp"
#include "app/study/trials.hpp"

namespace understudy::app {

/// FOLDER/PARTICIPANT.csv, in the form of answers.hpp, and the right to write it: FOLDER/.PARTICIPANT.lock is
/// held while this lives, and let go of even by a crash.
class AnswerFile {
 public:
  /// Makes the folder if need be and reads what is there. study_folder: of the study's file. Throws Error: a
  /// name that cannot be one of a file, a file that somebody else is writing, a damaged one, or answers to
  /// another design (what has changed since is said).
  AnswerFile(const std::string& folder, const std::string& participant, const Study& study,
             const std::string& study_folder);
  ~AnswerFile();
  AnswerFile(const AnswerFile&) = delete;
  AnswerFile& operator=(const AnswerFile&) = delete;

  const std::string& path() const { return path_; }
  /// All that was answered, in the order of the file.
  const std::vector<StudyAnswer>& answers() const { return answers_; }
  /// Those to the trial's questions, in their order; of one that is not there, an empty answer.
  std::vector<StudyAnswer> answers_to(const Trial& trial, const Study& study) const;
  /// Whether each question that the trial asks has been answered.
  bool has(const Trial& trial, const Study& study) const;
  /// Saves a trial's answers, in place of earlier ones to the same trial. Their factors are filled in. Throws
  /// Error naming the file where it cannot be written; then neither it nor answers() has changed.
  void save(const Trial& trial, const Study& study, std::vector<StudyAnswer> answers);

 private:
  class Lock;
  void read(const Study& study, const std::string& study_folder);
  std::string text_of(const std::vector<StudyAnswer>& answers) const;

  std::string participant_, path_, design_;
  std::unique_ptr<Lock> lock_;
  std::vector<StudyAnswer> answers_;
};

}  // namespace understudy::app
