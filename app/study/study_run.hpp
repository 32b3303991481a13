// One participant's way through a study: which screen is next, what was answered, what is saved. Without a
// window and without a clock of its own.
#pragma once

#include <string>
#include <vector>

#include "app/study/answer_file.hpp"

namespace understudy::app {

/// What the participant sees.
enum class RunScreen {
  Welcome,    ///< who they are and what to do; waits for begin()
  Clip,       ///< the clip plays; waits for clip_ended()
  Questions,  ///< waits for answers and confirm()
  Pause,      ///< practice is over, or it is time for a break; waits for begin()
  End
};

class StudyRun {
 public:
  /// Takes up where the participant left off. Throws Error as AnswerFile and trials_of() do.
  StudyRun(Study study, const std::string& study_folder, const std::string& participant,
           const std::string& answers_folder);

  const Study& study() const { return study_; }
  const std::string& participant() const { return participant_; }
  const std::string& answers_path() const { return file_.path(); }
  /// All of this participant's, in their order, practice first.
  const std::vector<Trial>& trials() const { return trials_; }
  RunScreen screen() const { return screen_; }
  /// Of Clip and Questions: the one that is shown. Of Welcome and Pause: the one that comes next.
  const Trial& trial() const { return trials_[at_]; }
  /// Of this trial among those of its kind, from 1, and how many there are: "Practice 2 of 3", "Trial 7 of
  /// 45".
  int number() const;
  int count() const;
  /// Whether some answers were there when this began.
  bool is_resumed() const { return is_resumed_; }

  /// The current trial's questions: what is chosen, empty while nothing is.
  const std::vector<std::string>& chosen() const { return chosen_; }
  bool is_complete() const;

  /// Goes on from Welcome and Pause.
  void begin();
  /// The clip has been shown to its end. now_s: seconds of any clock that never jumps; shown_at: the time of
  /// day (ISO 8601), as it is saved. That it was shown is saved at once, if that can be.
  void clip_ended(double now_s, const std::string& shown_at);
  /// Chooses an answer to question `index` of the trial's, and saves it; it may be chosen anew. Throws Error
  /// where it is none of the question's, and where it cannot be saved: then it is chosen all the same.
  void choose(int index, const std::string& answer, double now_s);
  /// Shows the clip again; answers chosen so far stay.
  void replay();
  /// Goes on to the next trial, a pause or the end; saves the answers that could not be saved before. Throws
  /// Error where they still cannot: then the screen stays, and nothing is lost. Does nothing until
  /// is_complete().
  void confirm();

 private:
  void skip_answered();
  void show_next();
  void save();

  Study study_;
  std::string participant_;
  AnswerFile file_;
  std::vector<Trial> trials_;
  size_t at_ = 0;
  RunScreen screen_ = RunScreen::Welcome;
  bool is_resumed_ = false;
  std::vector<std::string> chosen_;
  std::vector<double> took_s_;  // of each question, from when it could be answered to its last choice
  double asked_at_s_ = 0;
  bool is_asked_ = false;  // the clip has been shown to its end since this began
  bool is_saved_ = false;
  std::string shown_at_;
  int replays_ = 0;
};

/// The answers that a question offers, as they are saved: "1" ... "7", or its options.
std::vector<std::string> offered_answers(const StudyQuestion& question);

}  // namespace understudy::app
