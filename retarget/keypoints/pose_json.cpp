#include "retarget/keypoints/pose_json.hpp"

#include <array>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

struct PoseShape {
  bool (*fits)(const PoseJson& json);
  void (*read)(const PoseJson& json, const std::string& source, RawSink& sink);
};

/// The first that fits counts: what is told by its keys comes before what is told by lists alone.
constexpr std::array<PoseShape, 6> kShapes = {{{is_openpose, read_openpose},
                                               {is_coco_annotations, read_coco_annotations},
                                               {is_mmpose, read_mmpose},
                                               {is_coco_results, read_coco_results},
                                               {is_alphapose_frames, read_alphapose_frames},
                                               {is_landmarks, read_landmarks}}};

}  // namespace

void read_pose_json(const PoseJson& json, const std::string& source, RawSink& sink) {
  US_CHECK(!(json.is_structured() && json.empty()), source, ": is empty JSON, there is nobody in it");
  for (const PoseShape& shape : kShapes)
    if (shape.fits(json)) return shape.read(json, source, sink);
  throw Error(
      source +
      ": is JSON, but holds no poses that OpenPose, ControlNet, COCO, AlphaPose, MMPose or MediaPipe " +
      "would write");
}

bool is_pose_json(const PoseJson& json) {
  for (const PoseShape& shape : kShapes)
    if (shape.fits(json)) return true;
  return false;
}

void check_people(size_t people, const std::string& what) {
  US_CHECK(people <= kMostPeople, what, " has ", people, " people, more than ", kMostPeople);
}

std::string frame_of(const std::string& source, int64_t number) {
  return source + ": frame " + std::to_string(number);
}

}  // namespace understudy
