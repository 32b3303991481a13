#include "app/run/step_index.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "app/run/fields_json.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/motion/moving_person.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/motion/skeletal_motion.hpp"
#include "retarget/motion_space/knot_coder.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr JsonFileKind kEntryKind{"understudy-steps", "an entry of an index of steps", "such entries", 2};
constexpr int kMostAnimations = 1000;

FileMotion motion_of(const Character& character, const std::string& clip, const std::string& path) {
  SkeletalMotionOptions options;
  options.clip = clip;
  const SkeletalMotion skeletal(character, options);
  FileMotion file;
  file.clip = std::to_string(skeletal.clip() + 1);
  file.is_longest = skeletal.clip() == chosen_clip(character, "");
  file.clip_name = character.animations[skeletal.clip()].name;
  MovingPerson person = moving_person(skeletal);
  file.motion = std::move(person.motion), file.rest = person.rest;
  if (file_suffix(path) == ".npz") {
    const std::vector<uint8_t> flags = read_amass_arrays(path).flags;
    for (size_t t = 0; t < flags.size() && t < file.motion.flags.size(); ++t)
      file.motion.flags[t] |= flags[t];
  }
  return file;
}

Character character_of(const std::string& path) {
  std::optional<Character> character = read_motion(path);
  US_CHECK(character, path, ": holds no skeletal motion");
  return std::move(*character);
}

}  // namespace

std::vector<FileMotion> read_file_motions(const std::string& path) {
  const Character character = character_of(path);
  std::vector<FileMotion> motions;
  const int count = static_cast<int>(ssize(character.animations));
  US_CHECK(count <= kMostAnimations, path, ": has ", count, " animations, more than ", kMostAnimations);
  motions.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) motions.push_back(motion_of(character, std::to_string(i + 1), path));
  return motions;
}

FileMotion read_file_motion(const std::string& path, const std::string& clip) {
  return motion_of(character_of(path), clip, path);
}

std::vector<std::string> motion_files(const std::vector<std::string>& paths) {
  std::set<std::string> files;
  const auto add = [&](const fs::path& path) {
    files.insert(fs::absolute(path).lexically_normal().string());
  };
  for (const std::string& path : paths) {
    std::error_code failed;
    US_CHECK(fs::exists(path, failed), path, ": there is no such file or folder");
    if (!fs::is_directory(path, failed)) {
      US_CHECK(can_be(path, kMotion), path, ": is no skeletal motion (", format_names(kMotion), ")");
      add(path);
      continue;
    }
    const auto how = fs::directory_options::skip_permission_denied;
    for (const auto& entry : fs::recursive_directory_iterator(path, how))
      if (entry.is_regular_file(failed) && can_be(entry.path().string(), kMotion)) add(entry.path());
  }
  return {files.begin(), files.end()};
}

MapEncoders::MapEncoders(const std::function<std::shared_ptr<MotionCoder>()>& load_coder,
                         const std::function<std::shared_ptr<MotionSpace>()>& load_space)
    : plain_(make_knot_coder()) {
  std::string problem =
      load_coder ? failure_of([&] { steps_ = load_coder(); }) : "there is no learned coder of movements";
  if (!steps_) log::warn(problem + ": steps are compared pose by pose");
  problem = load_space ? failure_of([&] { space_ = load_space(); }) : "there is no learned space of motion";
  if (!space_ || space_->encoder() == nullptr)
    log::warn((problem.empty() ? "the motion space has no codes" : problem) +
              ": movements that are no steps are compared pose by pose");
}

MovementEncoder& MapEncoders::of(MapOf kind) {
  if (kind == MapOf::Steps && steps_) return *steps_;
  MovementEncoder* const others = space_ ? space_->encoder() : nullptr;
  return kind == MapOf::Others && others != nullptr ? *others : *plain_;
}

namespace {

struct StoredStep {
  int first = 0, last = 0;
  bool left_first = false;
  float seconds = 0, speed_m_s = 0;
  std::vector<float> code;
  std::string figure;  // four hexadecimal digits a number, two's complement
};
template <class V, class S>
FieldsOf<S, StoredStep> fields(V& visit, S& step) {
  visit("first", step.first, kFrameNumbers);
  visit("last", step.last, kFrameNumbers);
  visit("left_first", step.left_first);
  visit("seconds", step.seconds);
  visit("speed_m_s", step.speed_m_s);
  visit("code", step.code);
  visit("figure", step.figure);
}

struct StoredMotion {
  std::string clip, name, action;
  bool is_longest = true;
  float fps = 30;
  int frames = 0;
  std::vector<float> rest;
  std::vector<StoredStep> steps, others;
};
template <class V, class S>
FieldsOf<S, StoredMotion> fields(V& visit, S& motion) {
  visit("clip", motion.clip);
  visit("is_longest", motion.is_longest);
  visit("name", motion.name);
  visit("action", motion.action);
  visit("fps", motion.fps);
  visit("frames", motion.frames, kFrameNumbers);
  visit("rest", motion.rest);
  visit("steps", motion.steps);
  visit("others", motion.others);
}

/// What the index knows of a file.
struct Entry {
  std::string path, coder, checksum, modified;
  double size = 0;        // bytes
  bool is_motion = true;  // false: it is of another kind, and passed over
  std::vector<StoredMotion> motions;
};
template <class V, class S>
FieldsOf<S, Entry> fields(V& visit, S& entry) {
  constexpr Within<double> kAny{0, 1e18};
  visit("path", entry.path);
  visit("coder", entry.coder);
  visit("checksum", entry.checksum);
  visit("size", entry.size, kAny);
  visit("modified", entry.modified);
  visit("is_motion", entry.is_motion);
  visit("motions", entry.motions);
}

std::string hex_of(const std::vector<int16_t>& numbers) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(4 * numbers.size());
  for (const int16_t number : numbers)
    for (int shift = 12; shift >= 0; shift -= 4)
      text += kDigits[(static_cast<uint16_t>(number) >> shift) & 15];
  return text;
}

std::vector<int16_t> numbers_of(const std::string& hex) {
  US_CHECK(hex.size() == 4 * kFigureNumbers, "a figure of ", hex.size() / 4, " numbers");
  std::vector<int16_t> numbers;
  numbers.reserve(kFigureNumbers);
  for (size_t i = 0; i < hex.size(); i += 4) {
    uint16_t value = 0;
    const auto read = std::from_chars(hex.data() + i, hex.data() + i + 4, value, 16);
    US_CHECK(read.ptr == hex.data() + i + 4, "a figure has a number that is none");
    numbers.push_back(static_cast<int16_t>(value));
  }
  return numbers;
}

/// A motion with its steps and with what else is in it.
struct TwoMaps {
  MappedMotion steps, others;
};

std::vector<StoredStep> stored(const std::vector<MappedStep>& steps) {
  std::vector<StoredStep> out;
  out.reserve(steps.size());
  for (const MappedStep& step : steps)
    out.push_back({step.first, step.last, step.left_first, step.seconds, step.speed_m_s, step.code,
                   hex_of(step.figure)});
  return out;
}

StoredMotion stored(const TwoMaps& maps) {
  const MappedMotion& motion = maps.steps;
  StoredMotion out{motion.clip, motion.name, motion.action, motion.is_longest, motion.fps, motion.frames, {},
                   {},          {}};
  out.rest.assign(motion.rest.data(), motion.rest.data() + motion.rest.size());
  out.steps = stored(motion.steps), out.others = stored(maps.others.steps);
  return out;
}

/// Throws Error where they cannot have been written so.
std::vector<MappedStep> restored(std::vector<StoredStep> steps, int frames, int code_size) {
  std::vector<MappedStep> out;
  out.reserve(steps.size());
  for (StoredStep& step : steps) {
    US_CHECK(step.first < step.last && step.last < frames, "a step that is not in its motion");
    US_CHECK(ssize(step.code) == code_size, "a code of ", step.code.size(), " numbers");
    US_CHECK(step.seconds > 0, "a step that takes no time");
    out.push_back({step.first, step.last, step.left_first, step.seconds, step.speed_m_s, std::move(step.code),
                   numbers_of(step.figure)});
  }
  return out;
}

TwoMaps restored(StoredMotion motion, const std::string& path, MapEncoders& encoders) {
  MappedMotion out;
  out.path = path;
  out.clip = std::move(motion.clip), out.name = std::move(motion.name), out.action = std::move(motion.action);
  out.is_longest = motion.is_longest;
  out.fps = motion.fps, out.frames = motion.frames;
  US_CHECK(ssize(motion.rest) == out.rest.size(), "a body of ", motion.rest.size(), " numbers");
  std::copy(motion.rest.begin(), motion.rest.end(), out.rest.data());
  TwoMaps maps{out, out};
  maps.steps.steps = restored(std::move(motion.steps), out.frames, encoders.of(MapOf::Steps).size());
  maps.others.steps = restored(std::move(motion.others), out.frames, encoders.of(MapOf::Others).size());
  return maps;
}

/// The actions that an AMASS-format file tells, else the words of its name.
std::string action_of(const std::string& path) {
  std::vector<std::string> labels;
  if (file_suffix(path) == ".npz") labels = clip_labels(path);
  return labels.empty() ? action_of_name(path) : labels.front();
}

/// When it was last written, to be compared alone.
std::string time_of(const std::string& path) {
  std::error_code failed;
  const auto time = fs::last_write_time(path, failed);
  return failed ? "" : std::to_string(time.time_since_epoch().count());
}

/// Tells coders apart: what it makes of the built-in walk.
std::string mark_of(MovementEncoder& coder) {
  const Joints rest = builtin_joints();
  std::string text;
  for (const float number : coder.encode(movement_of(builtin_motion("walk", rest), 10, 44), rest).mean)
    append_fixed(text, number, 3), text += ' ';
  return coder.name() + " " + checksum_text(fnv1a(text));
}

/// The index while files are looked up in it.
class Index {
 public:
  Index(MapEncoders& encoders, const std::string& folder)
      : encoders_(encoders),
        mark_(mark_of(encoders.of(MapOf::Steps)) + ", " + mark_of(encoders.of(MapOf::Others))),
        folder_(folder) {
    if (folder_.empty()) return;
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed) refuse(folder_ + ": cannot be made: " + failed.message());
  }

  const std::string& coder() const { return mark_; }
  /// What is known of a file, from the index or read now.
  void add(const std::string& path, IndexedSteps& all) {
    Entry entry;
    std::vector<TwoMaps> motions;
    std::string problem;
    if (!known(path, entry, motions, all)) {
      problem = failure_of([&] { read(path, entry, motions); });
      all.read += entry.is_motion ? 1 : 0;
      if (problem.empty()) keep(entry);
    }
    if (!entry.is_motion) return;
    ++all.files;
    if (!problem.empty()) return all.problems.push_back(problem);
    const size_t before = all.motions.size();
    for (TwoMaps& motion : motions) {
      if (!motion.steps.steps.empty()) all.motions.push_back(std::move(motion.steps));
      if (!motion.others.steps.empty()) all.others.push_back(std::move(motion.others));
    }
    if (all.motions.size() == before) all.without_steps.push_back(path);
  }

 private:
  std::string place(const std::string& path) const {
    return folder_ + "/" + checksum_text(fnv1a(path)) + ".json";
  }

  bool known(const std::string& path, Entry& entry, std::vector<TwoMaps>& motions, IndexedSteps& all) {
    std::error_code failed;
    if (folder_.empty() || !fs::exists(place(path), failed)) return false;
    try {
      const Json json = read_json(place(path));
      check_kind(json, place(path), kEntryKind);
      FieldsReader reader(json, folder_, "");
      fields(reader, entry);
      const auto size = static_cast<double>(fs::file_size(path, failed));
      const std::string modified = time_of(path);
      if (entry.path != path || entry.coder != mark_ || entry.size != size) return false;
      const bool same_time = entry.modified == modified;
      if (!same_time && entry.checksum != checksum_of_file(path)) return false;
      for (StoredMotion& motion : entry.motions)
        motions.push_back(restored(std::move(motion), path, encoders_));
      entry.modified = modified;
      if (!same_time) {
        entry.motions.clear();
        for (const TwoMaps& motion : motions) entry.motions.push_back(stored(motion));
        keep(entry);
      }
      return true;
    } catch (const std::exception&) {  // what is wrong with it matters to nobody: it is made again
      ++all.damaged;
      motions.clear();
      return false;
    }
  }

  void read(const std::string& path, Entry& entry, std::vector<TwoMaps>& motions) {
    entry = {};
    entry.path = path, entry.coder = mark_;
    std::error_code failed;
    entry.size = static_cast<double>(fs::file_size(path, failed));
    entry.modified = time_of(path);
    if (!folder_.empty()) entry.checksum = checksum_of_file(path);
    entry.is_motion = is_motion_file(path) || is_animated_gltf(path, UINT64_MAX).value_or(false);
    if (!entry.is_motion) return;
    for (const FileMotion& file : read_file_motions(path)) motions.push_back(mapped(file, path));
    for (const TwoMaps& motion : motions) entry.motions.push_back(stored(motion));
  }

  TwoMaps mapped(const FileMotion& file, const std::string& path) {
    MappedMotion motion;
    motion.path = path, motion.clip = file.clip, motion.is_longest = file.is_longest;
    motion.name = file_name(path);
    if (file.clip != "1") motion.name += ": " + excerpt(file.clip_name);
    motion.action = action_of(path);
    motion.fps = file.motion.fps, motion.frames = static_cast<int>(ssize(file.motion.poses));
    motion.rest = file.rest;
    TwoMaps maps{motion, motion};
    maps.steps.steps = coded_steps(file.motion, file.rest, encoders_.of(MapOf::Steps));
    maps.others.steps =
        coded_movements(file.motion, maps.steps.steps, file.rest, encoders_.of(MapOf::Others));
    return maps;
  }

  void keep(const Entry& entry) {
    if (folder_.empty() || is_refused_) return;
    const std::string problem = failure_of([&] {
      Json json = {{"format", kEntryKind.format}, {"version", kEntryKind.version}};
      FieldsWriter writer(json, folder_, "");
      fields(writer, entry);
      write_file(place(entry.path), json.dump(-1, ' ', false, Json::error_handler_t::replace),
                 /*synced=*/false);
    });
    if (!problem.empty()) refuse(problem);
  }

  void refuse(const std::string& why) {
    log::warn(why + "; nothing is kept for the next time");
    is_refused_ = true;
  }

  MapEncoders& encoders_;
  const std::string mark_;
  const std::string folder_;
  bool is_refused_ = false;
};

}  // namespace

IndexedSteps index_steps(const std::vector<std::string>& files, MapEncoders& encoders,
                         const StepIndexOptions& options) {
  IndexedSteps all;
  Index index(encoders, options.folder);
  all.coder = index.coder();
  const int count = static_cast<int>(ssize(files));
  for (int i = 0; i < count; ++i) {
    if (options.progress) options.progress(i, count);
    index.add(files[i], all);
  }
  if (options.progress) options.progress(count, count);
  return all;
}

std::vector<NearStep> like_this(const MotionMap& map, MapOf kind, const MotionRange& range,
                                MapEncoders& encoders, int count) {
  const Motion& motion = range.motion.motion;
  const std::string name = range.path.empty() ? "the open motion" : range.path;
  const int frames = static_cast<int>(ssize(motion.poses));
  US_CHECK(range.first >= 0 && range.first < range.last && range.last < frames, name, ": has no frames ",
           range.first, " to ", range.last, ", there are 0 to ", frames - 1);
  const auto coded = kind == MapOf::Steps ? coded_steps : coded_stretches;
  std::vector<std::vector<float>> codes;
  for (MappedStep& step : coded(motion, range.motion.rest, encoders.of(kind), range.first, range.last))
    codes.push_back(std::move(step.code));
  US_CHECK(
      !codes.empty(), name, ": ",
      kind == MapOf::Steps ? "nobody makes a whole step (0.3 to 3 s) in" : "less than half a second is in",
      " frames ", range.first, " to ", range.last);
  return map.nearest(codes, count, [&](int i) {
    const MappedMotion& other = map.motion_of(i);
    return other.path == range.path && other.clip == range.motion.clip && map.step(i).first <= range.last &&
           range.first <= map.step(i).last;
  });
}

std::string step_words(const MotionMap& map, int step) {
  return map.motion_of(step).name + ", frames " + std::to_string(map.step(step).first) + " to " +
         std::to_string(map.step(step).last);
}

std::string index_words(const IndexedSteps& indexed) {
  int64_t steps = 0, others = 0;
  for (const MappedMotion& motion : indexed.motions) steps += ssize(motion.steps);
  for (const MappedMotion& motion : indexed.others) others += ssize(motion.steps);
  std::string words = grouped(indexed.files) + (indexed.files == 1 ? " file, " : " files, ") +
                      grouped(indexed.read) + " read anew, " + grouped(steps) + " steps in " +
                      grouped(ssize(indexed.motions)) + " motions";
  if (others > 0) words += ", " + grouped(others) + (others == 1 ? " other movement" : " other movements");
  if (indexed.damaged == 1) words += "; 1 entry of the index was damaged and is made again";
  if (indexed.damaged > 1)
    words += "; " + grouped(indexed.damaged) + " entries of the index were damaged and are made again";
  return words;
}

}  // namespace understudy::app
