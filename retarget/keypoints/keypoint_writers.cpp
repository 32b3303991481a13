#include "retarget/keypoints/keypoint_writers.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/npz_writer.hpp"
#include "retarget/keypoints/keypoint_layout.hpp"

namespace understudy {
namespace {

constexpr const char* kZeros = "0,0,0";

/// "[x,y,c,x,y,c]"; shown: every confidence is 1.0.
void append_points(std::string& out, const Eigen::Ref<const FlatPoints>& points, bool shown) {
  out += '[';
  for (Eigen::Index r = 0; r < points.rows(); ++r) {
    if (r > 0) out += ',';
    if (!(points(r, 2) > 0)) {
      out += kZeros;
      continue;
    }
    append_exact(out, points(r, 0));
    out += ',';
    append_exact(out, points(r, 1));
    out += ',';
    if (shown)
      out += "1.0";
    else
      append_exact(out, points(r, 2));
  }
  out += ']';
}

void append_part(std::string& out, const char* name, const FlatPoints& points, bool shown) {
  out += std::string(",\"") + name + "\":";
  append_points(out, points, shown);
}

/// `layout`: which points of the body.
std::string person_json(const FlatPose& pose, const KeypointLayout& layout, bool shown, int64_t id) {
  std::string out = "{\"person_id\":[" + std::to_string(id) + "],\"pose_keypoints_2d\":";
  append_points(out, points_in_layout(layout, pose), shown);
  append_part(out, "face_keypoints_2d", pose.face, shown);
  append_part(out, "hand_left_keypoints_2d", pose.left_hand, shown);
  append_part(out, "hand_right_keypoints_2d", pose.right_hand, shown);
  return out + "}";
}

struct SeenPose {
  int64_t person = 0;
  const FlatPose* pose = nullptr;
};
using SeenInFrame = std::vector<SeenPose>;

/// Who is in each frame, in the order of the tracks.
std::vector<SeenInFrame> people_of_frames(const KeypointReading& reading) {
  std::vector<SeenInFrame> frames(reading.frames.size());
  for (const KeypointTrack& track : reading.tracks)
    for (const TrackedPose& pose : track.poses)
      frames[static_cast<size_t>(pose.frame)].push_back({track.person, &pose.pose});
  return frames;
}

SeenInFrame people_in(const KeypointReading& reading, int64_t frame) {
  SeenInFrame people;
  for (const KeypointTrack& track : reading.tracks)
    if (const FlatPose* const pose = track.at(frame)) people.push_back({track.person, pose});
  return people;
}

void check_frames(const KeypointReading& reading, const std::string& path) {
  US_CHECK(!reading.frames.empty(), path, ": there are no frames to write");
}

std::string people_json(const SeenInFrame& people, const char* layout, bool shown) {
  std::string list;
  for (const auto& [person, pose] : people)
    append_item(list, person_json(*pose, *layout_named(layout), shown, person), ",");
  return "\"people\":[" + list + "]";
}

std::string openpose_text(const SeenInFrame& people) {
  return std::string("{\"version\":1.3,\"comment\":\"") + PartFolder::kMark + "\"," +
         people_json(people, "body25", /*shown=*/false) + "}\n";
}

std::string controlnet_text(const SeenInFrame& people, const Canvas& canvas) {
  return "{" + people_json(people, "openpose18", /*shown=*/true) +
         ",\"canvas_width\":" + std::to_string(canvas.width) +
         ",\"canvas_height\":" + std::to_string(canvas.height) + "}";
}

/// Which parts anybody has, so that files without hands do not say so in every line.
struct PartsThere {
  bool hands = false, face = false;
};
PartsThere parts_there(const KeypointReading& reading) {
  PartsThere there;
  for (const KeypointTrack& track : reading.tracks)
    for (const TrackedPose& pose : track.poses) {
      there.hands |= pose.pose.left_hand.rows() > 0 || pose.pose.right_hand.rows() > 0;
      there.face |= pose.pose.face.rows() > 0;
    }
  return there;
}

void append_cells(std::string& line, const FlatPoints& points, int count) {
  for (int r = 0; r < count; ++r) {
    const bool is_seen = r < points.rows() && points(r, 2) > 0;
    for (int c = 0; c < 3; ++c) {
      line += ',';
      if (is_seen) append_exact(line, points(r, c));
    }
  }
}

std::string csv_header(const PartsThere& there) {
  std::string line = "frame,seconds,person";
  const auto add = [&](const std::string& name) { line += "," + name + "_x," + name + "_y," + name + "_c"; };
  for (const char* name : kBodyPointNames) add(name);
  for (const char* hand : {"left_hand_", "right_hand_"})
    for (int i = 0; i < kHandPoints && there.hands; ++i) add(hand + std::to_string(i));
  for (int i = 0; i < kFacePoints && there.face; ++i) add("face_" + std::to_string(i));
  return line + "\n";
}

/// Mean confidence of those seen: COCO's evaluation ranks people by it.
float mean_confidence(const FlatPose& pose) {
  const int seen = points_seen(pose);
  return seen > 0 ? pose.body.col(2).sum() / static_cast<float>(seen) : 0;
}

std::string coco_person_json(const FlatPose& pose, int64_t number, int64_t person) {
  std::string out = "{\"image_id\":" + std::to_string(number) +
                    ",\"category_id\":1,\"track_id\":" + std::to_string(person) + ",\"keypoints\":";
  append_points(out, points_in_layout(*layout_named("coco17"), pose), false);
  out += ",\"score\":";
  append_exact(out, mean_confidence(pose));
  return out + "}";
}

}  // namespace

std::string openpose_json(const KeypointReading& reading, int64_t frame) {
  return openpose_text(people_in(reading, frame));
}

std::string openpose_file_name(const std::string& folder, int64_t number) {
  return file_name(folder) + printed("_%012lld_keypoints.json", static_cast<long long>(number));
}

std::string controlnet_json(const KeypointReading& reading, int64_t frame) {
  return controlnet_text(people_in(reading, frame), reading.canvas);
}

void write_openpose_folder(const std::string& folder, const KeypointReading& reading) {
  check_frames(reading, folder);
  PartFolder files(folder);
  const std::vector<SeenInFrame> frames = people_of_frames(reading);
  for (size_t frame = 0; frame < frames.size(); ++frame)
    files.add(openpose_file_name(files.path(), reading.frames[frame].number), openpose_text(frames[frame]));
  files.finish();
}

void write_controlnet(const std::string& path, const KeypointReading& reading) {
  check_frames(reading, path);
  PartFile file(path);
  const char* before = "[";
  for (const SeenInFrame& people : people_of_frames(reading)) {
    file.write(before + controlnet_text(people, reading.canvas));
    before = ",\n";
  }
  file.write("]\n");
  file.finish();
}

void write_coco_results(const std::string& path, const KeypointReading& reading) {
  check_frames(reading, path);
  const std::vector<SeenInFrame> frames = people_of_frames(reading);
  PartFile file(path);
  const char* before = "";
  file.write("[");
  for (size_t frame = 0; frame < frames.size(); ++frame)
    for (const auto& [person, pose] : frames[frame]) {
      file.write(before + coco_person_json(*pose, reading.frames[frame].number, person));
      before = ",\n";
    }
  file.write("]\n");
  file.finish();
}

void write_keypoint_csv(const std::string& path, const KeypointReading& reading) {
  check_frames(reading, path);
  const PartsThere there = parts_there(reading);
  const std::vector<SeenInFrame> frames = people_of_frames(reading);
  PartFile file(path);
  file.write(csv_header(there));
  for (size_t frame = 0; frame < frames.size(); ++frame)
    for (const auto& [person, pose] : frames[frame]) {
      std::string line = std::to_string(reading.frames[frame].number) + ",";
      append_fixed(line, reading.seconds(static_cast<int64_t>(frame)), 6);
      line += "," + std::to_string(person);
      append_cells(line, pose->body, kBodyPoints);
      if (there.hands) append_cells(line, pose->left_hand, kHandPoints);
      if (there.hands) append_cells(line, pose->right_hand, kHandPoints);
      if (there.face) append_cells(line, pose->face, kFacePoints);
      file.write(line + "\n");
    }
  file.finish();
}

void write_keypoint_npz(const std::string& path, const KeypointReading& reading) {
  check_frames(reading, path);
  const PartsThere there = parts_there(reading);
  const KeypointLayout& layout = *layout_named(there.hands || there.face ? "openpose137" : "body25");
  const std::vector<SeenInFrame> frames = people_of_frames(reading);
  size_t most = 1;
  for (const SeenInFrame& people : frames) most = std::max(most, people.size());
  const auto places = static_cast<int64_t>(most);
  NpzWriter npz(path);
  const size_t keypoints = npz.add_frames("keypoints", {places, layout.count(), 3});
  std::vector<double> numbers, persons;
  for (size_t frame = 0; frame < frames.size(); ++frame) {
    FlatPoints all = FlatPoints::Zero(places * layout.count(), 3);
    for (size_t p = 0; p < frames[frame].size(); ++p)
      all.middleRows(static_cast<Eigen::Index>(p) * layout.count(), layout.count()) =
          points_in_layout(layout, *frames[frame][p].pose);
    npz.push(keypoints, all.data());
    numbers.push_back(static_cast<double>(reading.frames[frame].number));
    for (size_t p = 0; p < most; ++p)
      persons.push_back(p < frames[frame].size() ? static_cast<double>(frames[frame][p].person) : -1);
  }
  const auto count = static_cast<int64_t>(frames.size());
  npz.add("people", {count, places}, persons);
  npz.add("frames", {count}, numbers);
  npz.add("canvas", {2},
          {static_cast<double>(reading.canvas.width), static_cast<double>(reading.canvas.height)});
  npz.add("fps", {}, {reading.fps});
  npz.add("layout", layout.name);
  npz.finish();
}

}  // namespace understudy
