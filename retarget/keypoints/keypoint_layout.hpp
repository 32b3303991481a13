// The orders in which files list a person's points, as rows of one table, and what each is in BODY_25.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// One row.
struct KeypointLayout {
  std::string name;   ///< for --layout, lower case: "coco17"
  std::string label;  ///< for people: "COCO-17"
  std::vector<std::string>
      points;  ///< the K names in the file's order: "left_shoulder"; hands and face numbered
  std::array<int, kBodyPoints> body{};       ///< which of the K each point of BODY_25 is, -1: none
  int left_hand = -1, right_hand = -1;       ///< where 21 of the K are a hand, -1: none
  int face = -1, face_points = kFacePoints;  ///< where so many of the K are the face's first
  bool by_count =
      true;  ///< so many points mean this layout; false: only a name does, another row has as many
  int count() const { return static_cast<int>(points.size()); }
};

const std::vector<KeypointLayout>& keypoint_layouts();
/// The row of this name, in any case, dashes and underscores left out ("COCO-17"); null when there is none.
const KeypointLayout* layout_named(std::string_view name);
/// The row for so many points; null when there is none or only names tell several apart.
const KeypointLayout* layout_of_count(int64_t points);
/// For messages: "COCO-17, OpenPose-18, ...".
std::string layout_labels();

/// A layout by a file's own list of names ("left_shoulder", "L_Shoulder", "LShoulder", "Left Shoulder"): the
/// row with those names in that order, else one made of them. Throws Error naming `source` when a shoulder, a
/// hip or another of the twelve joints of arms and legs is not among them, or there are more than 1,000.
KeypointLayout layout_of_names(const std::vector<std::string>& names, const std::string& source);

/// The point on the other side of each of the K; its own number where there is none.
std::vector<int> mirrored_points(const KeypointLayout& layout);

/// points [K, 3] (see FlatPoints) as a pose; neck and mid-hip are added where the layout has none. Hands and
/// face have rows where the layout has them. Throws Error when K is another number than the layout's.
FlatPose pose_of_layout(const KeypointLayout& layout, const FlatPoints& points);
/// The other way round, [K, 3]; what BODY_25 does not have is missing.
FlatPoints points_in_layout(const KeypointLayout& layout, const FlatPose& pose);

}  // namespace understudy
