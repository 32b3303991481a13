#include "retarget/motion_space/learned_space.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/curve_doubt.hpp"
#include "retarget/skeleton/foot_hold.hpp"

namespace understudy {
namespace {

/// From which on a foot stands: on dev this gives the smallest errors, and feet that slide least.
constexpr float kStands = 0.3f;

/// Up to so long, between wholly known frames, a gap stays the curve: on dev that is nearer to the truth.
constexpr float kShortGap_s = 0.17f;

/// How much of what the network adds is kept: it errs towards moving too much between known frames and too
/// little where a motion goes on. On dev these give the smallest errors.
constexpr float kKeptBetween = 0.95f, kKeptBeyond = 1.05f;

/// How far other answers' codes lie from the best one's, in each number.
constexpr float kCodeStep = 1;

/// What is added to a pose of the curve: turns in the joints' own frames, and a way of the root.
using Change = std::array<Vec3, kPartCount>;

Change change_from(const Pose& curve, const Pose& made) {
  Change change;
  for (int j = 0; j < kJointCount; ++j)
    change[j] = rotation_to_axis_angle(curve.local[j].transpose() * made.local[j]);
  change[kRootPart] = made.root - curve.root;
  return change;
}

/// What is known of a sample of a window, or what was made of it by a network and its mirror image.
struct Sample {
  Change change{};
  std::array<float, 2> standing{};
  float doubt_m = 0;
};

std::vector<Sample> samples_of(const MotionWindow& window, const WindowAnswer& direct,
                               const WindowAnswer& mirror) {
  std::vector<Sample> samples(window.curve.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    const Change one = change_from(window.curve[i], direct.poses[i]),
                 other = change_from(window.curve[i], mirrored(mirror.poses[i]));
    for (size_t part = 0; part < kPartCount; ++part)
      samples[i].change[part] = 0.5f * (one[part] + other[part]);
    for (size_t side = 0; side < 2; ++side)
      samples[i].standing[side] = 0.5f * (direct.standing[i][side] + mirror.standing[i][1 - side]);
    samples[i].doubt_m = 0.5f * (direct.doubt_m[i] + mirror.doubt_m[i]);
  }
  return samples;
}

void change(const Sample& sample, const KnownParts& known, const Mat3& heading, Pose& pose) {
  for (int j = 0; j < kJointCount; ++j)
    if (!known[j]) pose.local[j] = pose.local[j] * rotation_from_axis_angle(sample.change[j]);
  if (!known[kRootPart]) pose.root += heading * sample.change[kRootPart];
}

Joints joints_of(const MotionWindow& window, size_t i, const Sample& sample) {
  Pose pose = window.curve[i];
  change(sample, all_parts(false), Mat3::Identity(), pose);
  return forward_kinematics(window.rest, pose).joints;
}

/// What another answer tells beside the best one: that it is as doubtful as that (told a code, the network is
/// surer than it should be), and off by the way between both, too. A foot that stands in one of them stands.
std::vector<Sample> beside_the_best(const MotionWindow& window, const std::vector<Sample>& best,
                                    std::vector<Sample> other) {
  for (size_t i = 0; i < other.size(); ++i) {
    const Joints here = joints_of(window, i, best[i]), there = joints_of(window, i, other[i]);
    other[i].doubt_m = std::hypot(best[i].doubt_m, (there - here).rowwise().norm().mean());
    for (size_t side = 0; side < 2; ++side)
      other[i].standing[side] = std::max(other[i].standing[side], best[i].standing[side]);
  }
  return other;
}

WindowCode in_mirror(WindowCode code) {
  for (size_t i = code.size() / 2; i < code.size(); ++i) code[i] = -code[i];
  return code;
}

/// The window with the movement of these samples in place of its curve.
MotionWindow of_movement(MotionWindow window, const std::vector<Sample>& samples) {
  const std::vector<KnownParts> known = known_of(window);
  for (size_t i = 0; i < samples.size(); ++i) change(samples[i], known[i], Mat3::Identity(), window.curve[i]);
  return window;
}

/// Codes about that of the best answer, in directions that are at right angles to each other: rows of
/// Hadamard's matrix. Numbers that a mirror changes go away from the middle, or towards it, so that the
/// mirrored question has the mirrored answers.
WindowCode other_code(WindowCode best, int variation) {
  for (size_t i = 0; i < best.size(); ++i) {
    const int ones = std::bitset<32>(i & static_cast<size_t>(variation)).count() % 2;
    const float way = ones == 0 ? kCodeStep : -kCodeStep;
    best[i] += i >= best.size() / 2 && best[i] < 0 ? -way : way;
  }
  return best;
}

std::vector<Sample> answered(WindowNetwork& network, const MotionWindow& window, int variation) {
  const auto ask = [&](const WindowCode& code) {
    std::vector<WindowCode> codes;
    if (!code.empty()) codes = {code, in_mirror(code)};
    const auto answers = network.answer({window, mirrored(window)}, codes);
    return samples_of(window, answers[0], answers[1]);
  };
  std::vector<Sample> best = ask({});
  if (variation <= 0 || variation >= kMostVariations || network.code_size() == 0) return best;
  const WindowCode code = network.code_of(of_movement(window, best));
  return beside_the_best(window, best, ask(other_code(code, variation)));
}

/// Without what changes from sample to sample: that is the network's noise, and shakes more than people do.
/// Twice a quarter of both neighbours.
std::vector<Sample> smoothed(std::vector<Sample> samples, const std::vector<KnownParts>& known) {
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<Sample> rough = samples;
    for (size_t i = 1; i + 1 < samples.size(); ++i)
      for (size_t part = 0; part < kPartCount; ++part)
        if (!known[i][part])
          samples[i].change[part] =
              0.5f * rough[i].change[part] + 0.25f * (rough[i - 1].change[part] + rough[i + 1].change[part]);
  }
  return samples;
}

/// Of the samples of a window what is added to its curve in the end.
std::vector<Sample> tempered(std::vector<Sample> samples, const std::vector<KnownParts>& known) {
  const bool between = known.front() == all_parts(true) && known.back() == all_parts(true);
  samples = smoothed(std::move(samples), known);
  for (Sample& sample : samples)
    for (Vec3& way : sample.change) way *= between ? kKeptBetween : kKeptBeyond;
  return samples;
}

/// Between four values in a row, `share` of the way from b to c (Catmull and Rom): through all of them.
template <class Value>
Value between(const Value& a, const Value& b, const Value& c, const Value& d, float share) {
  const float s = share, s2 = s * s, s3 = s2 * s;
  return 0.5f *
         ((2 * s2 - s - s3) * a + (2 - 5 * s2 + 3 * s3) * b + (s + 4 * s2 - 3 * s3) * c + (s3 - s2) * d);
}

/// At any moment, in samples.
Sample at(const std::vector<Sample>& samples, float when) {
  const int last = ssize(samples) - 1, now = std::clamp(static_cast<int>(when + 1e-3f), 0, last);
  const float share = std::clamp(when - static_cast<float>(now), 0.0f, 1.0f);
  const Sample &b = samples[now], &c = samples[std::min(now + 1, last)];
  if (share < 1e-3f) return b;
  const Sample &a = samples[std::max(now - 1, 0)], &d = samples[std::min(now + 2, last)];
  Sample made;
  for (size_t part = 0; part < kPartCount; ++part)
    made.change[part] = between(a.change[part], b.change[part], c.change[part], d.change[part], share);
  for (size_t side = 0; side < 2; ++side)
    made.standing[side] = b.standing[side] + share * (c.standing[side] - b.standing[side]);
  made.doubt_m = b.doubt_m + share * (c.doubt_m - b.doubt_m);
  return made;
}

void check(const KnownMotion& question) {
  const size_t count = question.motion.poses.size();
  US_CHECK(question.known.size() == count, "a motion of ", count, " frames has ", question.known.size(),
           " that say what is known of it");
  US_CHECK(std::any_of(question.known.begin(), question.known.end(),
                       [](const KnownParts& parts) { return parts == all_parts(true); }),
           "no frame of the motion is known");
}

/// Of each frame whether it lies in a short gap.
std::vector<bool> in_short_gaps(const KnownMotion& question) {
  const auto& known = question.known;
  const auto longest = static_cast<int>(kShortGap_s * question.motion.fps + 1e-3f);
  std::vector<bool> is_short(known.size(), false);
  const auto next = [&](auto from, bool whole) {
    return std::find_if(from, known.end(),
                        [&](const KnownParts& parts) { return (parts == all_parts(true)) == whole; });
  };
  for (auto first = next(known.begin(), false); first != known.end();) {
    const auto end = next(first, true);
    if (first != known.begin() && end != known.end() && end - first <= longest)
      std::fill_n(is_short.begin() + (first - known.begin()), end - first, true);
    first = next(end, false);
  }
  return is_short;
}

/// Only where the legs are to be made, too: what is known of them stays.
void hold_made(const KnownMotion& question, const std::vector<MotionWindow>& windows, Motion& motion) {
  for (const MotionWindow& window : windows)
    for (size_t i = 0; i < window.gap_frames.size();) {
      const size_t first = i++;
      while (i < window.gap_frames.size() && window.gap_frames[i] == window.gap_frames[i - 1] + 1) ++i;
      const auto gap = question.known.begin() + window.gap_frames[first];
      const bool whole = std::all_of(gap, gap + static_cast<std::ptrdiff_t>(i - first),
                                     [](const KnownParts& parts) { return parts == all_parts(false); });
      if (whole) hold_standing(question.rest, window.gap_frames[first], window.gap_frames[i - 1], motion);
    }
}

/// Codes movements of 8 to 110 samples (0.24 to 3.6 s).
class WindowEncoder final : public MovementEncoder {
 public:
  explicit WindowEncoder(WindowNetwork& network) : network_(network) {}
  int size() const override { return network_.code_size(); }
  std::string name() const override { return "space"; }
  MotionCode encode(const TimedPoses& movement, const Joints& rest) override {
    const auto samples = static_cast<int>(movement.duration() * kWindowRate + 1e-3f) + 1;
    US_CHECK(samples >= kShortestMovement && samples <= kLongestWindow, "a movement of ", movement.duration(),
             " s cannot be coded, only one of ", (kShortestMovement - 1) / kWindowRate, " to ",
             (kLongestWindow - 1) / kWindowRate, " s");
    MotionWindow window;
    window.rest = rest;
    window.outlook = Outlook::of(movement.poses.front());
    for (int i = 0; i < samples; ++i)
      window.curve.push_back(window.outlook.seen(pose_at(movement, static_cast<float>(i) / kWindowRate)));
    window.distance.resize(window.curve.size());
    return {network_.code_of(window), {}};
  }

 private:
  static constexpr int kShortestMovement = 8;
  WindowNetwork& network_;
};

}  // namespace

LearnedSpace::LearnedSpace(std::unique_ptr<WindowNetwork> network) : network_(std::move(network)) {
  if (network_->code_size() > 0) encoder_ = std::make_unique<WindowEncoder>(*network_);
}

Completion LearnedSpace::complete(const KnownMotion& question) {
  check(question);
  Completion made;
  Motion& motion = made.motion = question.motion;
  const int count = ssize(motion.poses);
  fill_curves(question.known, 0, count - 1, motion);
  made.doubt_m = curve_doubt(question.known, question.motion, question.rest);
  const bool standing_known = !motion.standing.empty();
  motion.standing.resize(question.known.size());
  std::vector<MotionWindow> windows = windows_of(question.known, motion, question.rest);
  const std::vector<bool> stays = in_short_gaps(question);
  for (MotionWindow& window : windows) {
    auto& made_frames = window.gap_frames;
    made_frames.erase(std::remove_if(made_frames.begin(), made_frames.end(), [&](int t) { return stays[t]; }),
                      made_frames.end());
    if (made_frames.empty()) continue;
    const std::vector<Sample> samples =
        tempered(answered(*network_, window, question.variation), known_of(window));
    for (const int t : made_frames) {
      const Sample sample = at(samples, (static_cast<float>(t) - window.first) / window.step);
      change(sample, question.known[t], window.outlook.heading, motion.poses[t]);
      made.doubt_m[t] = sample.doubt_m;
      for (size_t side = 0; side < 2; ++side) motion.standing[t][side] = sample.standing[side] > kStands;
    }
  }
  hold_made(question, windows, motion);
  if (!standing_known) motion.standing.clear();
  return made;
}

}  // namespace understudy
