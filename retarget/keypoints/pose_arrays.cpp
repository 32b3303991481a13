#include "retarget/keypoints/pose_arrays.hpp"

#include <algorithm>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {
namespace {

constexpr uint64_t kLargestPoses = uint64_t{2} << 30;

struct PoseShapeOf {
  int64_t frames = 1, people = 1, points = 0, numbers = 0;
};

PoseShapeOf shape_of(const NpyArray& array) {
  const auto& s = array.shape;
  if (s.size() == 2) return {1, 1, s[0], s[1]};
  if (s.size() == 3) return {s[0], 1, s[1], s[2]};
  return {s[0], s[1], s[2], s[3]};
}

const NpyArray& pose_array(const Npz& npz, const std::string& path) {
  if (const auto named = npz.find("keypoints"); named != npz.end()) return named->second;
  const NpyArray* found = nullptr;
  for (const auto& [name, array] : npz) {
    if (!is_pose_array(array)) continue;
    US_CHECK(!found, path, ": has several arrays of points, none called 'keypoints'");
    found = &array;
  }
  US_CHECK(found, path, ": has no array of frames, points and 2 or 3 numbers");
  return *found;
}

/// An array of `count` whole numbers beside the points; null when there is none.
const NpyArray* numbers_beside(const Npz& npz, const char* name, int64_t count, const std::string& path) {
  const auto found = npz.find(name);
  if (found == npz.end() || found->second.size() == 0) return nullptr;
  US_CHECK(found->second.size() == count, path, ": its array '", name, "' has ", found->second.size(),
           " numbers, not ", count);
  return &found->second;
}

bool is_npy(const std::string& path) {
  return starts_with(beginning_of(path, 6), "\x93NUMPY");
}

RawFacts facts_of(const Npz& npz, const std::string& path) {
  RawFacts facts;
  facts.format = is_npy(path) ? "NPY array" : "NPZ arrays";
  facts.may_be_signed = true;
  if (const NpyArray* const canvas = numbers_beside(npz, "canvas", 2, path))
    if (canvas->values[0] >= 1 && canvas->values[1] >= 1 && canvas->values[0] <= kLargestCanvas &&
        canvas->values[1] <= kLargestCanvas)
      facts.canvas = {static_cast<int>(canvas->values[0]), static_cast<int>(canvas->values[1])};
  if (const NpyArray* const fps = numbers_beside(npz, "fps", 1, path)) facts.fps = fps->values[0];
  if (const auto layout = npz.find("layout"); layout != npz.end()) facts.layout = layout->second.text;
  return facts;
}

RawFrame array_frame(const NpyArray& array, const PoseShapeOf& shape, int64_t frame) {
  RawFrame out;
  for (int64_t p = 0; p < shape.people; ++p) {
    RawPerson person;
    person.has_confidence = shape.numbers == 3;
    person.points.setOnes(shape.points, 3);
    const float* at = array.values.data() + (frame * shape.people + p) * shape.points * shape.numbers;
    for (int64_t k = 0; k < shape.points; ++k)
      for (int64_t c = 0; c < shape.numbers; ++c) person.points(k, c) = *at++;
    out.people.push_back(std::move(person));
  }
  return out;
}

Npz arrays_of(const std::string& path) {
  US_CHECK(check_file(path) <= kLargestPoses, path, ": is larger than 2 GiB, which no file of poses is");
  if (is_npy(path)) return {{"keypoints", parse_npy(read_file(path, kLargestPoses), path)}};
  return read_npz(path);
}

}  // namespace

std::string beginning_of(const std::string& path, size_t most) {
  std::string bytes(std::min<uint64_t>(check_file(path), most), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<size_t>(file.gcount()));
  return bytes;
}

bool is_pose_array(const NpyArray& array) {
  const auto& s = array.shape;
  return array.size() > 0 && s.size() >= 2 && s.size() <= 4 && (s.back() == 2 || s.back() == 3) &&
         s[s.size() - 2] >= 10;
}

void read_pose_arrays(const std::string& path, RawSink& sink) {
  const Npz npz = arrays_of(path);
  const NpyArray& array = pose_array(npz, path);
  US_CHECK(is_pose_array(array), path, ": its array is not of frames, points and 2 or 3 numbers");
  const PoseShapeOf shape = shape_of(array);
  check_people(static_cast<size_t>(shape.people), path + ": a frame");
  const NpyArray* const frames = numbers_beside(npz, "frames", shape.frames, path);
  const bool each_frame = npz.count("people") > 0 && npz.at("people").shape.size() == 2;
  const NpyArray* const people =
      numbers_beside(npz, "people", shape.people * (each_frame ? shape.frames : 1), path);
  sink.begin(facts_of(npz, path));
  for (int64_t t = 0; t < shape.frames; ++t) {
    const int64_t number = frames ? whole(frames->values[static_cast<size_t>(t)]) : t;
    sink.frame(number, [&, t] {
      RawFrame frame = array_frame(array, shape, t);
      const float* id = people ? people->values.data() + (each_frame ? t * shape.people : 0) : nullptr;
      for (RawPerson& person : frame.people)
        if (id) person.id = whole(*id++);
      return frame;
    });
  }
}

}  // namespace understudy
