// MMPose: the dump of its demo, of its inferencer, and the inferencer's of one picture.
#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {
namespace {

constexpr int64_t kMostNamesTold = 1000;

RawPerson mmpose_person(const PoseJson& json, const std::string& what) {
  const PoseJson* const points = member(json, {"keypoints"});
  US_CHECK(points, what, ": somebody has no keypoints");
  RawPerson person;
  ListedPoints listed = points_of(points, what);
  person.points = std::move(listed.rows);
  person.has_confidence = listed.has_confidence;
  if (const PoseJson* const scores = list_of(member(json, {"keypoint_scores"}))) {
    US_CHECK(static_cast<Eigen::Index>(scores->size()) == person.points.rows(), what, ": has ",
             person.points.rows(), " points, but ", scores->size(), " scores");
    Eigen::Index row = 0;
    for (const PoseJson& score : *scores) {
      const auto number = number_of(&score);
      US_CHECK(number || score.is_null(), what, ": has something else where scores belong");
      person.points(row++, 2) = static_cast<float>(std::clamp(number.value_or(0), -1e6, 1e6));
    }
    person.has_confidence = true;
  }
  person.id = whole_of(member(json, {"track_id"}));
  const PoseJson* score = member(json, {"bbox_score"});
  if (score && score->is_array()) score = first_of(score);
  person.score = static_cast<float>(std::clamp(number_of(score).value_or(1), 0.0, 1.0));
  return person;
}

void add_instances(const PoseJson& instances, int64_t number, const std::string& source, RawSink& sink) {
  sink.frame(number, [&, number] {
    const std::string what = frame_of(source, number);
    US_CHECK(instances.is_array() || instances.is_null(), what, ": its instances are no list");
    check_people(instances.size(), what);
    RawFrame frame;
    frame.number = number;
    if (instances.is_array())
      for (const PoseJson& person : instances) frame.people.push_back(mmpose_person(person, what));
    return frame;
  });
}

/// keypoint_id2name has the numbers as text.
std::vector<std::string> mmpose_names(const PoseJson& json) {
  const PoseJson* const meta = member(json, {"meta_info"});
  const PoseJson* const table = meta ? member(*meta, {"keypoint_id2name"}) : nullptr;
  std::vector<std::string> names;
  if (!table) return names;
  if (const PoseJson* const list = list_of(table)) {
    for (const PoseJson& name : *list) names.push_back(text_of(&name));
    return names;
  }
  while (static_cast<int64_t>(names.size()) <= kMostNamesTold) {
    const auto found = table->find(std::to_string(names.size()));
    if (found == table->end()) break;
    names.push_back(text_of(&*found));
  }
  return names;
}

bool is_mmpose_person(const PoseJson* json) {
  return has(json, {"keypoints"}) && has(json, {"keypoint_scores"});
}

/// Numbers told by the frames count; they rise, or the frame says so where it stands.
void add_numbered(const PoseJson& frames, const std::string& source, RawSink& sink) {
  static const PoseJson kNobody = PoseJson::array();
  int64_t position = 0;
  for (const PoseJson& frame : frames) {
    const int64_t number = whole_of(member(frame, {"frame_id"})).value_or(position);
    const PoseJson* const instances = member(frame, {"instances"});
    add_instances(instances ? *instances : kNobody, number, source, sink);
    position = number + 1;
  }
}

}  // namespace

bool is_mmpose(const PoseJson& json) {
  const PoseJson* const info = list_of(member(json, {"instance_info"}));
  return info || has(first_of(&json), {"instances"}) || is_mmpose_person(first_of(&json));
}

void read_mmpose(const PoseJson& json, const std::string& source, RawSink& sink) {
  RawFacts facts;
  facts.format = "MMPose";
  facts.names = mmpose_names(json);
  sink.begin(facts);
  const PoseJson* const info = list_of(member(json, {"instance_info"}));
  const PoseJson& list = info ? *info : json;
  if (has(first_of(&list), {"instances"})) return add_numbered(list, source, sink);
  add_instances(list, 0, source, sink);  // of one picture
}

}  // namespace understudy
