#include "retarget/keypoints/keypoint_reader.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/formats/scan_frames.hpp"
#include "retarget/keypoints/frame_decoder.hpp"
#include "retarget/keypoints/pose_arrays.hpp"
#include "retarget/keypoints/pose_files.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kLargestFrame = uint64_t{64} << 20, kLargestJson = uint64_t{1} << 30;
constexpr size_t kGlance = 64 << 10;

/// Takes the one frame that a file of a folder holds.
class OneFrame : public RawSink {
 public:
  void begin(const RawFacts& facts) override { facts_ = facts; }
  void frame(int64_t, const std::function<RawFrame()>& read) override {
    if (count_++ == 0) frame_ = read();
  }
  const RawFacts& facts() const { return facts_; }
  RawFrame take(const std::string& path, int64_t number) {
    US_CHECK(count_ == 1, path, ": holds ", count_, " frames, a file of a folder holds one");
    frame_.number = number;
    return std::move(frame_);
  }

 private:
  RawFacts facts_;
  RawFrame frame_;
  int64_t count_ = 0;
};

/// The last number in each name, where all have one and most are different; else 0, 1, 2.
std::vector<int64_t> numbers_of_names(const std::vector<std::string>& names) {
  std::vector<int64_t> numbers;
  size_t same = 0;
  bool are_good = true;
  for (const std::string& name : names) {
    const auto number = frame_number(name);
    are_good = are_good && number && (numbers.empty() || *number >= numbers.back());
    same += !numbers.empty() && number && *number == numbers.back();
    numbers.push_back(number.value_or(0));
  }
  if (!are_good || 2 * same > names.size())
    for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int64_t>(i);
  return numbers;
}

/// A picture with the name of the file or folder but for its suffix, or of the folder's first frame.
std::optional<PictureBeside> picture_beside(const std::vector<std::string>& stems,
                                            const KeypointReaderOptions& options) {
  if (!options.picture_size) return {};
  for (const std::string& stem : stems)
    for (const char* suffix : {".png", ".jpg", ".jpeg", ".webp", ".PNG", ".JPG", ".JPEG"}) {
      std::error_code error;
      const std::string path = stem + suffix;
      if (!fs::is_regular_file(path, error)) continue;
      const auto size = options.picture_size(path);
      if (size && size->is_known()) return PictureBeside{path, *size};
    }
  return {};
}

std::string without_suffix(const std::string& path) {
  return fs::path(path).replace_extension().string();
}

/// "walk_000000000000_keypoints.json" beside "walk_000000000000.png".
std::string without_keypoints(std::string stem) {
  for (const char* end : {"_keypoints", "_pose"})
    if (ends_with(stem, end)) stem.resize(stem.size() - std::string_view(end).size());
  return stem;
}

KeypointReading read_json_folder(const std::string& folder, const std::vector<std::string>& names,
                                 const KeypointReaderOptions& options) {
  FrameDecoder decoder(folder, options, picture_of_folder(folder, options));
  const std::vector<int64_t> numbers = numbers_of_names(names);
  for (size_t i = 0; i < names.size(); ++i)
    decoder.frame(numbers[i], [&] {
      RawFacts facts;
      RawFrame frame = read_pose_file((fs::path(folder) / names[i]).string(), numbers[i], facts);
      decoder.begin(facts);
      return frame;
    });
  return decoder.finish();
}

KeypointReading read_folder(const std::string& folder, const KeypointReaderOptions& options) {
  const std::vector<std::string> names = pose_files_of(folder);
  US_CHECK(!names.empty(), folder, ": has no JSON files, so no poses");
  if (names.size() == 1) return read_keypoints((fs::path(folder) / names[0]).string(), options);
  return read_json_folder(folder, names, options);
}

/// "'shape': (240, 25, 3)" of an array's header: a last extent of 2, or of 3 behind one that is a layout's.
bool is_pose_header(const std::string& head) {
  const size_t open = head.find('(', std::min(head.find("'shape'"), head.size()));
  const size_t close = open == head.npos ? open : head.find(')', open);
  if (close == head.npos) return false;
  std::vector<int64_t> shape;
  for (const std::string& part : split(head.substr(open + 1, close - open - 1), ',')) {
    const size_t begin = part.find_first_not_of(' ');
    int64_t extent = 0;
    if (begin != part.npos && parse_integer(std::string_view(part).substr(begin), extent))
      shape.push_back(extent);
  }
  if (shape.size() < 2 || shape.size() > 4) return false;
  const int64_t points = shape[shape.size() - 2];
  return (shape.back() == 2 || shape.back() == 3) && (layout_of_count(points) || points == 15);
}

bool is_pose_text(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (begin == text.npos || (text[begin] != '{' && text[begin] != '[')) return false;
  for (const char* key : {"\"pose_keypoints", "\"people\"", "\"bodies\"", "\"keypoints\"",
                          "\"instance_info\"", "\"instances\"", "andmark", "\"visibility\""})
    if (text.find(key) != text.npos) return true;
  return false;
}

}  // namespace

std::vector<std::string> pose_files_of(const std::string& folder) {
  std::vector<std::string> names;
  for (std::string& name : folder_files(folder))
    if (name[0] != '.' && file_suffix(name) == ".json") names.push_back(std::move(name));
  std::sort(names.begin(), names.end(), natural_less);
  return names;
}

RawFrame read_pose_file(const std::string& path, int64_t number, RawFacts& facts) {
  OneFrame one;
  read_pose_json(parse_pose_json(read_file(path, kLargestFrame), path), path, one);
  facts = one.facts();
  facts.format = (facts.format == "OpenPose frame" ? "OpenPose" : facts.format) + " folder";
  return one.take(path, number);
}

std::optional<PictureBeside> picture_of_folder(const std::string& folder,
                                               const KeypointReaderOptions& options) {
  const std::string plain = fs::path(folder + "/").lexically_normal().parent_path().string();
  const std::vector<std::string> names = pose_files_of(folder);
  if (names.empty()) return picture_beside({plain}, options);
  const std::string first = without_suffix((fs::path(folder) / names.front()).string());
  return picture_beside({plain, first, without_keypoints(first)}, options);
}

KeypointReading parse_keypoints(const std::string& json, const std::string& source,
                                const KeypointReaderOptions& options) {
  FrameDecoder decoder(source, options, {});
  read_pose_json(parse_pose_json(json, source), source, decoder);
  return decoder.finish();
}

KeypointReading read_keypoints(const std::string& path, const KeypointReaderOptions& options) {
  std::error_code error;
  if (fs::is_directory(path, error)) return read_folder(path, options);
  const std::string stem = without_suffix(path);
  FrameDecoder decoder(path, options, picture_beside({stem, without_keypoints(stem)}, options));
  const std::string head = beginning_of(path, 6);
  US_CHECK(!head.empty(), path, ": is empty");
  if (starts_with(head, "\x93NUMPY") || starts_with(head, "PK"))
    read_pose_arrays(path, decoder);
  else
    read_pose_json(parse_pose_json(read_file(path, kLargestJson), path), path, decoder);
  return decoder.finish();
}

bool looks_like_keypoints(const std::string& path) {
  bool found = false;
  failure_of([&] {
    std::error_code error;
    if (fs::is_directory(path, error)) {
      const std::vector<std::string> names = pose_files_of(path);
      found = !names.empty() && looks_like_keypoints((fs::path(path) / names.front()).string());
      return;
    }
    const std::string head = beginning_of(path, kGlance);
    if (starts_with(head, "\x93NUMPY")) return void(found = is_pose_header(head));
    if (!starts_with(head, "PK")) return void(found = is_pose_text(head));
    const std::vector<std::string> names = npz_names(path);
    found = std::find(names.begin(), names.end(), "keypoints") != names.end();
  });
  return found;
}

}  // namespace understudy
