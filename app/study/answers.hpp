// What the participants of a study answered: a folder of CSV files, one a participant.
//
// The first line names the columns: participant,trial,question,answer,rt_ms,replays,shown_at and then the
// factors of the trial, any number of them under any names (method, motion, ...). One line an answer, each
// with its line end. A text with a comma or a quote stands in quotes, a quote in it is doubled. rt_ms,
// replays and shown_at may be empty; an empty answer is a missing one. The last column may be "design": the
// digest of the study that was shown (see digest_of), on the first line of answers alone.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace understudy::app {

/// One line of the file.
struct StudyAnswer {
  std::string trial, question;
  std::string answer;  ///< a number or a text, as the question's scale wants it; empty: missing
  double rt_ms = 0;    ///< reaction time; NaN: not known
  int replays = 0;
  std::string shown_at;
  std::vector<std::string> levels;  ///< of the factors, in the order of StudyAnswers::factors
  size_t line = 0;                  ///< in the file, from 1
};

struct ParticipantAnswers {
  std::string participant, path;
  std::vector<StudyAnswer> answers;
  std::string design{};  ///< digest of the study that they saw; empty: not known
};

struct StudyAnswers {
  std::vector<std::string> factors;
  std::vector<ParticipantAnswers> participants;  ///< in the order of their names
};

/// One participant's file. Throws Error naming file and line: a line with too few or too many columns, a file
/// that is cut off, a number that is none, an answer given twice, a second participant.
ParticipantAnswers read_participant(const std::string& path, std::vector<std::string>& factors);
/// All .csv files of the folder. Throws Error also where there are none, where two files are of one
/// participant, or where files have other factors than the first.
StudyAnswers read_answers(const std::string& folder);

/// Where a factor's level stands in StudyAnswer::levels. Throws Error where the answers do not have it.
size_t column_of(const StudyAnswers& answers, const std::string& factor);

/// "FOLDER/P03.csv: line 12", for messages.
std::string place_of(const ParticipantAnswers& participant, const StudyAnswer& answer);

}  // namespace understudy::app
