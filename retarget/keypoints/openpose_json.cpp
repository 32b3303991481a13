// OpenPose's frames, ControlNet's lists of them, AlphaPose's two imitations.
#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/formats/scan_frames.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {
namespace {

/// OpenPose writes [-1] where it does not follow people.
std::optional<int64_t> openpose_id(const PoseJson& person) {
  const PoseJson* id = member(person, {"person_id", "track_id", "idx"});
  if (id && id->is_array()) id = first_of(id);
  const auto number = whole_of(id);
  return number && *number >= 0 ? number : std::nullopt;
}

RawPerson openpose_person(const PoseJson& json, const std::string& what) {
  US_CHECK(json.is_object(), what, ": a person is no object of JSON");
  const PoseJson* const body = member(json, {"pose_keypoints_2d", "pose_keypoints", "joints"});
  US_CHECK(body, what, ": a person has no pose_keypoints_2d");
  RawPerson person;
  person.id = openpose_id(json);
  person.points = points_of(body, what).rows;
  person.left_hand = points_of(member(json, {"hand_left_keypoints_2d", "hand_left_keypoints"}), what).rows;
  person.right_hand = points_of(member(json, {"hand_right_keypoints_2d", "hand_right_keypoints"}), what).rows;
  person.face = points_of(member(json, {"face_keypoints_2d", "face_keypoints"}), what).rows;
  return person;
}

RawFrame openpose_frame(const PoseJson& json, int64_t number, const std::string& what) {
  RawFrame frame;
  frame.number = number;
  frame.canvas = canvas_of(member(json, {"canvas_width"}), member(json, {"canvas_height"}));
  const PoseJson* const people = member(json, {"people", "bodies"});
  US_CHECK(people && (people->is_array() || people->is_null()), what, " has no list of people");
  check_people(people->size(), what);
  if (people->is_array())
    for (const PoseJson& person : *people) frame.people.push_back(openpose_person(person, what));
  return frame;
}

bool is_openpose_frame(const PoseJson* json) {
  const PoseJson* const people = json ? member(*json, {"people", "bodies"}) : nullptr;
  return people && (people->is_array() || people->is_null());
}

RawFacts openpose_facts(const char* format) {
  RawFacts facts;
  facts.format = format;
  facts.may_be_signed = facts.to_last_pixel = true;
  facts.layout_of_15 = "mpi15";
  return facts;
}

}  // namespace

bool is_openpose(const PoseJson& json) {
  return is_openpose_frame(&json) || is_openpose_frame(first_of(&json));
}

void read_openpose(const PoseJson& json, const std::string& source, RawSink& sink) {
  const PoseJson& first = json.is_array() ? json.front() : json;
  const bool has_canvas = has(&first, {"canvas_width"});
  RawFacts facts = openpose_facts(has_canvas        ? json.is_array() ? "ControlNet list" : "ControlNet pose"
                                  : json.is_array() ? "list of OpenPose frames"
                                                    : "OpenPose frame");
  // ComfyUI takes places for fractions of the whole canvas when all lie in 0..1.
  if (has_canvas) facts.may_be_signed = facts.to_last_pixel = false;
  facts.fps = number_of(member(first, {"fps"})).value_or(0);
  sink.begin(facts);
  const auto add = [&](const PoseJson& frame, int64_t number) {
    sink.frame(number, [&, number] {
      US_CHECK(frame.is_object(), frame_of(source, number), " is no object of JSON");
      return openpose_frame(frame, number, frame_of(source, number));
    });
  };
  if (!json.is_array()) return add(json, 0);
  int64_t number = 0;
  for (const PoseJson& frame : json) add(frame, number++);
}

bool is_alphapose_frames(const PoseJson& json) {
  return json.is_object() && !json.empty() && is_openpose_frame(&json.begin().value());
}

void read_alphapose_frames(const PoseJson& json, const std::string& source, RawSink& sink) {
  sink.begin(openpose_facts("AlphaPose frames"));
  std::vector<std::string> pictures;
  for (const auto& [picture, frame] : json.items()) pictures.push_back(picture);
  std::sort(pictures.begin(), pictures.end(), natural_less);
  int64_t before = -1;
  for (const std::string& picture : pictures) {
    const auto named = frame_number(picture);
    const int64_t number = named && *named > before ? *named : before + 1;
    before = number;
    sink.frame(number,
               [&, number] { return openpose_frame(json.at(picture), number, frame_of(source, number)); });
  }
}

}  // namespace understudy
