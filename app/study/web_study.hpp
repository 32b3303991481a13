// A study as a folder for browsers: the page of assets/study_web, the study's data and its clips.
#pragma once

#include <string>
#include <vector>

#include "app/study/trials.hpp"

namespace understudy::app {

struct WebStudyOptions {
  std::string page;      ///< folder of the page's own files
  std::string clips;     ///< folder that `study stimuli` wrote; it may be `out` itself
  std::string out;       ///< made where it is not there; other files in it stay
  int participants = 0;  ///< P01, P02 and so on; 0: as many as the plan says
};

/// "P07" of 7.
std::string web_participant(int number);

/// The script that holds all that the page knows of the study: texts, and the trials of P01 to the last one,
/// in the order of trials_of(). Right answers are not in it. `path` is the study's file. Throws Error as
/// trials_of().
std::string web_data(const Study& study, const std::string& path, int participants);

/// "clips/NAME.mp4" of all that they see, in the order in which they are first seen. Throws Error as
/// trials_of().
std::vector<std::string> web_clips(const Study& study, int participants);

/// Writes the folder; the same study gives the same bytes. Throws Error, one sentence: a clip is not there,
/// or is of the study before it was changed, with the command that makes it; a folder or file cannot be
/// written. data.js is written last: without it the page says that it is not complete.
void write_web_study(const Study& study, const std::string& path, const WebStudyOptions& options);

}  // namespace understudy::app
