#include "app/run/flat_performance.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/run/interrupt.hpp"
#include "app/run/pose_pictures.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/picture.hpp"
#include "retarget/keypoints/keypoint_follower.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"
#include "retarget/pose2d/limb_transfer.hpp"
#include "retarget/pose2d/proportion_estimate.hpp"
#include "retarget/pose2d/reference_remarks.hpp"

namespace understudy::app {
namespace {
namespace fs = std::filesystem;

constexpr const char* kFormat = "understudy_proportions";
constexpr int kFormatVersion = 1;
constexpr uint64_t kLargestProportions = 1 << 20;

std::optional<Canvas> canvas_of_picture(const std::string& path) {
  try {
    const Pixels pixels = decode_picture(read_file(path));
    return Canvas{pixels.width, pixels.height};
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// The pose in which most is seen; of equal ones the first.
const FlatPose& clearest_pose(const KeypointTrack& track) {
  const auto best = std::max_element(
      track.poses.begin(), track.poses.end(),
      [](const TrackedPose& a, const TrackedPose& b) { return points_seen(a.pose) < points_seen(b.pose); });
  return best->pose;
}

/// Before the frame they were not known.
Proportions known_by_now(const ProportionEstimate& estimate) {
  return estimate.poses() > 0 ? estimate.lengths() : Proportions{};
}

bool tells_lengths(const FlatPose& pose) {
  return (seen_lengths(pose) > 0).count() >= 3;
}

void look_at(const FlatPose& pose, const LengthReader& lengths, ProportionEstimate& estimate) {
  if (tells_lengths(pose)) estimate.push(pose, lengths.read(pose));
}

std::unique_ptr<KeypointTransfer> made_engine(const FlatOptions& options, const FlatTools& tools,
                                              double fps) {
  flat_engine_named(options.engine);  // throws where there is none
  if (tools.engine) return tools.engine({options.engine, options.touches, fps});
  auto limbs = std::make_unique<LimbTransfer>(options.touches);
  US_CHECK(options.engine == limbs->name(), "the engine '", options.engine, "' needs weights");
  return limbs;
}

Canvas canvas_of_result(const Canvas& source, const FlatTarget& target, FlatPlace place) {
  const bool there = place == FlatPlace::Reference && target.standing;
  return there && target.canvas.is_known() ? target.canvas : source;
}

KeypointReading empty_result(const KeypointReading& source, const FlatTarget& target, FlatPlace place) {
  KeypointReading result;
  result.format = source.format;
  result.layout = source.layout;
  result.canvas = canvas_of_result(source.canvas, target, place);
  result.fps = source.fps;
  result.frames = source.frames;
  for (KeypointFrame& frame : result.frames) frame.problem.clear();
  result.tracks.resize(1);
  result.tracks[0].person = 1;
  return result;
}

KeypointReaderOptions reader_options(const FlatSourceOptions& options, std::string* picture) {
  KeypointReaderOptions reading;
  reading.canvas = options.canvas;
  reading.fps = options.fps;
  reading.layout = options.layout;
  reading.picture_size = [picture](const std::string& path) {
    const std::optional<Canvas> canvas = canvas_of_picture(path);
    if (canvas && picture != nullptr) *picture = path;
    return canvas;
  };
  if (!options.person.empty()) {
    int64_t person = 0;
    US_CHECK(parse_integer(options.person, person), "a person of 2D poses is a number, not '", options.person,
             "'");
    reading.person = person;
  }
  return reading;
}

}  // namespace

KeypointReading open_keypoints(const FlatSourceOptions& options, std::string* picture) {
  return read_keypoints(options.path, reader_options(options, picture));
}

Proportions proportions_of(const KeypointReading& reading, const LengthReader& lengths) {
  ProportionEstimate estimate;
  for (const TrackedPose& tracked : reading.performing().poses) {
    FlatPose pose = tracked.pose;
    add_middles(pose);
    look_at(pose, lengths, estimate);
  }
  US_CHECK(estimate.poses() > 0, reading.path, ": nobody is seen well enough to tell their proportions");
  return estimate.lengths();
}

std::string evidence_of(const Proportions& lengths) {
  std::string doubtful;
  for (int b = 0; b < kFlatBoneCount; ++b)
    if (lengths.doubt[b] > kUncertainLength)
      append_item(doubtful, lower_case(kFlatBones[static_cast<size_t>(b)].label));
  const std::string poses = lengths.poses == 1 ? "one pose" : grouped(lengths.poses) + " poses";
  return "from " + poses + (doubtful.empty() ? "" : "; uncertain: " + doubtful);
}

FlatTarget flat_target(const KeypointReading& reading, const LengthReader& lengths) {
  FlatTarget target;
  target.lengths = proportions_of(reading, lengths);
  FlatPose standing = clearest_pose(reading.performing());
  add_middles(standing);
  target.canvas = reading.canvas;
  target.remarks = reference_remarks(standing, target.lengths);
  // Where the feet are the highest, nobody shall stand on them.
  if (is_upside_down(standing)) forget_feet(standing);
  target.standing = standing;
  return target;
}

bool is_proportions_file(const std::string& path) {
  std::error_code failed;
  if (!fs::is_regular_file(path, failed) || fs::file_size(path, failed) > kLargestProportions) return false;
  const Json json = Json::parse(read_file(path), nullptr, false);
  return json.is_object() && json.contains(kFormat);
}

Json to_json(const Proportions& lengths) {
  Json bones;
  for (size_t b = 0; b < kFlatBones.size(); ++b)
    bones[kFlatBones[b].name] = {{"length", lengths.length[static_cast<int>(b)]},
                                 {"doubt", lengths.doubt[static_cast<int>(b)]}};
  return bones;
}

void write_proportions(const std::string& path, const Proportions& lengths) {
  write_json(
      path,
      {{kFormat, kFormatVersion}, {"unit", "pixels"}, {"poses", lengths.poses}, {"bones", to_json(lengths)}});
}

Proportions read_proportions(const std::string& path) {
  US_CHECK(fs::file_size(path) <= kLargestProportions, path, ": too large for proportions");
  const Json json = Json::parse(read_file(path), nullptr, false);
  US_CHECK(json.is_object() && json.contains(kFormat) && json[kFormat] == kFormatVersion, path,
           ": no proportions of version ", kFormatVersion);
  Proportions lengths;
  const auto number = [&](const Json& of, const char* key, const std::string& name, double most) {
    US_CHECK(of.is_object() && of.contains(key) && of[key].is_number() && of[key].get<double>() >= 0 &&
                 of[key].get<double>() <= most,
             path, ": ", key, " of ", name, " is no number from 0 to ", most);
    return of[key].get<float>();
  };
  if (json.contains("poses")) lengths.poses = static_cast<int>(number(json, "poses", "the person", 1e9));
  for (size_t b = 0; b < kFlatBones.size(); ++b) {
    const std::string name = kFlatBones[b].name;
    US_CHECK(json.contains("bones") && json["bones"].is_object() && json["bones"].contains(name), path,
             ": has no ", name);
    const Json& bone = json["bones"][name];
    lengths.length[static_cast<int>(b)] = number(bone, "length", name, kLargestCanvas);
    US_CHECK(lengths.length[static_cast<int>(b)] > 0, path, ": the length of ", name, " is 0");
    lengths.doubt[static_cast<int>(b)] = bone.contains("doubt") ? number(bone, "doubt", name, 100) : 0;
  }
  return lengths;
}

FlatTarget open_flat_target(const FlatSourceOptions& options, const LengthReader& lengths,
                            std::vector<std::string>& told) {
  FlatTarget target;
  if (is_proportions_file(options.path)) {
    target.lengths = read_proportions(options.path);
    told.push_back("the target is proportions alone: it stands where the source stands");
    return target;
  }
  const KeypointReading reading = open_keypoints(options);
  told.insert(told.end(), reading.told.begin(), reading.told.end());
  target = flat_target(reading, lengths);
  for (const std::string& remark : target.remarks) told.push_back(options.path + ": who performs " + remark);
  told.push_back("the target's proportions are " + evidence_of(target.lengths));
  return target;
}

FlatPerformer::FlatPerformer(const FlatTarget& target, const FlatOptions& options, const FlatTools& tools,
                             double fps)
    : retargeter_(made_engine(options, tools, fps), target, options.place),
      lengths_(tools.lengths),
      keeps_size_(!options.growth) {}

FlatPose FlatPerformer::push(const CleanPose& clean, double dt) {
  if (!ahead_ && clean.is_usable) look_at(clean.pose, *lengths_, estimate_);
  if (!ahead_ && estimate_.poses() == 0) return {};
  const Proportions source = source_lengths();
  if (keeps_size_ && clean.is_usable && tells_lengths(clean.pose))
    growth_.push(lengths_->read(clean.pose), source, dt);
  return retargeter_.push(clean, source, growth_.growth());
}

Proportions FlatPerformer::source_lengths() const {
  return ahead_ ? *ahead_ : known_by_now(estimate_);
}

FlatTrack perform_track(const KeypointReading& source, const std::vector<CleanPose>& clean,
                        const std::optional<Proportions>& source_lengths, const FlatTarget& target,
                        const FlatOptions& options, const FlatTools& tools) {
  FlatTrack made;
  made.result = empty_result(source, target, options.place);
  FlatPerformer performer(target, options, tools, source.fps);
  if (source_lengths) performer.set_source_lengths(*source_lengths);
  for (size_t frame = 0; frame < clean.size(); ++frame) {
    check_interrupt("before frame " + std::to_string(frame));
    const auto t = static_cast<int64_t>(frame);
    const double dt = frame > 0 ? source.seconds(t) - source.seconds(t - 1) : 1 / source.fps;
    FlatPose pose = performer.push(clean[frame], dt);
    made.result.frames[frame].problem = clean[frame].problem;
    made.flagged += clean[frame].is_usable ? 0 : 1;
    if (!is_nobody(pose)) made.result.tracks[0].poses.push_back({t, 1, std::move(pose)});
  }
  made.source_lengths = performer.source_lengths();
  return made;
}

FlatPerformance perform_flat(const FlatOptions& options, const FlatTools& tools) {
  FlatPerformance made;
  made.source = open_keypoints(options.source);
  made.told = made.source.told;
  const FlatTarget target = open_flat_target(options.target, *tools.lengths, made.told);
  made.target_lengths = target.lengths;
  std::optional<Proportions> ahead;
  if (options.ahead) {
    ahead = proportions_of(made.source, *tools.lengths);
    made.told.push_back("the source's proportions are " + evidence_of(*ahead) +
                        ", read off the whole file before its first frame");
  }
  KeypointFilterOptions filter;
  filter.smoothing = options.smoothing;
  const std::vector<CleanPose> clean = clean_track(made.source, made.source.performer, filter);
  FlatTrack track = perform_track(made.source, clean, ahead, target, options, tools);
  made.result = std::move(track.result);
  made.source_lengths = track.source_lengths;
  made.flagged = track.flagged;
  return made;
}

FlatPerformance follow_flat(const FlatOptions& options, const FlatTools& tools,
                            const std::function<void(const KeypointReading&)>& done) {
  FlatPerformance made;
  const FlatTarget target = open_flat_target(options.target, *tools.lengths, made.told);
  made.target_lengths = target.lengths;
  FolderFollowOptions follow;
  follow.cancelled = interrupted;
  KeypointFollower follower(options.source.path, reader_options(options.source, nullptr), follow);
  KeypointFilterOptions filtering;
  filtering.smoothing = options.smoothing;
  KeypointFilter filter(filtering);
  FlatPerformer performer(target, options, tools, follower.fps());
  std::vector<KeypointFrame> frames;
  KeypointTrack track;
  track.person = 1;
  while (const auto frame = follower.next()) {
    const CleanPose clean = filter.push(frame->pose ? &*frame->pose : nullptr, frame->dt, frame->problem);
    KeypointReading one;
    one.fps = follower.fps();
    one.canvas = canvas_of_result(follower.canvas(), target, options.place);
    one.frames = {{frame->number, clean.problem}};
    one.tracks = {{track.person, {}}};
    FlatPose pose = performer.push(clean, frame->dt);
    if (!is_nobody(pose)) {
      one.tracks[0].poses.push_back({0, 1, pose});
      track.poses.push_back({static_cast<int64_t>(frames.size()), 1, std::move(pose)});
    }
    frames.push_back(one.frames[0]);
    made.flagged += clean.is_usable ? 0 : 1;
    done(one);
  }
  check_interrupt("after " + std::to_string(frames.size()) + " frames");
  made.source = follower.finish();
  made.told.insert(made.told.end(), made.source.told.begin(), made.source.told.end());
  made.source_lengths = performer.source_lengths();
  made.result = empty_result(made.source, target, options.place);
  made.result.frames = std::move(frames);
  made.result.tracks[0] = std::move(track);
  return made;
}

void check_flat_output(const std::string& path) {
  for (const char* suffix : {"", ".mp4", ".json", ".csv", ".npz"})
    if (file_suffix(path) == suffix) return;
  throw Error(path + ": 2D poses are written as .json, .csv, .npz, or pictures: .mp4 or a folder");
}

void write_flat(const std::string& path, const KeypointReading& reading, const PoseChoice& choice) {
  check_flat_output(path);
  const std::string suffix = file_suffix(path);
  if (suffix == ".csv")
    write_keypoint_csv(path, reading);
  else if (suffix == ".npz")
    write_keypoint_npz(path, reading);
  else
    write_pose_pictures(path, reading, choice);
}

}  // namespace understudy::app
