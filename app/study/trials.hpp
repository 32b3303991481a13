// The trials of a study: all of the design, and those of a participant in their order.
#pragma once

#include <string>
#include <vector>

#include "app/study/study.hpp"

namespace understudy::app {

/// One screen and its questions. Indices are those of the study's lists.
struct Trial {
  std::string id;     ///< "t001" of the design, whoever sees it and when; "p01" of practice
  int condition = 0;  ///< the left one of a pair
  int other = -1;     ///< the right one of a pair; -1: one result alone
  int motion = 0, target = 0;
  int repetition = 1;  ///< from 1
  bool is_practice = false;
  std::vector<int> questions{};  ///< asked in it, in the study's order
};

/// Williams' Latin square: a row for each order, each a permutation of 0 .. count-1. In every column each
/// occurs equally often, and each follows each other one equally often (Williams 1949): `count` rows when it
/// is even, twice as many when it is odd. Throws Error below 2.
std::vector<std::vector<int>> balanced_latin_square(int count);

/// Every trial of the design once, in the order of repetitions, motions, targets, conditions. All questions
/// are listed, those of every nth trial too. Throws Error as check(), and where a balanced subset does not
/// divide by the conditions.
std::vector<Trial> all_trials(const Study& study);

/// What a participant sees: practice, then all trials or the balanced subset, in an order that depends on the
/// study's seed and the participant alone and is the same on every machine. Pairs change sides, so that each
/// condition of a pair is left as often as right. Of a question for every nth trial each n trials in a row
/// have one. A participant whose name ends in a number from 1 has that row of the Latin square and that
/// subset: consecutive numbers are balanced; other names get theirs by chance. Throws Error for an empty name
/// and as all_trials().
std::vector<Trial> trials_of(const Study& study, const std::string& participant);

/// One trial for each clip: all of the design without repetitions, pairs both ways round; those of one motion
/// on one target one after the other. Throws Error as all_trials().
std::vector<Trial> clip_trials(const Study& study);

/// How many trials a participant sees, practice left out. Throws Error as all_trials().
int trial_count(const Study& study);
/// How long a participant is busy: clips, answers (5 s a question), breaks (60 s), practice too. Throws Error
/// as all_trials().
double minutes_of(const Study& study);
/// Both: "45 trials and 3 of practice, about 21 minutes a participant".
std::string size_in_words(const Study& study);

/// Of the clip of a trial: 16 hexadecimal digits that tell nothing of the condition; repetitions share it.
std::string clip_name(const Study& study, const Trial& trial);

}  // namespace understudy::app
