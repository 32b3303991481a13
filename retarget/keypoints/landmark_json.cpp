// MediaPipe has no file format: people dump its landmarks in lists, lists of lists, and under many names.
#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {
namespace {

constexpr int kDeepestWrapping = 4;
constexpr std::initializer_list<const char*> kLandmarks = {"pose_landmarks", "poseLandmarks", "landmarks",
                                                           "landmark",       "keypoints",     "pose",
                                                           "poses",          "people",        "persons"};
constexpr std::initializer_list<const char*> kFrameLists = {"frames", "results", "data", "pose_data"};
constexpr std::initializer_list<const char*> kFrameNumbers = {
    "frame", "frame_id", "frame_number", "frameNumber", "frame_index", "frameIndex", "index"};

bool is_point(const PoseJson* json) {
  if (!json) return false;
  if (json->is_array())
    return json->size() >= 2 && json->size() <= 4 && (json->front().is_number() || json->front().is_null());
  return has(json, {"x", "X"}) && has(json, {"y", "Y"});
}

/// Calls `person` for every list of points in what stands for a frame.
template <class Person>
void each_person(const PoseJson* json, const Person& person, int depth = 0) {
  if (!json || json->is_null() || depth > kDeepestWrapping) return;
  if (json->is_object()) return each_person(member(*json, kLandmarks), person, depth + 1);
  if (!json->is_array()) return;
  if (is_point(first_of(json))) return person(*json);
  for (const PoseJson& inner : *json) each_person(&inner, person, depth + 1);
}

bool has_somebody(const PoseJson& json) {
  bool found = false;
  each_person(&json, [&](const PoseJson&) { found = true; });
  return found;
}

/// The list of frames; null: the whole is one frame.
const PoseJson* frame_list(const PoseJson& json) {
  if (const PoseJson* const frames = member(json, kFrameLists); frames && frames->is_array()) return frames;
  return json.is_array() && !is_point(first_of(&json)) ? &json : nullptr;
}

RawFrame landmark_frame(const PoseJson& json, int64_t number, const std::string& what) {
  RawFrame frame;
  frame.number = number;
  frame.canvas = canvas_of(member(json, {"width", "image_width", "canvas_width"}),
                           member(json, {"height", "image_height", "canvas_height"}));
  each_person(&json, [&](const PoseJson& points) {
    check_people(frame.people.size() + 1, what);
    ListedPoints listed = points_of(&points, what);
    RawPerson person;
    person.points = std::move(listed.rows);
    person.has_confidence = listed.has_confidence;
    frame.people.push_back(std::move(person));
  });
  return frame;
}

/// The first person found: its names and how many points there are.
ListedPoints first_person(const PoseJson& json, const std::string& source) {
  ListedPoints first;
  const auto look = [&](const PoseJson& points) {
    if (first.rows.rows() > 0) return;
    failure_of([&] { first = points_of(&points, source); });  // a broken one is its frame's problem
  };
  const PoseJson* const frames = frame_list(json);
  if (!frames) return each_person(&json, look), first;
  for (const PoseJson& frame : *frames) {
    each_person(&frame, look);
    if (first.rows.rows() > 0) break;
  }
  return first;
}

}  // namespace

bool is_landmarks(const PoseJson& json) {
  const PoseJson* const frames = frame_list(json);
  if (!frames) return has_somebody(json);
  return std::any_of(frames->begin(), frames->end(), has_somebody);
}

void read_landmarks(const PoseJson& json, const std::string& source, RawSink& sink) {
  const ListedPoints first = first_person(json, source);
  RawFacts facts;
  facts.format = first.rows.rows() == 33 ? "MediaPipe landmarks" : "list of points";
  facts.names = first.names;
  facts.confidence = RawConfidence::Logit;
  facts.fps = number_of(member(json, {"fps", "frame_rate"})).value_or(0);
  facts.canvas = canvas_of(member(json, {"width", "image_width", "canvas_width"}),
                           member(json, {"height", "image_height", "canvas_height"}));
  sink.begin(facts);
  const PoseJson* const frames = frame_list(json);
  if (!frames) return sink.frame(0, [&] { return landmark_frame(json, 0, frame_of(source, 0)); });
  int64_t position = 0;
  for (const PoseJson& frame : *frames) {
    const int64_t number = whole_of(member(frame, kFrameNumbers)).value_or(position);
    sink.frame(number, [&, number] { return landmark_frame(frame, number, frame_of(source, number)); });
    position = number + 1;
  }
}

}  // namespace understudy
