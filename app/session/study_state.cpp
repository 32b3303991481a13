#include "app/session/study_state.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {

int chosen(const StudyState& state, StudyList list) {
  if (!state.study) return -1;
  const Study& study = *state.study;
  const std::array<std::ptrdiff_t, 5> sizes = {ssize(study.conditions), ssize(study.motions),
                                               ssize(study.targets), ssize(study.questions),
                                               ssize(state.trials)};
  const auto i = static_cast<size_t>(list);
  return static_cast<int>(std::min<std::ptrdiff_t>(state.chosen[i], sizes[i] - 1));
}

void follow_design(StudyState& state) {
  state.problem.clear(), state.gone.clear(), state.trials.clear();
  state.count = 0, state.minutes = 0;
  if (!state.study) return;
  const Study& study = *state.study;
  state.problem = failure_of([&] {
    state.count = trial_count(study);
    state.minutes = minutes_of(study);
    state.trials = state.participant.empty() ? all_trials(study) : trials_of(study, state.participant);
  });
  state.gone = failure_of([&] { check_files(study); });
  if (!state.problem.empty()) state.trials.clear();
}

}  // namespace understudy::app
