#include "app/run/gap_plan.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"

namespace understudy::app {

std::vector<int> window_starts(const GapPlan& plan) {
  std::vector<int> starts;
  int first = 0;  // of the stretch
  const auto add = [&](int end) {
    for (int start = first; start + plan.window() <= end; start += plan.every) starts.push_back(start);
    first = end + 1;
  };
  for (const int bad : plan.bad_frames) add(bad);
  add(plan.frames);
  return starts;
}

std::vector<bool> known_frames(const GapPlan& plan) {
  std::vector<bool> known(static_cast<size_t>(plan.frames), true);
  int next = 0;  // gaps may overlap
  for (const int start : window_starts(plan)) {
    const int first = start + plan.ends, end = first + plan.gap;
    for (next = std::max(next, first); next < end; ++next) known[static_cast<size_t>(next)] = false;
  }
  return known;
}

std::optional<GapPlan> gap_plan(const nlohmann::json& json, const std::string& path) {
  if (!json.contains("gap")) return std::nullopt;
  const auto number = [&](const char* key, int least) {
    US_CHECK(json.contains(key) && json[key].is_number_integer(), path, ": \"", key,
             "\" is not a whole number");
    const int64_t value = json[key].get<int64_t>();
    US_CHECK(value >= least && value <= 1000000, path, ": \"", key, "\" is ", value);
    return static_cast<int>(value);
  };
  GapPlan plan{number("frames", 1), number("gap", 1), number("ends", 0), number("every", 1), {}};
  if (json.contains("bad_frames")) {
    US_CHECK(json["bad_frames"].is_array(), path, ": \"bad_frames\" is not a list of numbers");
    for (const auto& bad : json["bad_frames"]) {
      US_CHECK(bad.is_number_integer(), path, ": \"bad_frames\" is not a list of numbers");
      const int64_t frame = bad.get<int64_t>();
      US_CHECK(
          frame >= 0 && frame < plan.frames && (plan.bad_frames.empty() || frame > plan.bad_frames.back()),
          path, ": \"bad_frames\" must rise from 0 to less than ", plan.frames);
      plan.bad_frames.push_back(static_cast<int>(frame));
    }
  }
  US_CHECK(plan.ends > 0, path, ": no frame beside a gap is known");
  US_CHECK(!window_starts(plan).empty(), path, ": a gap of ", plan.gap, " frames between ", plan.ends,
           " known ones on each side is longer than the sequence of ", plan.frames);
  return plan;
}

}  // namespace understudy::app
