#include "retarget/formats/scan_times.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/csv_lines.hpp"
#include "retarget/formats/scan_frames.hpp"

namespace understudy {
namespace {

constexpr double kLongestInterval_s = 3600, kHighestRate = 1000;

// "0.25 s", with all digits that tell it from others.
std::string in_seconds(double seconds) {
  return printed("%.12g s", seconds);
}

// Which scan a table means.
class Names {
 public:
  explicit Names(const std::vector<ScanName>& scans) : scans_(scans) {
    for (int64_t i = 0; i < ssize(scans); ++i) {
      by_number_.emplace(scans[i].number, i);
      const std::filesystem::path path(scans[i].path);
      if (path.empty()) continue;
      by_file_[path.filename().string()].push_back(i);
      by_stem_[path.stem().string()].push_back(i);
    }
  }

  /// Its position; none: no such scan is there.
  std::optional<int64_t> find(const ScanTime& row, const std::string& table) const {
    const std::string name = row.scan.substr(row.scan.find_last_of("/\\") + 1);
    for (const auto* names : {&by_file_, &by_stem_}) {
      const auto found = names->find(name);
      if (found != names->end()) return only(found->second, row, table);
    }
    int64_t number = 0;
    const auto found = parse_integer(row.scan, number) ? by_number_.find(number) : by_number_.end();
    if (found == by_number_.end()) return std::nullopt;
    return found->second;
  }

 private:
  // Of several files of one name in different folders the one in the row's.
  int64_t only(const std::vector<int64_t>& candidates, const ScanTime& row, const std::string& table) const {
    if (candidates.size() == 1) return candidates[0];
    std::vector<int64_t> there;
    for (const int64_t i : candidates) {
      const std::string &path = scans_[i].path, stem = path.substr(0, path.size() - file_suffix(path).size());
      if (path == row.scan || stem == row.scan || ends_with(path, "/" + row.scan) ||
          ends_with(stem, "/" + row.scan))
        there.push_back(i);
    }
    US_CHECK(there.size() == 1, in_line(table, row.line), ": '", excerpt(row.scan),
             "' may be any of several scans");
    return there[0];
  }

  const std::vector<ScanName>& scans_;
  std::unordered_map<std::string, std::vector<int64_t>> by_file_, by_stem_;
  std::unordered_map<int64_t, int64_t> by_number_;
};

std::string name_of(const ScanName& scan) {
  return scan.path.empty() ? "frame " + std::to_string(scan.number) : file_name(scan.path);
}

// The name of a file without folder, suffix and frame number.
std::string without_number(const std::string& path) {
  constexpr const char* kDigits = "0123456789";
  std::string stem = std::filesystem::path(path).stem().string();
  const size_t last = stem.find_last_of(kDigits);
  if (last == stem.npos) return stem;
  const size_t before = stem.find_last_not_of(kDigits, last);  // npos + 1 is 0
  return stem.erase(before + 1, last - before);
}

// "a, b, c and 5 more".
std::string listed(const std::vector<std::string>& names) {
  constexpr size_t kNamed = 5;
  std::string words;
  for (size_t i = 0; i < std::min(names.size(), kNamed); ++i) append_item(words, excerpt(names[i]));
  return words + (names.size() > kNamed ? " and " + std::to_string(names.size() - kNamed) + " more" : "");
}

// The rows with the scans that they are of.
class TimedScans {
 public:
  TimedScans(const std::string& table, const std::vector<ScanName>& scans)
      : table_(table), scans_(scans), rows_(read_scan_times(table)), row_of_(scans.size(), -1) {
    match();
    const auto unnamed = std::find(row_of_.begin(), row_of_.end(), -1);
    US_CHECK(unnamed == row_of_.end(), table_, ": has no time for ",
             name_of(scans_[unnamed - row_of_.begin()]));
    check_order();
    std::sort(rows_.begin(), rows_.end(), [](auto& a, auto& b) { return a.seconds < b.seconds; });
    check_intervals();
  }

  ScanPlaces placed(double fps) const {
    ScanPlaces out;
    out.clock.fps = fps > 0 ? fps : usual_rate();
    const ScanTime &first = rows_.front(), &last = rows_.back();
    const double steps = std::round((last.seconds - first.seconds) * out.clock.fps);
    US_CHECK(steps < static_cast<double>(kMostClockFrames), in_line(table_, last.line), ": is ",
             in_seconds(last.seconds - first.seconds), " after line ", first.line, ", at ",
             printed("%g", out.clock.fps), " frames/s more than ten million frames");
    out.frames = static_cast<int64_t>(steps) + 1;
    place(out);
    const int64_t gaps = out.frames - ssize(out.places);
    out.clock.sentence = table_ + ": " +
                         printed("%lld scans in %.2f s, %g frames/s", static_cast<long long>(ssize(scans_)),
                                 static_cast<double>(out.frames) / out.clock.fps, out.clock.fps) +
                         (gaps == 0   ? ""
                          : gaps == 1 ? ", 1 frame without a scan"
                                      : ", " + std::to_string(gaps) + " frames without a scan");
    return out;
  }

 private:
  void match() {
    const Names names(scans_);
    std::unordered_map<std::string, int64_t> missing;  // and the lines that name them
    seconds_of_.resize(scans_.size());
    std::vector<std::string> unknown;
    for (const ScanTime& row : rows_) {
      const auto scan = names.find(row, table_);
      const auto [before, is_new] =
          scan ? std::make_pair(row_of_[*scan], row_of_[*scan] < 0) : noted(missing, row);
      US_CHECK(is_new, in_line(table_, row.line), ": names '", excerpt(row.scan), "', as line ", before,
               " does");
      scan_of_.push_back(scan.value_or(-1));
      if (scan)
        row_of_[*scan] = row.line, seconds_of_[*scan] = row.seconds;
      else
        unknown.push_back(row.scan);
    }
    if (!unknown.empty())
      log::warn_once(table_ + ": has times of scans that are not there: " + listed(unknown));
  }
  // The line that has named it before, and whether none has.
  static std::pair<int64_t, bool> noted(std::unordered_map<std::string, int64_t>& missing,
                                        const ScanTime& row) {
    const auto [at, is_new] = missing.emplace(row.scan, row.line);
    return {at->second, is_new};
  }

  // Where in the sequence a row belongs, of a scan that is not there, too, where it is called as the first;
  // none: nothing tells.
  std::optional<int64_t> number_of(size_t row, bool names_tell) const {
    if (scan_of_[row] >= 0) return scans_[scan_of_[row]].number;
    const std::string& name = rows_[row].scan;
    int64_t number = 0;
    if (parse_integer(name, number)) return number;
    const bool is_alike = names_tell && without_number(name) == without_number(scans_[0].path);
    return is_alike ? frame_number(name) : std::nullopt;
  }

  // The sequence goes forward in time. The lines may be in any order, as those of an alphabet are.
  void check_order() const {
    const bool names_tell = std::all_of(scans_.begin(), scans_.end(), [](const ScanName& scan) {
      return !scan.path.empty() && frame_number(scan.path) == scan.number;
    });
    std::vector<std::pair<int64_t, size_t>> order;  // number, row
    for (size_t i = 0; i < rows_.size(); ++i)
      if (const auto number = number_of(i, names_tell)) order.emplace_back(*number, i);
    std::sort(order.begin(), order.end());
    for (size_t i = 1; i < order.size(); ++i) {
      const ScanTime &before = rows_[order[i - 1].second], &after = rows_[order[i].second];
      US_CHECK(after.seconds >= before.seconds, in_line(table_, after.line),
               ": the time falls: ", in_seconds(after.seconds), " of '", excerpt(after.scan), "' is before ",
               in_seconds(before.seconds), " of '", excerpt(before.scan), "' in line ", before.line);
    }
  }

  // rows_ are in the order of time.
  void check_intervals() const {
    for (size_t i = 1; i < rows_.size(); ++i) {
      const ScanTime &before = rows_[i - 1], &after = rows_[i];
      const int64_t line = std::max(before.line, after.line);
      US_CHECK(after.seconds > before.seconds, in_line(table_, line), ": has the time of line ",
               std::min(before.line, after.line), ", ", in_seconds(after.seconds));
      US_CHECK(after.seconds - before.seconds < kLongestInterval_s, in_line(table_, after.line), ": ",
               in_seconds(after.seconds), " is an hour or more after ", in_seconds(before.seconds),
               " in line ", before.line, "; times are in seconds");
    }
  }

  double usual_rate() const {
    constexpr double kNearly = 0.1;
    std::vector<double> intervals;
    for (size_t i = 1; i < rows_.size(); ++i) intervals.push_back(rows_[i].seconds - rows_[i - 1].seconds);
    const auto middle = intervals.begin() + (ssize(intervals) - 1) / 2;
    std::nth_element(intervals.begin(), middle, intervals.end());
    const double median = *middle;
    const auto is_other = [&](double s) { return std::abs(s - median) > kNearly * median; };
    const auto end = std::remove_if(intervals.begin(), intervals.end(), is_other);
    const double rate =
        static_cast<double>(end - intervals.begin()) / std::accumulate(intervals.begin(), end, 0.0);
    US_CHECK(rate <= kHighestRate, table_, ": its scans are ", in_seconds(median),
             " apart, less than a thousandth of a second; times are in seconds");
    const double whole = std::round(rate);
    return std::abs(rate - whole) < 1e-6 * rate ? whole : rate;
  }

  void place(ScanPlaces& out) const {
    const double first = rows_.front().seconds;
    const auto distance = [&](const ScanPlaces::Place& place) {
      return std::abs((seconds_of_[place.scan] - first) * out.clock.fps - static_cast<double>(place.frame));
    };
    std::vector<std::string> left_out;
    for (int64_t i = 0; i < ssize(scans_); ++i) {
      const ScanPlaces::Place here{std::llround((seconds_of_[i] - first) * out.clock.fps), i};
      if (out.places.empty() || out.places.back().frame < here.frame) {
        out.places.push_back(here);
        continue;
      }
      ScanPlaces::Place& there = out.places.back();
      const bool is_nearer = distance(here) < distance(there);
      left_out.push_back(name_of(scans_[is_nearer ? there.scan : i]));
      if (is_nearer) there = here;
    }
    if (!left_out.empty())
      log::warn_once(table_ + ": scans are left out, because others are nearer to their frames of " +
                     printed("%g", out.clock.fps) + " a second: " + listed(left_out));
  }

  const std::string& table_;
  const std::vector<ScanName>& scans_;
  std::vector<ScanTime> rows_;
  std::vector<int64_t> scan_of_;  // of each row in the order of the file; -1: it is not there
  std::vector<int64_t> row_of_;   // of each scan, the line; -1: none
  std::vector<double> seconds_of_;
};

// The frames of a clock: scans where they are placed, and gaps.
class ClockFrames : public ScanSource::Frames {
 public:
  ClockFrames(std::unique_ptr<ScanSource::Frames> scans, std::vector<int64_t> positions, ScanPlaces places,
              const std::string& source)
      : scans_(std::move(scans)),
        positions_(std::move(positions)),
        places_(std::move(places)),
        source_(source) {
    clock = places_.clock;
    int64_t next = 0;
    for (const ScanPlaces::Place& place : places_.places) {
      if (place.frame > next) gaps.push_back({next, place.frame - 1});
      next = place.frame + 1;
    }
    if (places_.frames > next) gaps.push_back({next, places_.frames - 1});
  }

  std::optional<ScanFrame> next() override {
    if (at_ == places_.frames) return {};
    const bool is_gap = next_ == places_.places.size() || places_.places[next_].frame != at_;
    if (is_gap) return missing_frame(source_, at_++);
    const int64_t position = positions_[places_.places[next_].scan];
    if (position != inner_) scans_->seek(position);
    inner_ = -1;  // where reading stops when it throws is not known
    std::optional<ScanFrame> frame = scans_->next();
    US_CHECK(frame, source_, ": ends before frame ", at_);
    inner_ = position + 1;
    ++next_;
    frame->number = at_++;
    return frame;
  }
  std::optional<int64_t> count() const override { return places_.frames; }
  void seek(int64_t frame) override {
    US_CHECK(frame >= 0 && frame < places_.frames, "there is no frame ", frame, " among ", places_.frames);
    at_ = frame;
    const auto before = [](const ScanPlaces::Place& place, int64_t at) { return place.frame < at; };
    const auto& all = places_.places;
    next_ = static_cast<size_t>(std::lower_bound(all.begin(), all.end(), frame, before) - all.begin());
  }

 private:
  std::unique_ptr<ScanSource::Frames> scans_;
  std::vector<int64_t> positions_;  // of the scans among the frames of scans_
  ScanPlaces places_;
  std::string source_;
  int64_t at_ = 0, inner_ = 0;  // the next frame of the clock, and that of scans_; -1: not known
  size_t next_ = 0;             // the first place from at_ on
};

}  // namespace

std::vector<ScanTime> read_scan_times(const std::string& path) {
  CsvLines lines(path);
  std::vector<ScanTime> rows;
  bool is_first = true;
  while (auto cells = lines.next()) {
    US_CHECK(cells->size() == 2, lines.where(), ": has ", cells->size(),
             cells->size() == 1 ? " column" : " columns", " in place of two, scan and seconds");
    const std::string& time = (*cells)[1];
    ScanTime row{(*cells)[0], 0, lines.number()};
    const bool is_number = parse_number(time, row.seconds);
    const bool is_header = is_first && !is_number && !time.empty();
    is_first = false;
    if (is_header) continue;
    US_CHECK(!row.scan.empty(), lines.where(), ": names no scan");
    US_CHECK(is_number && std::isfinite(row.seconds), lines.where(), ": '", excerpt(time),
             "' is no time in seconds");
    rows.push_back(std::move(row));
  }
  US_CHECK(!rows.empty(), path, ": holds no times");
  US_CHECK(rows.size() > 1, in_line(path, rows[0].line), ": is the only time; two at least tell a rate");
  return rows;
}

ScanPlaces place_scans(const std::string& table, const std::vector<ScanName>& scans, double fps) {
  return TimedScans(table, scans).placed(fps);
}

std::unique_ptr<ScanSource::Frames> clock_frames(std::unique_ptr<ScanSource::Frames> scans,
                                                 const std::string& source, const std::string& table,
                                                 double fps) {
  std::vector<ScanName> names;
  std::vector<int64_t> positions;
  const int64_t count = scans->count().value_or(0);
  for (int64_t i = 0; i < count; ++i) {
    std::optional<ScanName> scan = scans->scan(i);
    if (!scan) continue;
    names.push_back(std::move(*scan));
    positions.push_back(i);
  }
  ScanPlaces places = place_scans(table, names, fps);
  return std::make_unique<ClockFrames>(std::move(scans), std::move(positions), std::move(places), source);
}

}  // namespace understudy
