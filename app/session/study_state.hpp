// The study that is open beside the document.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/session/history.hpp"
#include "app/study/study.hpp"
#include "app/study/trials.hpp"

namespace understudy::app {

/// What the panel shows one item of at a time.
enum class StudyList { Condition, Motion, Target, Question, Trial };
constexpr Names<5> kStudyListNames{"condition", "motion", "target", "question", "trial"};

/// Of a study, used since the program started; empty: not yet.
struct StudyFolders {
  std::string clips, answers;
};

struct StudyState {
  std::optional<Study> study;  ///< none: no study is open; it may be one that check() refuses
  std::string path;            ///< of the .study file; empty: not saved yet
  bool changed = false;
  StudyHistory history;
  std::string participant;  ///< in whose order the trials are listed; empty: all of the design, in its order
  std::map<std::string, StudyFolders> folders;  ///< of each study, by its path
  std::array<int, 5> chosen{};  ///< of each list, in the order of StudyList; past its end where it is empty

  // What follows from the design.
  std::string problem;        ///< why it cannot be run, one sentence; empty: it can
  std::string gone;           ///< which of its files is gone, one sentence; empty: none
  std::vector<Trial> trials;  ///< none where there is a problem
  int count = 0;              ///< of a participant's trials, practice left out
  double minutes = 0;         ///< of a participant
};

/// The chosen item of a list; -1 where it is empty.
int chosen(const StudyState& state, StudyList list);
/// Works out what follows from the design.
void follow_design(StudyState& state);

}  // namespace understudy::app
