#include "app/study/trials.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr double kAnswer_s = 5, kBreak_s = 60;

/// One condition or a pair of them: what a trial shows of the factor that is studied.
struct Shown {
  int condition = 0, other = -1;
};

std::vector<Shown> all_shown(const Study& study) {
  std::vector<Shown> all;
  const int count = static_cast<int>(study.conditions.size());
  for (int a = 0; a < count; ++a) {
    if (study.layout.results == TrialResults::One) all.push_back({a, -1});
    for (int b = a + 1; b < count && study.layout.results == TrialResults::Pair; ++b) all.push_back({a, b});
  }
  return all;
}

int shown_count(const Study& study) {
  const int count = static_cast<int>(study.conditions.size());
  return study.layout.results == TrialResults::One ? count : count * (count - 1) / 2;
}

/// All but the condition: a motion on a target, once for each repetition.
int cell_count(const Study& study) {
  return study.plan.repetitions * static_cast<int>(study.motions.size() * study.targets.size());
}

/// Makes trials by the number of their cell and of what they show.
class TrialMaker {
 public:
  explicit TrialMaker(const Study& study) : study_(study), shown_(all_shown(study)) {}

  Trial operator()(int cell, int shown) const {
    const int targets = static_cast<int>(study_.targets.size()),
              motions = static_cast<int>(study_.motions.size());
    Trial trial;
    trial.id = printed("t%03d", cell * static_cast<int>(shown_.size()) + shown + 1);
    trial.condition = shown_[shown].condition;
    trial.other = shown_[shown].other;
    trial.target = cell % targets;
    trial.motion = cell / targets % motions;
    trial.repetition = cell / targets / motions + 1;
    trial.questions.resize(study_.questions.size());
    std::iota(trial.questions.begin(), trial.questions.end(), 0);
    return trial;
  }

 private:
  const Study& study_;
  std::vector<Shown> shown_;
};

/// A row of Williams' square; of an odd number of conditions the second half are the first's rows reversed.
std::vector<int> latin_row(int count, int number) {
  std::vector<int> row;
  for (int column = 0; column < count; ++column) {  // 0, 1, n-1, 2, n-2 ...
    const int step = column % 2 != 0 ? (column + 1) / 2 : count - column / 2;
    row.push_back((number + step) % count);
  }
  if (number >= count) std::reverse(row.begin(), row.end());
  return row;
}

int latin_rows(int count) {
  return count % 2 == 0 ? count : 2 * count;
}

void shuffle(std::vector<int>& values, Rng& random) {
  for (int i = static_cast<int>(values.size()) - 1; i > 0; --i)
    std::swap(values[i], values[random.below(i + 1)]);
}

std::vector<int> counted(int count) {
  std::vector<int> values(count);
  std::iota(values.begin(), values.end(), 0);
  return values;
}

Rng random_of(const Study& study, const std::string& participant) {
  return Rng(fnv1a(std::to_string(study.plan.seed) + '\n' + participant));
}

/// From 0: the number that the name ends in, less one; else one by chance.
int participant_index(const Study& study, const std::string& participant) {
  constexpr int kMost = 1000000;
  size_t first = participant.size();
  while (first > 0 && std::isdigit(static_cast<unsigned char>(participant[first - 1])) != 0) --first;
  int64_t number = 0;
  const std::string_view digits = std::string_view(participant).substr(first);
  if (!digits.empty() && parse_integer(digits, number) && number >= 1 && number <= kMost)
    return static_cast<int>(number) - 1;
  return random_of(study, "order of " + participant).below(kMost);
}

/// In an order whose neighbours differ in motion and target, so that any stretch of it has all of them about
/// equally often.
std::vector<int> mixed_cells(const Study& study) {
  const int targets = static_cast<int>(study.targets.size()),
            motions = static_cast<int>(study.motions.size());
  std::vector<int> cells;
  for (int repetition = 0; repetition < study.plan.repetitions; ++repetition)
    for (int step = 0; step < targets; ++step)
      for (int motion = 0; motion < motions; ++motion)
        cells.push_back((repetition * motions + motion) * targets + (motion + step) % targets);
  return cells;
}

/// The cells that a participant sees in every condition: all, or the next stretch of a ring, so that
/// consecutive participants together see all equally often.
std::vector<int> cells_of(const Study& study, int participant) {
  const std::vector<int> ring = mixed_cells(study);
  const int count = trial_count(study) / shown_count(study);
  const int64_t start = static_cast<int64_t>(participant) * count;
  std::vector<int> cells(count);
  for (int i = 0; i < count; ++i) cells[i] = ring[(start + i) % static_cast<int64_t>(ring.size())];
  return cells;
}

/// Every second trial of a pair shows it the other way round; participants take turns.
void change_sides(Trial& trial, int turn) {
  if (trial.other >= 0 && turn % 2 != 0) std::swap(trial.condition, trial.other);
}

std::vector<Trial> shuffled_trials(const Study& study, int participant, Rng& random) {
  const std::vector<int> cells = cells_of(study, participant);
  const TrialMaker make(study);
  const int count = shown_count(study);
  std::vector<int> order = counted(static_cast<int>(cells.size()) * count);
  shuffle(order, random);
  std::vector<Trial> trials;
  for (const int i : order) {
    const int cell = i / count, shown = i % count;
    trials.push_back(make(cells[cell], shown));
    change_sides(trials.back(), cell + shown + participant);
  }
  return trials;
}

/// Blocks of all conditions, each in the order of a row of the square; cells are shuffled for each condition
/// alone, so that the trials of a block differ.
std::vector<Trial> latin_trials(const Study& study, int participant, Rng& random) {
  const TrialMaker make(study);
  const int count = shown_count(study);
  const std::vector<int> row = latin_row(count, participant % latin_rows(count));
  std::vector<std::vector<int>> cells(count, cells_of(study, participant));
  for (std::vector<int>& one : cells) shuffle(one, random);
  std::vector<Trial> trials;
  for (size_t block = 0; block < cells[0].size(); ++block)
    for (const int shown : row) {
      trials.push_back(make(cells[shown][block], shown));
      change_sides(trials.back(), static_cast<int>(block) + shown + participant);
    }
  return trials;
}

/// Keeps each question for every nth trial in one of each n trials, wherever chance puts it.
void spread_questions(const Study& study, std::vector<Trial>& trials, Rng& random) {
  for (Trial& trial : trials) trial.questions.clear();
  for (int q = 0; q < static_cast<int>(study.questions.size()); ++q) {
    const int every = study.questions[q].every, count = static_cast<int>(trials.size());
    for (int first = 0; first < count; first += every) {
      const int at = first + random.below(std::min(every, count - first));
      trials[at].questions.push_back(q);
    }
  }
}

/// Chosen at random, conditions in turn; all questions are practised.
std::vector<Trial> practice_trials(const Study& study, Rng& random) {
  const TrialMaker make(study);
  std::vector<int> turn = counted(shown_count(study));
  shuffle(turn, random);
  std::vector<Trial> trials;
  for (int i = 0; i < study.plan.practice; ++i) {
    trials.push_back(make(random.below(cell_count(study)), turn[i % turn.size()]));
    trials.back().id = printed("p%02d", i + 1);
    trials.back().is_practice = true;
  }
  return trials;
}

}  // namespace

std::vector<std::vector<int>> balanced_latin_square(int count) {
  US_CHECK(count >= 2, "a Latin square needs two conditions, not ", count);
  std::vector<std::vector<int>> rows;
  rows.reserve(latin_rows(count));
  for (int number = 0; number < latin_rows(count); ++number) rows.push_back(latin_row(count, number));
  return rows;
}

int trial_count(const Study& study) {
  check(study);
  const int shown = shown_count(study), all = shown * cell_count(study);
  const int wanted = study.plan.trials_per_participant;
  if (wanted == 0) return all;
  US_CHECK(wanted <= all, "trials_per_participant is ", wanted, ", the design has ", all);
  US_CHECK(wanted % shown == 0, "trials_per_participant is ", wanted, ": it must divide by ", shown,
           ", so that a participant sees every condition equally often");
  return wanted;
}

std::vector<Trial> all_trials(const Study& study) {
  trial_count(study);  // checks
  std::vector<Trial> trials;
  const TrialMaker make(study);
  for (int cell = 0; cell < cell_count(study); ++cell)
    for (int shown = 0; shown < shown_count(study); ++shown) trials.push_back(make(cell, shown));
  return trials;
}

std::vector<Trial> clip_trials(const Study& study) {
  std::vector<Trial> trials;
  for (Trial& trial : all_trials(study)) {
    if (trial.repetition > 1) break;
    trials.push_back(trial);
    if (trial.other < 0) continue;
    std::swap(trial.condition, trial.other);
    trials.push_back(std::move(trial));
  }
  return trials;
}

std::vector<Trial> trials_of(const Study& study, const std::string& participant) {
  US_CHECK(!participant.empty(), "a participant needs a name or a number");
  trial_count(study);  // checks
  Rng random = random_of(study, participant);
  const int index = participant_index(study, participant);
  std::vector<Trial> trials = study.plan.order == TrialOrder::Random ? shuffled_trials(study, index, random)
                                                                     : latin_trials(study, index, random);
  spread_questions(study, trials, random);
  const std::vector<Trial> practice = practice_trials(study, random);
  trials.insert(trials.begin(), practice.begin(), practice.end());
  return trials;
}

double minutes_of(const Study& study) {
  double trial_s = study.clip.seconds, practice_s = study.clip.seconds;
  for (const StudyQuestion& question : study.questions) {
    trial_s += kAnswer_s / question.every;
    practice_s += kAnswer_s;
  }
  const int trials = trial_count(study), every = study.plan.break_every;
  const int breaks = every > 0 ? (trials - 1) / every : 0;
  return (trials * trial_s + study.plan.practice * practice_s + breaks * kBreak_s) / 60;
}

std::string size_in_words(const Study& study) {
  const int trials = trial_count(study);
  const double minutes = std::max(1.0, std::round(minutes_of(study)));
  std::string text = std::to_string(trials) + (trials == 1 ? " trial" : " trials");
  if (study.plan.practice > 0) text += printed(" and %d of practice", study.plan.practice);
  return text + printed(", about %.0f %s a participant", minutes, minutes > 1 ? "minutes" : "minute");
}

std::string clip_name(const Study& study, const Trial& trial) {
  uint64_t hash = fnv1a(std::to_string(study.plan.seed));
  const auto add = [&hash](const std::string& part) { hash = fnv1a(part + '\n', hash); };
  add(study.conditions[trial.condition].name);
  if (trial.other >= 0) add(study.conditions[trial.other].name);
  add(study.motions[trial.motion].name);
  add(study.targets[trial.target].name);
  return checksum_text(hash);
}

}  // namespace understudy::app
