// Lists of trials as text: for people, for spreadsheets, and for other programs that run studies.
#pragma once

#include <string>
#include <vector>

#include "app/study/trials.hpp"

namespace understudy::app {

/// condition, other, motion, target, repetition, practice: the columns of an answers file after those of the
/// answer.
const std::vector<std::string>& trial_factor_names();
/// Their values; of a single result `other` is empty, practice is 1 or 0.
std::vector<std::string> trial_factors(const Study& study, const Trial& trial);

/// Where other runners look for the clip of a trial: "clips/NAME.mp4" beside the list.
std::string clip_path(const Study& study, const Trial& trial);

/// Columns for reading, one line a trial.
std::string trials_as_table(const Study& study, const std::vector<Trial>& trials);
/// position, trial, practice (1 or 0), every factor, the clip, and the questions that are asked.
std::string trials_as_csv(const Study& study, const std::vector<Trial>& trials);
/// A conditions file of PsychoPy: the same factors, and for each question columns q1_name, q1_ask, q1_kind
/// ...
std::string trials_for_psychopy(const Study& study, const std::vector<Trial>& trials);
/// A timeline as jsPsych reads it, after its plug-ins have been put in place of their names: a video a trial,
/// then its questions, and the breaks; "data" of each has the trial, its factors and the right answer.
/// jsPsych counts the points of a scale from 0: an answer is its number plus 1.
std::string trials_for_jspsych(const Study& study, const std::vector<Trial>& trials);

/// One of them, for those who choose.
struct TrialFormat {
  const char *name, *label;  ///< "jspsych" in commands and options, "jsPsych timeline" on the screen
  const char* suffix;        ///< of its file
  std::string (*text)(const Study& study, const std::vector<Trial>& trials);
};
const std::vector<TrialFormat>& trial_formats();
/// Throws Error with the names that there are.
const TrialFormat& trial_format(const std::string& name);

}  // namespace understudy::app
