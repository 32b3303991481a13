#include "retarget/keypoints/json_points.hpp"

#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

constexpr int kDeepestPoses = 32;
constexpr uint64_t kMostMemory = uint64_t{6} << 30;
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

/// What a parsed value takes at most: a number in a list that grows, a list, an entry of a map.
uint64_t parsed_size(std::string_view text) {
  uint64_t size = text.size();
  for (const char c : text) size += c == ',' ? 32 : c == ':' ? 120 : c == '[' || c == '{' ? 80 : 0;
  return size;
}

/// NaN, Infinity and -Infinity outside of strings as null.
std::string without_nan(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\' && i + 1 < text.size()) {
      out += c;
      out += text[++i];
      continue;
    }
    if (c == '"') in_string = !in_string;
    const std::string_view rest = text.substr(i);
    const size_t skipped = in_string                        ? 0
                           : starts_with(rest, "NaN")       ? 3
                           : starts_with(rest, "Infinity")  ? 8
                           : starts_with(rest, "-Infinity") ? 9
                                                            : 0;
    if (skipped > 0) {
      out += "null";
      i += skipped - 1;
    } else {
      out += c;
    }
  }
  return out;
}

float coordinate(const PoseJson& json, const std::string& what) {
  US_CHECK(!json.is_string(), what, ": has text where numbers belong");
  US_CHECK(json.is_number() || json.is_null(), what, ": has something else where numbers belong");
  return json.is_null() ? kNotANumber : narrow(json.get<double>());
}

ListedPoints points_of_numbers(const PoseJson& list, const std::string& what) {
  US_CHECK(list.size() % 3 == 0, what, ": ", list.size(),
           " numbers do not make points of x, y and confidence");
  ListedPoints out;
  out.rows.resize(static_cast<Eigen::Index>(list.size() / 3), 3);
  float* at = out.rows.data();
  for (const PoseJson& value : list) *at++ = coordinate(value, what);
  return out;
}

ListedPoints points_of_lists(const PoseJson& list, const std::string& what) {
  ListedPoints out;
  out.rows.resize(static_cast<Eigen::Index>(list.size()), 3);
  const size_t width = list_of(&list.front())->size();
  US_CHECK(width >= 2 && width <= 4, what, ": a point of ", width,
           " numbers is neither x, y nor x, y, confidence");
  out.has_confidence = width > 2;
  Eigen::Index row = 0;
  for (const PoseJson& item : list) {
    const PoseJson* const point = list_of(&item);
    US_CHECK(point && point->size() == width, what, ": its points are not all of ", width, " numbers");
    out.rows.row(row++) << coordinate((*point)[0], what), coordinate((*point)[1], what),
        width > 2 ? coordinate(point->back(), what) : 1;  // of four the third is a depth
  }
  return out;
}

ListedPoints points_of_objects(const PoseJson& list, const std::string& what) {
  ListedPoints out;
  out.rows.resize(static_cast<Eigen::Index>(list.size()), 3);
  Eigen::Index row = 0;
  out.has_confidence = false;
  for (const PoseJson& item : list) {
    const PoseJson* const x = member(item, {"x", "X"});
    const PoseJson* const y = member(item, {"y", "Y"});
    US_CHECK(x && y, what, ": a point has no x and y");
    const PoseJson* const c = member(item, {"visibility", "score", "confidence", "c"});
    out.has_confidence = out.has_confidence || c;
    out.rows.row(row++) << coordinate(*x, what), coordinate(*y, what), c ? coordinate(*c, what) : 1;
    if (const std::string name = text_of(member(item, {"name"})); !name.empty()) out.names.push_back(name);
  }
  if (out.names.size() != list.size()) out.names.clear();
  return out;
}

}  // namespace

PoseJson parse_pose_json(std::string_view text, const std::string& source) {
  if (starts_with(text, "\xEF\xBB\xBF")) text.remove_prefix(3);
  US_CHECK(trim_end(text).size() > 0, source, ": is empty");
  US_CHECK(json_depth(text) <= kDeepestPoses, source, ": its JSON is nested more than ", kDeepestPoses,
           " levels deep");
  US_CHECK(parsed_size(text) <= kMostMemory, source,
           ": is too large, its JSON would take more than 6 GiB of memory");
  PoseJson json = PoseJson::parse(text.begin(), text.end(), nullptr, false);
  const bool may_be_python = text.find("NaN") != text.npos || text.find("Infinity") != text.npos;
  if (json.is_discarded() && may_be_python) json = PoseJson::parse(without_nan(text), nullptr, false);
  const size_t begin = text.find_first_not_of(" \t\r\n");
  const bool looks_so = begin != text.npos && (text[begin] == '{' || text[begin] == '[');
  US_CHECK(!json.is_discarded(), source, looks_so ? ": its JSON is broken or cut off" : ": is no JSON");
  return json;
}

const PoseJson* member(const PoseJson& json, std::initializer_list<const char*> names) {
  if (!json.is_object()) return nullptr;
  for (const char* name : names)
    if (const auto found = json.find(name); found != json.end()) return &*found;
  return nullptr;
}

const PoseJson* list_of(const PoseJson* json) {
  if (json && json->is_object()) json = member(*json, {"__ndarray__"});
  return json && json->is_array() ? json : nullptr;
}

std::optional<double> number_of(const PoseJson* json) {
  if (!json || !json->is_number()) return {};
  return json->get<double>();
}

std::optional<int64_t> whole_of(const PoseJson* json) {
  if (!json) return {};
  int64_t value = 0;
  if (json->is_string() && parse_integer(json->get_ref<const std::string&>(), value))
    return whole(static_cast<double>(value));
  if (!json->is_number()) return {};
  return whole(json->get<double>());
}

std::string text_of(const PoseJson* json) {
  return json && json->is_string() ? json->get<std::string>() : "";
}

Canvas canvas_of(const PoseJson* width, const PoseJson* height) {
  const auto w = whole_of(width), h = whole_of(height);
  const bool good = w && h && *w > 0 && *h > 0 && *w <= kLargestCanvas && *h <= kLargestCanvas;
  return good ? Canvas{static_cast<int>(*w), static_cast<int>(*h)} : Canvas{};
}

ListedPoints points_of(const PoseJson* json, const std::string& what) {
  if (!json || json->is_null()) return {};
  const PoseJson* const list = list_of(json);
  US_CHECK(list, what, json->is_string() ? ": has text where numbers belong" : ": its points are no list");
  if (list->empty()) return {};
  const PoseJson& first = list->front();
  if (list_of(&first)) return points_of_lists(*list, what);
  if (first.is_object()) return points_of_objects(*list, what);
  return points_of_numbers(*list, what);
}

}  // namespace understudy
