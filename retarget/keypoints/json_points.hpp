// JSON of pose files: parsed within bounds, and the ways in which it lists points.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "retarget/keypoints/raw_people.hpp"

namespace understudy {

using PoseJson = nlohmann::json;

/// NaN and Infinity, which Python writes, become null. Throws Error, naming `source`, when it is no JSON, cut
/// off, nested deeper than anybody writes it, or would take more memory than 6 GiB.
PoseJson parse_pose_json(std::string_view text, const std::string& source);

/// The member of an object; null when it is none or has none of the names.
const PoseJson* member(const PoseJson& json, std::initializer_list<const char*> names);
/// A list's items, or those of a `__ndarray__` that json_tricks wraps around one; null for anything else.
const PoseJson* list_of(const PoseJson* json);
std::optional<double> number_of(const PoseJson* json);
/// A whole number up to 9e15, -1 beyond; also one in text ("12").
std::optional<int64_t> whole_of(const PoseJson* json);
std::string text_of(const PoseJson* json);
Canvas canvas_of(const PoseJson* width, const PoseJson* height);

/// Points of a person: x, y, c, x, y, c ... in one list, a list of two to four numbers each (of four the
/// third is a depth), or objects of x, y and visibility (score, confidence). null is NaN; no list at all:
/// no rows. Throws Error when there is text or anything else in place of numbers, or the numbers do not
/// make points.
struct ListedPoints {
  FlatPoints rows = FlatPoints(0, 3);
  bool has_confidence = true;
  std::vector<std::string> names;  ///< of objects that have a `name`
};
ListedPoints points_of(const PoseJson* json, const std::string& what);

}  // namespace understudy
