#include "app/study/answers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr std::array kColumns{"participant", "trial", "question", "answer", "rt_ms", "replays", "shown_at"};
constexpr const char* kDesign = "design";
constexpr uint64_t kMostBytes = uint64_t{64} << 20;

/// The file's lines with their numbers, for messages.
class Lines {
 public:
  explicit Lines(const std::string& path) : path_(path), text_(read_file(path, kMostBytes)) {
    US_CHECK(!text_.empty(), path, ": is empty");
    const auto count = std::count(text_.begin(), text_.end(), '\n');
    US_CHECK(text_.back() == '\n', path, ": is cut off in line ", count + 1, ", which has no line end");
    if (starts_with(text_, "\xef\xbb\xbf")) at_ = 3;  // spreadsheets write a byte order mark
  }
  bool at_end() const { return at_ >= text_.size(); }
  size_t number() const { return number_; }
  std::string where() const { return path_ + ": line " + std::to_string(number_); }
  std::vector<std::string> cells() {
    const size_t end = text_.find('\n', at_);
    std::string line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    try {
      return csv_cells(line);
    } catch (const std::invalid_argument&) {
      throw Error(where() + " is cut off: a quote is not closed");
    }
  }

 private:
  std::string path_, text_;
  size_t at_ = 0, number_ = 0;
};

std::vector<std::string> factors_in(const std::vector<std::string>& header, const std::string& path) {
  for (size_t c = 0; c < kColumns.size(); ++c)
    US_CHECK(c < header.size() && header[c] == kColumns[c], path, ": column ", c + 1, " should be \"",
             kColumns[c], "\", but is \"", c < header.size() ? excerpt(header[c]) : "", "\"");
  std::vector<std::string> factors(header.begin() + kColumns.size(), header.end());
  std::set<std::string> names;
  for (const std::string& name : factors)
    US_CHECK(!name.empty() && names.insert(name).second, path, ": the factor \"", excerpt(name),
             name.empty() ? "\" has no name" : "\" is there twice");
  return factors;
}

StudyAnswer answer_from(std::vector<std::string> cells, const Lines& lines) {
  StudyAnswer one;
  one.line = lines.number();
  one.trial = cells[1], one.question = cells[2], one.answer = cells[3], one.shown_at = cells[6];
  US_CHECK(!one.trial.empty() && !one.question.empty(), lines.where(), " names no trial or no question");
  one.rt_ms = std::numeric_limits<double>::quiet_NaN();
  if (!cells[4].empty())
    US_CHECK(parse_number(cells[4], one.rt_ms) && std::isfinite(one.rt_ms) && one.rt_ms >= 0, lines.where(),
             ": rt_ms \"", excerpt(cells[4]), "\" is not a time in milliseconds");
  int64_t replays = 0;
  if (!cells[5].empty())
    US_CHECK(parse_integer(cells[5], replays) && replays >= 0 && replays <= 1000000, lines.where(),
             ": replays \"", excerpt(cells[5]), "\" is not a count");
  one.replays = static_cast<int>(replays);
  one.levels.assign(std::make_move_iterator(cells.begin() + kColumns.size()),
                    std::make_move_iterator(cells.end()));
  return one;
}

}  // namespace

size_t column_of(const StudyAnswers& answers, const std::string& factor) {
  const auto at = std::find(answers.factors.begin(), answers.factors.end(), factor);
  US_CHECK(at != answers.factors.end(), "the answers have no column \"", factor, "\"");
  return static_cast<size_t>(at - answers.factors.begin());
}

std::string place_of(const ParticipantAnswers& participant, const StudyAnswer& answer) {
  return participant.path + ": line " + std::to_string(answer.line);
}

ParticipantAnswers read_participant(const std::string& path, std::vector<std::string>& factors) {
  Lines lines(path);
  ParticipantAnswers read;
  read.path = path;
  factors = factors_in(lines.cells(), path);
  const bool has_design = !factors.empty() && factors.back() == kDesign;
  if (has_design) factors.pop_back();
  const size_t columns = kColumns.size() + factors.size() + has_design;
  std::map<std::pair<std::string, std::string>, size_t> seen;
  while (!lines.at_end()) {
    std::vector<std::string> cells = lines.cells();
    US_CHECK(cells.size() >= columns, lines.where(), " is cut off: it has ", cells.size(),
             " columns, the header ", columns);
    US_CHECK(cells.size() == columns, lines.where(), " has ", cells.size(), " columns, the header ", columns);
    US_CHECK(!cells[0].empty(), lines.where(), " names no participant");
    if (read.participant.empty()) read.participant = cells[0];
    US_CHECK(cells[0] == read.participant, lines.where(), " is of participant \"", excerpt(cells[0]),
             "\" in the file of \"", excerpt(read.participant), "\"");
    if (has_design) {
      if (read.answers.empty()) read.design = cells.back();
      cells.pop_back();
    }
    StudyAnswer one = answer_from(std::move(cells), lines);
    const auto [before, is_new] = seen.emplace(std::make_pair(one.trial, one.question), one.line);
    US_CHECK(is_new, lines.where(), " answers \"", excerpt(one.question), "\" of trial ", excerpt(one.trial),
             " again, after line ", before->second);
    read.answers.push_back(std::move(one));
  }
  US_CHECK(!read.answers.empty(), path, ": has no answers");
  return read;
}

StudyAnswers read_answers(const std::string& folder) {
  US_CHECK(fs::is_directory(folder), folder, ": is not a folder of answers");
  std::vector<std::string> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (file_suffix(entry.path().string()) == ".csv") paths.push_back(entry.path().string());
  US_CHECK(!paths.empty(), folder, ": has no .csv files of answers");
  std::sort(paths.begin(), paths.end());

  StudyAnswers all;
  std::map<std::string, std::string> files;
  for (const std::string& path : paths) {
    std::vector<std::string> factors;
    ParticipantAnswers one = read_participant(path, factors);
    if (all.participants.empty()) all.factors = factors;
    US_CHECK(factors == all.factors, path, ": line 1 has other factors than ", paths.front());
    const auto [before, is_new] = files.emplace(one.participant, path);
    US_CHECK(is_new, path, ": line 2 is of participant \"", excerpt(one.participant),
             "\", whose answers are in ", before->second, " too");
    all.participants.push_back(std::move(one));
  }
  std::sort(all.participants.begin(), all.participants.end(),
            [](const auto& a, const auto& b) { return a.participant < b.participant; });
  return all;
}

}  // namespace understudy::app
