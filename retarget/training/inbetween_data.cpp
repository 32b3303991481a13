#include "retarget/training/inbetween_data.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/modules/inbetween_input.hpp"

namespace understudy::training {
namespace {

constexpr int kShortestWindow = 8, kLongestWindow = 110;  // frames
constexpr int kMostEnd = 12;                              // known frames on one side of a gap

using Known = std::vector<KnownParts>;

float log_uniform(float least, float most, Rng& rng) {
  return least * std::pow(most / least, rng.uniform());
}

Known one_gap(int frames, int before, int after) {
  Known known(frames, all_parts(true));
  std::fill(known.begin() + before, known.end() - after, all_parts(false));
  return known;
}

Known every_nth(int frames, Rng& rng) {
  const int n = std::min(frames - 1, static_cast<int>(log_uniform(2, 40, rng)));
  Known known(frames, all_parts(false));
  for (int t = rng.below(n); t < frames; t += n) known[t] = all_parts(true);
  return known;
}

/// A gap in which some parts are seen all the time.
Known some_joints(Known known, Rng& rng) {
  const float share = rng.uniform(0.2f, 0.8f);
  KnownParts seen{};
  for (bool& part : seen) part = rng.chance(share);
  for (KnownParts& frame : known)
    for (size_t part = 0; part < kPartCount; ++part) frame[part] = frame[part] || seen[part];
  return known;
}

Known random_known(int frames, Rng& rng) {
  const int most = std::min(kMostEnd, (frames - 2) / 2);
  const int before = 1 + rng.below(most), after = 1 + rng.below(most);
  const float kind = rng.uniform();
  if (kind < 0.60f) return one_gap(frames, before, after);
  if (kind < 0.70f) return every_nth(frames, rng);
  if (kind < 0.90f) return one_gap(frames, 2 + rng.below(std::min(30, frames - 4)), 0);
  return some_joints(one_gap(frames, before, after), rng);
}

/// As an extractor errs: part of it stays, part changes with each frame.
void add_errors(Motion& motion, Rng& rng) {
  const float size = rng.uniform(0, 0.06f), stays = rng.uniform();  // radians
  const auto random_vector = [&rng](float sigma) {
    return Vec3(sigma * rng.normal(), sigma * rng.normal(), sigma * rng.normal());
  };
  std::array<Vec3, kPartCount> constant;
  for (Vec3& one : constant) one = random_vector(stays * size);
  for (Pose& pose : motion.poses) {
    for (int j = 0; j < kJointCount; ++j)
      pose.local[j] = pose.local[j] * rotation_from_axis_angle(constant[j] + random_vector(0.3f * size));
    pose.root += 0.2f * (constant[kRootPart] + random_vector(0.3f * size));
  }
}

}  // namespace

InbetweenData::InbetweenData(const TrainingData& data)
    : clips_(data.clips),
      rest_(data.body.shaped(Eigen::VectorXf::Zero(1)).joints),
      runs_(good_runs(data.clips, kShortestWindow, INT_MAX)),
      of_clip_(data.clips.size()) {
  rest_.rowwise() -= Eigen::RowVector3f(rest_.row(Pelvis));
  US_CHECK(!runs_.empty(), "no clip has ", kShortestWindow, " good frames in a row");
  for (int i = 0; i < ssize(runs_); ++i) of_clip_[runs_[i].clip].push_back(i);
  of_clip_.erase(
      std::remove_if(of_clip_.begin(), of_clip_.end(), [](const auto& mine) { return mine.empty(); }),
      of_clip_.end());
  for (const Clip& clip : data.clips) {
    std::vector<float> speeds;
    const auto& poses = clip.motion.poses;
    for (size_t t = 1; t < poses.size(); ++t) {
      const Vec3 way = poses[t].root - poses[t - 1].root;
      speeds.push_back(std::hypot(way.x(), way.z()) * kClipRate);
    }
    std::sort(speeds.begin(), speeds.end());
    travels_.push_back(!speeds.empty() && speeds[speeds.size() / 2] > 0.6f);
  }
}

const ClipRun& InbetweenData::random_run(int frames, Rng& rng) const {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    int chosen = rng.below(ssize(runs_));  // weighed by frames, or so that short, rare clips count
    if (rng.chance(0.5f)) {
      const auto& mine = of_clip_[rng.below(ssize(of_clip_))];
      chosen = mine[rng.below(ssize(mine))];
    } else if (rng.uniform() * 400 > static_cast<float>(runs_[chosen].count)) {
      continue;
    }
    if (runs_[chosen].count >= frames) return runs_[chosen];
  }
  return *std::max_element(runs_.begin(), runs_.end(),
                           [](const ClipRun& a, const ClipRun& b) { return a.count < b.count; });
}

Motion InbetweenData::random_motion(int frames, Rng& rng) const {
  const ClipRun& run = random_run(frames, rng);
  const float longest = static_cast<float>(run.count - 1) / static_cast<float>(frames - 1);
  const float step = std::min(longest, rng.chance(0.5f) ? 1.0f : rng.uniform(0.8f, 1.25f));
  const float start = static_cast<float>(run.first) + rng.uniform() * (static_cast<float>(run.count - 1) -
                                                                       step * static_cast<float>(frames - 1));
  const bool mirror = rng.chance(0.5f);
  Motion motion;
  for (int t = 0; t < frames; ++t) {
    const Pose pose = clips_.at(run.clip, start + step * static_cast<float>(t));
    motion.poses.push_back(mirror ? mirrored(pose) : pose);
  }
  return motion;
}

InbetweenBatch InbetweenData::batch_of(const std::vector<Window>& windows) const {
  const int64_t count = ssize(windows), frames = ssize(windows.front().truth.poses);
  InbetweenBatch batch;
  batch.rotations = torch::empty({count, frames, kJointCount, 3, 3});
  batch.root = torch::empty({count, frames, 3});
  std::vector<MotionWindow> seen;
  for (const Window& window : windows) {
    Motion curve = window.shown;
    fill_curves(window.known, 0, static_cast<int>(frames) - 1, curve);
    MotionWindow& to = seen.emplace_back();
    to.rest = rest_;
    to.outlook = Outlook::of(curve.poses[static_cast<size_t>(outlook_frame(window.known))]);
    to.curve = to.outlook.seen(std::move(curve.poses));
    to.distance = known_distances(window.known);
    nn::put_poses(to.outlook.seen(window.truth.poses), ssize(seen) - 1, batch.rotations, batch.root);
  }
  batch.input = nn::input_of(seen);
  return batch;
}

InbetweenBatch InbetweenData::batch(int frames, Rng& rng) const {
  const int length = static_cast<int>(log_uniform(kShortestWindow, kLongestWindow, rng));
  std::vector<Window> windows(static_cast<size_t>(std::max(4, frames / length)));
  for (Window& window : windows) {
    window.truth = random_motion(length, rng);
    window.known = random_known(length, rng);
    window.shown = window.truth;
    if (rng.chance(0.25f)) add_errors(window.shown, rng);
    // A part that no frame knows would be told as it truly is.
    for (size_t part = 0; part < kPartCount; ++part)
      if (std::none_of(window.known.begin(), window.known.end(), [part](const auto& k) { return k[part]; }))
        window.known.front()[part] = true;
  }
  return batch_of(windows);
}

std::optional<InbetweenBatch> InbetweenData::gaps(int gap, int ends, int every, bool travelling) const {
  const int length = gap + 2 * ends;
  std::vector<Window> windows;
  for (const ClipRun& run : runs_) {
    if (travelling && !travels_[run.clip]) continue;
    for (int first = run.first; first + length <= run.first + run.count; first += every) {
      Window& window = windows.emplace_back();
      for (int t = 0; t < length; ++t)
        window.truth.poses.push_back(clips_.at(run.clip, static_cast<float>(first + t)));
      window.shown = window.truth;
      window.known = one_gap(length, ends, ends);
    }
  }
  if (windows.empty()) return {};
  return batch_of(windows);
}

}  // namespace understudy::training
