// What FrameDecoder makes of all frames together: gaps, canvas, performer, sentences. No pose changes here.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/scan_frames.hpp"
#include "retarget/keypoints/frame_decoder.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {
namespace {

constexpr int64_t kMissingForEach =
    20;  // more frames missing than so many times those there: numbers of another kind

/// The most frequent step between the frames' numbers; of several the shortest.
int64_t usual_frame_step(const std::vector<KeypointFrame>& frames) {
  std::map<int64_t, size_t> steps;
  for (size_t i = 1; i < frames.size(); ++i) ++steps[frames[i].number - frames[i - 1].number];
  const auto rarer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto most = std::max_element(steps.begin(), steps.end(), rarer);
  return most == steps.end() ? 1 : std::max<int64_t>(most->first, 1);
}

/// "240 frames", "1 frame".
std::string counted(int64_t count, const std::string& thing) {
  return grouped(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace

KeypointReading FrameDecoder::finish() {
  US_CHECK(!frames_.empty(), source_, ": has no frames");
  if (tracks_.empty()) {
    const auto bad =
        std::find_if(frames_.begin(), frames_.end(), [](const auto& f) { return !f.problem.empty(); });
    if (wants_canvas_) throw CanvasUnknownError(bad->problem);
    throw Error(bad != frames_.end() ? bad->problem
                                     : source_ + ": there is nobody in any of its " +
                                           counted(static_cast<int64_t>(frames_.size()), "frame"));
  }
  KeypointReading reading;
  reading.path = source_;
  reading.format = facts_.format;
  reading.layout = decided_->layout.label;
  reading.canvas = decided_->canvas;
  reading.fps = fps_;
  reading.fps_is_guessed = options_.fps == 0 && facts_.fps == 0;
  reading.frames = std::move(frames_);
  reading.tracks = std::move(tracks_);
  guess_canvas(reading);
  tell(reading);
  fill_gaps(reading);
  choose_performer(reading);
  tell_oddities(reading);
  return reading;
}

/// Frames that are missing take their places, so that a gap lasts as long as it lasted.
void FrameDecoder::fill_gaps(KeypointReading& reading) const {
  const std::vector<KeypointFrame> there = std::move(reading.frames);
  const int64_t usual = usual_frame_step(there),
                most = kMissingForEach * static_cast<int64_t>(there.size()) + kLongestGap;
  int64_t missing = 0, longest = 0, all = 0;
  for (size_t i = 1; i < there.size(); ++i) {
    const int64_t here = missing_between(there[i].number - there[i - 1].number, usual);
    all += here <= kLongestGap ? here : 0;
    missing += here;
    longest = std::max(longest, here);
  }
  const bool are_other = usual > kLongestGap || all > most;
  std::vector<int64_t> place;  // of each frame that is there
  std::vector<KeypointFrame> frames;
  for (size_t i = 0; i < there.size(); ++i) {
    const int64_t before = i > 0 ? there[i - 1].number : 0;
    const int64_t here = i > 0 ? missing_between(there[i].number - before, usual) : 0;
    for (int64_t k = 1; k <= here && here <= kLongestGap && !are_other; ++k)
      frames.push_back({before + k * usual, frame_of(source_, before + k * usual) + " is missing"});
    place.push_back(static_cast<int64_t>(frames.size()));
    frames.push_back(there[i]);
    if (are_other) frames.back().number = static_cast<int64_t>(i);
  }
  reading.frames = std::move(frames);
  for (KeypointTrack& track : reading.tracks)
    for (TrackedPose& pose : track.poses) pose.frame = place[static_cast<size_t>(pose.frame)];
  if (are_other)
    reading.told.push_back(source_ +
                           ": its numbers are not those of frames, which are counted 0, 1, 2 instead");
  else if (missing > 0)
    reading.told.push_back(source_ + ": " + counted(missing, "frame") + (missing == 1 ? " is" : " are") +
                           " missing" +
                           (longest > kLongestGap ? ", and gaps of more than a thousand are left out" : ""));
}

void FrameDecoder::guess_canvas(KeypointReading& reading) const {
  if (reading.canvas.is_known()) return;
  static constexpr std::array<std::pair<int, int>, 10> kUsual = {{{512, 512},
                                                                  {640, 480},
                                                                  {768, 512},
                                                                  {832, 480},
                                                                  {1024, 768},
                                                                  {1280, 720},
                                                                  {1024, 1024},
                                                                  {1920, 1080},
                                                                  {2048, 2048},
                                                                  {3840, 2160}}};
  const Vec2 far = extent_.isEmpty() ? Vec2(1, 1) : Vec2(extent_.max().cwiseMax(1));
  const auto holds = [&](int width, int height) {
    return far.x() <= static_cast<float>(width) && far.y() <= static_cast<float>(height);
  };
  reading.canvas_is_guessed = true;
  for (const auto& [longer, shorter] : kUsual) {
    if (holds(longer, shorter)) return void(reading.canvas = {longer, shorter});
    if (holds(shorter, longer)) return void(reading.canvas = {shorter, longer});
  }
  const auto even = [](float side) {
    return std::min(kLargestCanvas, 2 * static_cast<int>(std::ceil(std::min(side, 1e5f) / 2)));
  };
  reading.canvas = {even(far.x()), even(far.y())};
}

void FrameDecoder::choose_performer(KeypointReading& reading) const {
  std::stable_sort(
      reading.tracks.begin(), reading.tracks.end(),
      [](const KeypointTrack& a, const KeypointTrack& b) { return a.poses.size() > b.poses.size(); });
  if (options_.person) {
    reading.performer = reading.track_of(*options_.person);
    std::string known;
    for (size_t t = 0; t < std::min<size_t>(reading.tracks.size(), 10); ++t)
      append_item(known, std::to_string(reading.tracks[t].person));
    US_CHECK(reading.performer >= 0, source_, ": there is no person ", *options_.person, ", only ", known,
             reading.tracks.size() > 10 ? " and more" : "");
  }
  const KeypointTrack& track = reading.performing();
  if (reading.tracks.size() > 1)
    reading.told.push_back(source_ + ": person " + std::to_string(track.person) + " performs, seen in " +
                           grouped(static_cast<int64_t>(track.poses.size())) + " of " +
                           counted(static_cast<int64_t>(reading.frames.size()), "frame"));
}

void FrameDecoder::tell(KeypointReading& reading) const {
  const auto tell = [&](const std::string& what) { reading.told.push_back(source_ + ": " + what); };
  const size_t people = reading.tracks.size();
  tell(reading.format + ", " + reading.layout + ", " +
       counted(static_cast<int64_t>(reading.frames.size()), "frame") + ", " +
       (people == 1 ? "1 person" : grouped(static_cast<int64_t>(people)) + " people"));
  tell("canvas " + canvas_text(reading.canvas) +
       (reading.canvas_is_guessed ? " assumed, the smallest usual one that holds every point"
                                  : ", " + decided_->canvas_from));
  if (picture_ && !(picture_->canvas == reading.canvas))
    tell("the picture " + picture_->path + " is " + canvas_text(picture_->canvas) +
         ", the canvas of the poses " + canvas_text(reading.canvas) + ", which counts");
  if (decided_->scale != Scale::Pixels)
    tell(std::string("places are in ") + (decided_->scale == Scale::Signed ? "-1..1" : "0..1") +
         " of the canvas");
  tell(printed("%.6g", fps_) + " frames/s " +
       (options_.fps > 0         ? "as asked"
        : reading.fps_is_guessed ? "assumed"
                                 : "as the file says"));
  if (!tracker_.believes_ids())
    tell("two in one frame have the same number, so people are followed by where they are");
  if (left_out_ > 0)
    tell(counted(left_out_, "frame") + (left_out_ == 1 ? " is" : " are") +
         " there twice or out of order and left out, the first of them " + std::to_string(first_left_out_));
  const auto is_bad = [](const KeypointFrame& frame) { return !frame.problem.empty(); };
  const auto bad = std::count_if(reading.frames.begin(), reading.frames.end(), is_bad);
  if (bad > 0)
    tell(counted(bad, "frame") + " cannot be used, the first: " +
         std::find_if(reading.frames.begin(), reading.frames.end(), is_bad)->problem);
}

void FrameDecoder::tell_oddities(KeypointReading& reading) const {
  const auto tell = [&](int64_t count, const std::string& what) {
    if (count > 0) reading.told.push_back(source_ + ": " + counted(count, "point") + " " + what);
  };
  if (decided_->all_are_seen)
    reading.told.push_back(source_ +
                           ": no confidence is above 0 although there are places: all count as seen");
  if (decided_->is_logit) reading.told.push_back(source_ + ": visibilities are logits, not in 0..1");
  tell(odd_.above_one,
       "of a confidence above 1 (up to " + short_number(odd_.highest) + "), which counts as 1");
  tell(odd_.below_zero, "of a confidence below 0, which counts as missing");
  tell(odd_.not_finite, "whose numbers are none (NaN, null), which count as missing");
  tell(odd_.far_away, "absurdly far away, which count as missing");
  tell(odd_.off_canvas, "off the canvas, which stay where they are");
}

}  // namespace understudy
