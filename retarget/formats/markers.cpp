#include "retarget/formats/markers.hpp"

#include <cmath>
#include <map>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/csv_lines.hpp"

namespace understudy {
namespace {

constexpr double kLongestPause_s = 3600;
constexpr int64_t kLastFrame = 100000000;
constexpr size_t kLeastMarkers = 3;

/// Which of the two kinds of table the first line begins.
bool is_by_frame(CsvLines& lines, const std::string& path) {
  auto head = lines.next();
  US_CHECK(head, path, ": holds no markers");
  for (std::string& cell : *head) cell = lower_case(cell);
  const std::vector<std::string> after = {"name", "x", "y", "z"};
  US_CHECK(head->size() == 5 && std::vector<std::string>(head->begin() + 1, head->end()) == after &&
               ((*head)[0] == "seconds" || (*head)[0] == "frame"),
           lines.where(), ": names no columns: seconds,name,x,y,z or frame,name,x,y,z");
  return (*head)[0] == "frame";
}

double frame_seconds(const std::string& cell, double fps, const std::string& where) {
  int64_t frame = 0;
  US_CHECK(parse_integer(cell, frame) && frame >= 0 && frame <= kLastFrame, where, ": '", excerpt(cell),
           "' is no frame");
  return static_cast<double>(frame) / fps;
}

double finite_number(const std::string& cell, const char* what, const std::string& where) {
  double value = 0;
  US_CHECK(parse_number(cell, value) && std::isfinite(value), where, ": '", excerpt(cell), "' is no ", what);
  return value;
}

struct Row {
  Vec3 place;
  int64_t line;
};

}  // namespace

std::vector<MarkerFrame> read_markers(const std::string& path, double fps) {
  US_CHECK(fps > 0, path, ": its frames are ", fps, " a second");
  CsvLines lines(path);
  const bool by_frame = is_by_frame(lines, path);
  std::map<double, std::map<std::string, Row>> moments;
  std::set<std::string> names;
  while (const auto cells = lines.next()) {
    const std::string where = lines.where();
    US_CHECK(cells->size() == 5, where, ": has ", cells->size(), " cells in place of five");
    const double seconds = by_frame ? frame_seconds((*cells)[0], fps, where)
                                    : finite_number((*cells)[0], "time in seconds", where);
    const std::string& name = (*cells)[1];
    US_CHECK(!name.empty(), where, ": names no marker");
    Row row{Vec3::Zero(), lines.number()};
    for (int axis = 0; axis < 3; ++axis)
      row.place[axis] = static_cast<float>(finite_number((*cells)[2 + axis], "coordinate", where));
    US_CHECK(row.place.allFinite(), where, ": its place is too far away");
    const auto [before, is_new] = moments[seconds].emplace(name, row);
    US_CHECK(is_new, where, ": has '", excerpt(name), "' again, at the time of line ", before->second.line);
    names.insert(name);
  }
  US_CHECK(names.size() >= kLeastMarkers, path, ": has ", names.size(),
           names.size() == 1 ? " marker" : " markers", "; three at least tell where somebody is");
  std::vector<MarkerFrame> frames;
  for (const auto& [seconds, markers] : moments) {
    US_CHECK(frames.empty() || seconds - frames.back().seconds < kLongestPause_s,
             in_line(path, markers.begin()->second.line), ": is an hour or more after the markers before it");
    MarkerFrame& frame = frames.emplace_back();
    frame.seconds = seconds;
    for (const auto& [name, row] : markers) frame.markers.push_back({name, row.place});
  }
  return frames;
}

void write_markers(const std::string& path, const std::vector<MarkerFrame>& frames) {
  std::string text = "seconds,name,x,y,z\n";
  for (const MarkerFrame& frame : frames)
    for (const Marker& marker : frame.markers) {
      text += printed("%.9g,", frame.seconds) + csv_cell(marker.name);
      for (const float x : marker.place) {
        text += ',';
        append_exact(text, x);
      }
      text += '\n';
    }
  write_file(path, text);
}

}  // namespace understudy
