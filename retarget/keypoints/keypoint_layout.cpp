#include "retarget/keypoints/keypoint_layout.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy {
namespace {

constexpr size_t kMostNames = 1000;
constexpr const char* kCoco =
    "nose left_eye right_eye left_ear right_ear left_shoulder right_shoulder left_elbow right_elbow "
    "left_wrist "
    "right_wrist left_hip right_hip left_knee right_knee left_ankle right_ankle";
constexpr const char* kHalpe =  // its feet are in another order than BODY_25's
    " head neck mid_hip left_big_toe right_big_toe left_small_toe right_small_toe left_heel right_heel";
constexpr const char* kWholeBodyFeet =
    " left_big_toe left_small_toe left_heel right_big_toe right_small_toe right_heel";
constexpr const char* kOpenPose18 =
    "nose neck right_shoulder right_elbow right_wrist left_shoulder left_elbow left_wrist right_hip "
    "right_knee "
    "right_ankle left_hip left_knee left_ankle right_eye left_eye right_ear left_ear";
constexpr const char* kMpi15 =
    "head neck right_shoulder right_elbow right_wrist left_shoulder left_elbow left_wrist right_hip "
    "right_knee "
    "right_ankle left_hip left_knee left_ankle chest";
constexpr const char* kBody15 =
    "nose neck right_shoulder right_elbow right_wrist left_shoulder left_elbow left_wrist mid_hip right_hip "
    "right_knee right_ankle left_hip left_knee left_ankle";
constexpr const char* kMediaPipe =
    "nose left_eye_inner left_eye left_eye_outer right_eye_inner right_eye right_eye_outer left_ear "
    "right_ear "
    "mouth_left mouth_right left_shoulder right_shoulder left_elbow right_elbow left_wrist right_wrist "
    "left_pinky right_pinky left_index right_index left_thumb right_thumb left_hip right_hip left_knee "
    "right_knee left_ankle right_ankle left_heel right_heel left_foot_index right_foot_index";

int index_of(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// Body of the names; MediaPipe calls the big toe the foot's index.
void find_body(KeypointLayout& layout) {
  for (int p = 0; p < kBodyPoints; ++p) layout.body[p] = index_of(layout.points, kBodyPointNames[p]);
  for (const bool left : {true, false}) {
    int& toe = layout.body[left ? body25::LeftBigToe : body25::RightBigToe];
    if (toe < 0) toe = index_of(layout.points, left ? "left_foot_index" : "right_foot_index");
  }
}

KeypointLayout row(const char* name, const char* label, const std::string& points) {
  KeypointLayout layout;
  layout.name = name;
  layout.label = label;
  layout.points = split(points, ' ');
  find_body(layout);
  return layout;
}

int add_points(KeypointLayout& layout, const std::string& name, int count) {
  const int first = layout.count();
  for (int i = 0; i < count; ++i) layout.points.push_back(name + "_" + std::to_string(i));
  return first;
}

void add_hands(KeypointLayout& layout) {
  layout.left_hand = add_points(layout, "left_hand", kHandPoints);
  layout.right_hand = add_points(layout, "right_hand", kHandPoints);
}

void add_face(KeypointLayout& layout, int count) {
  layout.face_points = count;
  layout.face = add_points(layout, "face", count);
}

std::string body25_names() {
  std::string names;
  for (const char* name : kBodyPointNames) append_item(names, name, " ");
  return names;
}

KeypointLayout with_face_and_hands(KeypointLayout layout) {
  add_face(layout, 68);
  add_hands(layout);
  return layout;
}

std::vector<KeypointLayout> all_layouts() {
  std::vector<KeypointLayout> all = {
      row("body25", "BODY_25", body25_names()),
      row("coco17", "COCO-17", kCoco),
      row("openpose18", "OpenPose-18", kOpenPose18),
      row("halpe26", "Halpe-26", std::string(kCoco) + kHalpe),
      with_face_and_hands(row("halpe136", "Halpe-136", std::string(kCoco) + kHalpe)),
      with_face_and_hands(row("wholebody133", "COCO-WholeBody-133", std::string(kCoco) + kWholeBodyFeet)),
      row("mediapipe33", "MediaPipe-33", kMediaPipe),
      row("mpi15", "MPI-15", kMpi15),
      row("body15", "BODY_25's first 15", kBody15),
      row("openpose137", "BODY_25 with hands and face", body25_names())};
  for (KeypointLayout& layout : all) layout.by_count = layout.count() != 15;
  add_hands(all.back());  // our own NPZ files
  add_face(all.back(), kFacePoints);
  return all;
}

/// "L_Shoulder", "LShoulder", "Left Shoulder" and "left-shoulder" as "leftshoulder".
std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name)
    if (std::string_view(" _-.").find(c) == std::string_view::npos) plain += c;
  const bool is_short =
      plain.size() > 1 && (plain[0] == 'L' || plain[0] == 'R') && plain[1] >= 'A' && plain[1] <= 'Z';
  const bool is_parted = name.size() > 2 && (name[1] == '_' || name[1] == '-') &&
                         std::string_view("lrLR").find(name[0]) != std::string_view::npos;
  const bool left = plain[0] == 'L' || plain[0] == 'l';
  plain = lower_case(plain);
  return is_short || is_parted ? (left ? "left" : "right") + plain.substr(1) : plain;
}

/// A name as our tables have it, itself where they do not know it.
std::string known_name(const std::string& name) {
  if (name.empty()) return name;
  const std::string plain = plain_name(name);
  static const std::vector<std::pair<std::string, std::string>> kSame = {
      {"pelvis", "mid_hip"},          {"hip", "mid_hip"},
      {"hipcenter", "mid_hip"},       {"midhip", "mid_hip"},
      {"leftbigtoe", "left_big_toe"}, {"rightbigtoe", "right_big_toe"}};
  for (const auto& [theirs, ours] : kSame)
    if (plain == theirs) return ours;
  for (const KeypointLayout& layout : keypoint_layouts())
    for (const std::string& point : layout.points)
      if (plain_name(point) == plain) return point;
  return name;
}

FlatPoints span(const FlatPoints& points, int first, int count, int rows) {
  FlatPoints out(0, 3);
  if (first < 0) return out;
  out = FlatPoints::Zero(rows, 3);
  out.topRows(count) = points.middleRows(first, count);
  return out;
}

void put_span(FlatPoints& points, int first, int count, const FlatPoints& from) {
  if (first >= 0 && from.rows() > 0) points.middleRows(first, count) = from.topRows(count);
}

}  // namespace

const std::vector<KeypointLayout>& keypoint_layouts() {
  static const std::vector<KeypointLayout> all = all_layouts();
  return all;
}

const KeypointLayout* layout_named(std::string_view name) {
  std::string plain;
  for (const char c : lower_case(name))
    if (c != '-' && c != '_' && c != ' ') plain += c;
  for (const KeypointLayout& layout : keypoint_layouts())
    if (layout.name == plain || (plain == "cocowholebody133" && layout.name == "wholebody133"))
      return &layout;
  return nullptr;
}

const KeypointLayout* layout_of_count(int64_t points) {
  for (const KeypointLayout& layout : keypoint_layouts())
    if (layout.by_count && layout.count() == points) return &layout;
  return nullptr;
}

std::string layout_labels() {
  std::string labels;
  for (const KeypointLayout& layout : keypoint_layouts()) append_item(labels, layout.label);
  return labels;
}

KeypointLayout layout_of_names(const std::vector<std::string>& names, const std::string& source) {
  US_CHECK(names.size() <= kMostNames, source, ": names ", names.size(), " points a person, more than ",
           kMostNames);
  KeypointLayout layout;
  for (const std::string& name : names) layout.points.push_back(known_name(name));
  for (const KeypointLayout& known : keypoint_layouts()) {
    const auto same =
        std::equal(known.points.begin(), known.points.end(), layout.points.begin(), layout.points.end());
    if (same) return known;
  }
  // Whole-body lists of others' names: hands and face are where those of the row with as many points are.
  if (const KeypointLayout* row = layout_of_count(layout.count()); row && row->left_hand >= 0) {
    const auto end = row->points.begin() + std::min({row->left_hand, row->face});
    if (std::equal(row->points.begin(), end, layout.points.begin())) return *row;
  }
  find_body(layout);
  using namespace body25;
  for (const int p : {RightShoulder, RightElbow, RightWrist, LeftShoulder, LeftElbow, LeftWrist, RightHip,
                      RightKnee, RightAnkle, LeftHip, LeftKnee, LeftAnkle})
    US_CHECK(layout.body[p] >= 0, source, ": unknown layout, none of its ", names.size(),
             " points is called ", kBodyPointNames[p]);
  layout.name = layout.label = std::to_string(layout.count()) + " points by their names";
  layout.by_count = false;
  return layout;
}

std::vector<int> mirrored_points(const KeypointLayout& layout) {
  std::vector<int> mirror;
  for (int p = 0; p < layout.count(); ++p) {
    std::string other = layout.points[static_cast<size_t>(p)];
    const size_t left = other.find("left"), right = other.find("right");
    if (left != other.npos)
      other.replace(left, 4, "right");
    else if (right != other.npos)
      other.replace(right, 5, "left");
    const int found = index_of(layout.points, other);
    mirror.push_back(found >= 0 ? found : p);
  }
  return mirror;
}

FlatPose pose_of_layout(const KeypointLayout& layout, const FlatPoints& points) {
  US_CHECK(points.rows() == layout.count(), "a person of ", points.rows(), " points is not one of ",
           layout.label);
  FlatPose pose;
  for (int p = 0; p < kBodyPoints; ++p)
    if (layout.body[p] >= 0) pose.body.row(p) = points.row(layout.body[p]);
  FlatPose whole = pose;
  add_middles(whole);
  for (const int p : {body25::Neck, body25::MidHip})
    if (layout.body[p] < 0) pose.body.row(p) = whole.body.row(p);
  pose.left_hand = span(points, layout.left_hand, kHandPoints, kHandPoints);
  pose.right_hand = span(points, layout.right_hand, kHandPoints, kHandPoints);
  pose.face = span(points, layout.face, layout.face_points, kFacePoints);
  return pose;
}

FlatPoints points_in_layout(const KeypointLayout& layout, const FlatPose& pose) {
  FlatPoints points = FlatPoints::Zero(layout.count(), 3);
  for (int p = 0; p < kBodyPoints; ++p)
    if (layout.body[p] >= 0) points.row(layout.body[p]) = pose.body.row(p);
  put_span(points, layout.left_hand, kHandPoints, pose.left_hand);
  put_span(points, layout.right_hand, kHandPoints, pose.right_hand);
  put_span(points, layout.face, layout.face_points, pose.face);
  return points;
}

}  // namespace understudy
