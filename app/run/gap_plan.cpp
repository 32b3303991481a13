#include "app/run/gap_plan.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

int whole_number(const nlohmann::json& json, const char* key, int least, const std::string& path) {
  US_CHECK(json.contains(key) && json[key].is_number_integer(), path, ": \"", key,
           "\" is not a whole number");
  const int64_t value = json[key].get<int64_t>();
  US_CHECK(value >= least && value <= 1000000, path, ": \"", key, "\" is ", value);
  return static_cast<int>(value);
}

/// Rising numbers of frames; none where the key is missing.
std::vector<int> frame_list(const nlohmann::json& json, const char* key, int frames,
                            const std::string& path) {
  std::vector<int> list;
  if (!json.contains(key)) return list;
  US_CHECK(json[key].is_array(), path, ": \"", key, "\" is not a list of numbers");
  for (const auto& one : json[key]) {
    US_CHECK(one.is_number_integer(), path, ": \"", key, "\" is not a list of numbers");
    const int64_t frame = one.get<int64_t>();
    US_CHECK(frame >= 0 && frame < frames && (list.empty() || frame > list.back()), path, ": \"", key,
             "\" must rise from 0 to less than ", frames);
    list.push_back(static_cast<int>(frame));
  }
  return list;
}

}  // namespace

std::vector<int> window_starts(const GapPlan& plan) {
  if (plan.is_whole()) return {0};
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

std::vector<bool> window_known(const GapPlan& plan) {
  std::vector<bool> known(static_cast<size_t>(plan.window()), !plan.is_whole());
  for (const int t : plan.known_alone) known[static_cast<size_t>(t)] = true;
  if (!plan.is_whole()) std::fill_n(known.begin() + plan.before, plan.gap, false);
  return known;
}

std::vector<bool> known_frames(const GapPlan& plan) {
  if (plan.is_whole()) return window_known(plan);
  std::vector<bool> known(static_cast<size_t>(plan.frames), true);
  int next = 0;  // gaps may overlap
  for (const int start : window_starts(plan)) {
    const int first = start + plan.before, end = first + plan.gap;
    for (next = std::max(next, first); next < end; ++next) known[static_cast<size_t>(next)] = false;
  }
  return known;
}

std::vector<int> evenly_known(int frames, int count) {
  US_CHECK(count >= 2 && count <= frames, "of ", frames, " frames ", count,
           " are to be known: 2 at least, and no more than all");
  std::vector<int> known;
  known.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i)
    known.push_back(static_cast<int>(std::lround(static_cast<double>(i) * (frames - 1) / (count - 1))));
  return known;
}

std::optional<GapPlan> gap_plan(const nlohmann::json& json, const std::string& path) {
  const auto number = [&](const char* key, int least) { return whole_number(json, key, least, path); };
  GapPlan plan;
  if (json.contains("known")) {
    plan.frames = number("frames", 1);
    plan.known_alone = frame_list(json, "known", plan.frames, path);
    US_CHECK(plan.is_whole(), path, ": \"known\" names no frame");
    return plan;
  }
  if (!json.contains("gap")) return std::nullopt;
  plan.frames = number("frames", 1), plan.gap = number("gap", 1), plan.every = number("every", 1);
  const bool predicts = json.contains("seen");
  plan.before = number(predicts ? "seen" : "ends", 0);
  plan.after = predicts ? 0 : plan.before;
  plan.bad_frames = frame_list(json, "bad_frames", plan.frames, path);
  US_CHECK(plan.before > 0, path, ": no frame beside a gap is known");
  US_CHECK(!window_starts(plan).empty(), path, ": a gap of ", plan.gap, " frames with ", plan.before,
           " known ones before it and ", plan.after, " after it is longer than the sequence of ",
           plan.frames);
  return plan;
}

}  // namespace understudy::app
