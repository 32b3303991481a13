// COCO's annotations and its results, as Detectron2 and AlphaPose write them too.
#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "retarget/base/error.hpp"
#include "retarget/formats/scan_frames.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {
namespace {

/// People of one picture; all of them are in one list of the file.
struct CocoPicture {
  std::string name;           // of the file, or the id as text
  std::optional<int64_t> id;  // where it is a number
  Canvas canvas;
  std::vector<const PoseJson*> people;
};

/// A number or text, so that both can be looked up.
std::string picture_key(const PoseJson* id) {
  return !id ? "" : id->is_string() ? id->get<std::string>() : id->is_primitive() ? id->dump() : "";
}

RawPerson coco_person(const PoseJson& json, const std::string& what) {
  const PoseJson* const points = member(json, {"keypoints"});
  US_CHECK(points, what, ": a person has no keypoints");
  RawPerson person;
  ListedPoints listed = points_of(points, what);
  person.points = std::move(listed.rows);
  person.has_confidence = listed.has_confidence;
  const PoseJson* id = member(json, {"track_id", "idx"});
  if (id && id->is_array()) id = first_of(id);
  person.id = whole_of(id);
  person.score = static_cast<float>(number_of(member(json, {"score"})).value_or(1));
  return person;
}

/// Frames in the order of the pictures' names, or of the ids where all are numbers and no names are told.
void add_coco_frames(std::vector<CocoPicture>& pictures, bool by_id, const std::string& source,
                     RawSink& sink) {
  std::stable_sort(pictures.begin(), pictures.end(), [&](const CocoPicture& a, const CocoPicture& b) {
    return by_id ? *a.id < *b.id : natural_less(a.name, b.name);
  });
  int64_t before = -1;
  for (const CocoPicture& picture : pictures) {
    const auto told = by_id ? picture.id : frame_number(picture.name);
    const int64_t number = told && *told > before ? *told : before + 1;
    before = number;
    sink.frame(number, [&, number] {
      RawFrame frame;
      frame.number = number;
      frame.canvas = picture.canvas;
      const std::string what = frame_of(source, number);
      check_people(picture.people.size(), what);
      for (const PoseJson* person : picture.people) frame.people.push_back(coco_person(*person, what));
      return frame;
    });
  }
}

std::vector<std::string> category_names(const PoseJson& json) {
  const PoseJson* const categories = member(json, {"categories"});
  const PoseJson* const first = first_of(categories);
  const PoseJson* const points = first ? member(*first, {"keypoints"}) : nullptr;
  std::vector<std::string> names;
  if (points && points->is_array())
    for (const PoseJson& name : *points) names.push_back(text_of(&name));
  return names;
}

}  // namespace

bool is_coco_annotations(const PoseJson& json) {
  const PoseJson* const annotations = member(json, {"annotations"});
  return annotations && annotations->is_array() && has(&json, {"images"});
}

void read_coco_annotations(const PoseJson& json, const std::string& source, RawSink& sink) {
  const PoseJson& images = json["images"];
  US_CHECK(images.is_array(), source, ": its images are no list");
  RawFacts facts;
  facts.format = "COCO annotations";
  facts.names = category_names(json);
  facts.confidence = RawConfidence::Visibility;
  std::vector<CocoPicture> pictures;
  std::unordered_map<std::string, size_t> index;
  for (const PoseJson& image : images) {
    const std::string key = picture_key(member(image, {"id"}));
    US_CHECK(!key.empty(), source, ": a picture has no id");
    const std::string name = text_of(member(image, {"file_name"}));
    if (!index.emplace(key, pictures.size()).second) continue;
    pictures.push_back({name.empty() ? key : name,
                        whole_of(member(image, {"id"})),
                        canvas_of(member(image, {"width"}), member(image, {"height"})),
                        {}});
  }
  for (const PoseJson& person : json["annotations"]) {
    const auto found = index.find(picture_key(member(person, {"image_id"})));
    US_CHECK(found != index.end(), source, ": an annotation is of a picture that is not among its images");
    if (has(&person, {"keypoints"})) pictures[found->second].people.push_back(&person);
  }
  sink.begin(facts);
  add_coco_frames(pictures, /*by_id=*/false, source, sink);
}

bool is_coco_results(const PoseJson& json) {
  const PoseJson* const first = first_of(&json);
  return has(first, {"image_id"}) && has(first, {"keypoints"});
}

void read_coco_results(const PoseJson& json, const std::string& source, RawSink& sink) {
  RawFacts facts;
  // Detectron2 works half a pixel aside and takes that off again when it writes: nothing is left to be done.
  facts.format = "COCO results";
  std::vector<CocoPicture> pictures;
  std::unordered_map<std::string, size_t> index;
  bool by_id = true;
  for (const PoseJson& person : json) {
    const PoseJson* const id = member(person, {"image_id"});
    const std::string key = picture_key(id);
    US_CHECK(!key.empty(), source, ": somebody has no image_id");
    const auto [at, is_new] = index.emplace(key, pictures.size());
    if (is_new) {
      const auto number = whole_of(id);
      by_id = by_id && number && *number >= 0;
      pictures.push_back({key, number, {}, {}});
      if (id->is_string() && !number) facts.format = "AlphaPose results";
    }
    pictures[at->second].people.push_back(&person);
  }
  sink.begin(facts);
  add_coco_frames(pictures, by_id, source, sink);
}

}  // namespace understudy
