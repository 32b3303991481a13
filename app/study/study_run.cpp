#include "app/study/study_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

std::vector<std::string> offered_answers(const StudyQuestion& question) {
  if (question.kind != QuestionKind::Likert) return question.options;
  std::vector<std::string> points;
  for (int point = 1; point <= question.points; ++point) points.push_back(std::to_string(point));
  return points;
}

StudyRun::StudyRun(Study study, const std::string& study_folder, const std::string& participant,
                   const std::string& answers_folder)
    : study_(std::move(study)),
      participant_(participant),
      file_(answers_folder, participant, study_, study_folder),
      trials_(trials_of(study_, participant)),
      is_resumed_(!file_.answers().empty()) {
  skip_answered();
  if (at_ == trials_.size()) screen_ = RunScreen::End;
}

void StudyRun::skip_answered() {
  while (at_ < trials_.size() && file_.has(trials_[at_], study_)) ++at_;
}

int StudyRun::number() const {
  const int practice = study_.plan.practice, position = static_cast<int>(at_) + 1;
  return trial().is_practice ? position : position - practice;
}

int StudyRun::count() const {
  const int practice = study_.plan.practice;
  return trial().is_practice ? practice : static_cast<int>(trials_.size()) - practice;
}

bool StudyRun::is_complete() const {
  return std::none_of(chosen_.begin(), chosen_.end(), [](const std::string& one) { return one.empty(); });
}

void StudyRun::begin() {
  if (screen_ == RunScreen::Welcome || screen_ == RunScreen::Pause) show_next();
}

void StudyRun::show_next() {
  screen_ = RunScreen::Clip;
  chosen_.clear(), took_s_.clear(), shown_at_.clear();
  replays_ = 0;
  is_asked_ = false;
  for (const StudyAnswer& before : file_.answers_to(trial(), study_)) {
    chosen_.push_back(before.answer);
    took_s_.push_back(before.answer.empty() ? 0 : before.rt_ms / 1000);
    if (before.shown_at.empty()) continue;
    shown_at_ = before.shown_at;  // it was left in the middle: the clip is seen once more
    replays_ = before.replays + 1;
  }
}

void StudyRun::clip_ended(double now_s, const std::string& shown_at) {
  if (screen_ != RunScreen::Clip) return;
  screen_ = RunScreen::Questions;
  if (!std::exchange(is_asked_, true)) asked_at_s_ = now_s;  // played again, the time runs on
  if (shown_at_.empty()) shown_at_ = shown_at;
  static_cast<void>(failure_of([this] { save(); }));  // the first answer tells
}

void StudyRun::choose(int index, const std::string& answer, double now_s) {
  if (screen_ != RunScreen::Questions) return;
  US_CHECK(index >= 0 && index < static_cast<int>(chosen_.size()), "there is no question ", index + 1);
  const StudyQuestion& question = study_.questions[trial().questions[index]];
  const std::vector<std::string> offered = offered_answers(question);
  US_CHECK(std::find(offered.begin(), offered.end(), answer) != offered.end(), "\"", excerpt(answer),
           "\" is no answer to \"", excerpt(question.name), "\"");
  chosen_[index] = answer;
  took_s_[index] = now_s - asked_at_s_;
  save();
}

void StudyRun::replay() {
  if (screen_ != RunScreen::Questions) return;
  ++replays_;
  screen_ = RunScreen::Clip;
}

void StudyRun::save() {
  is_saved_ = false;
  std::vector<StudyAnswer> answers(chosen_.size());
  for (size_t i = 0; i < answers.size(); ++i) {
    answers[i].question = study_.questions[trial().questions[i]].name;
    answers[i].answer = chosen_[i];
    answers[i].rt_ms = chosen_[i].empty() ? std::nan("") : 1000 * took_s_[i];
    answers[i].replays = replays_;
    answers[i].shown_at = shown_at_;
  }
  file_.save(trial(), study_, std::move(answers));
  is_saved_ = true;
}

void StudyRun::confirm() {
  if (screen_ != RunScreen::Questions || !is_complete()) return;
  if (!is_saved_) save();
  const bool was_practice = trial().is_practice;
  skip_answered();
  if (at_ == trials_.size()) {
    screen_ = RunScreen::End;
    return;
  }
  const int every = study_.plan.break_every, done = number() - 1;
  const bool is_break = !trial().is_practice && every > 0 && done > 0 && done % every == 0;
  screen_ = RunScreen::Pause;
  if (!is_break && was_practice == trial().is_practice) show_next();
}

}  // namespace understudy::app
