// What a study file says of the analysis of its answers.
#pragma once

#include "app/study/analysis.hpp"
#include "app/study/study.hpp"

namespace understudy::app {

/// The questions with their scales, those of attention, the rule of exclusion, and the factors of the design
/// that have several levels: condition, motion, target. Where participants see a subset of the trials, or
/// rate only every nth, the conditions alone are compared. Left out are choices between more than two
/// options, which have no order. Where trials show two results, only choices between two options count, the
/// first of them for the left result. Throws Error where nothing is left.
AnalysisOptions analysis_options(const Study& study);

/// The answers that count: those of practice trials are left out. `folder`: of the study's file. Throws Error
/// naming the file where its answers are of another design, and what has changed since; naming file and line
/// where an answer is of a condition, motion, target or question that the study does not have; where the
/// answers have no such column. Where trials show two results, each answer gets its pair as a factor, and
/// names the condition that was chosen, as AnalysisOptions::pairs wants it.
StudyAnswers counted_answers(StudyAnswers answers, const Study& study, const std::string& folder);

/// Throws Error naming `path` where answers to this design, as the file says, are not answers to the study as
/// it is now.
void check_design(const std::string& path, const std::string& design, const Study& study,
                  const std::string& folder);

}  // namespace understudy::app
