// When each frame of a result is shown: the tempo of a performance. Time alone changes, no pose does, so a
// foot that stands stays standing.
#pragma once

#include <algorithm>
#include <deque>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// What the tempo follows. Body: sqrt(leg_B / leg_A), so that what is scaled by the ratio of the legs falls
/// at true gravity (dynamic scaling: Raibert and Hodgins 1991; Hodgins and Pollard 1997). Number:
/// TempoEdit::length.
enum class TempoBy { Body, Number };
constexpr Names<2> kTempoNames{"body", "number"};
constexpr Within<float> kTempoLengths{0.1f, 10};

/// A frame that the user shifts in time.
struct TempoMark {
  int frame = 0;      ///< of the motion before any edit
  float later_s = 0;  ///< after where it would be without marks; 0: it stays there whatever other marks do
};
template <class V, class S>
FieldsOf<S, TempoMark> fields(V& visit, S& mark) {
  visit("frame", mark.frame, kFrameNumbers);
  visit("later_s", mark.later_s, Within<float>{-3600, 3600});
}

struct TempoEdit {
  TempoBy by = TempoBy::Body;
  float length = 1;  ///< with Number: the take lasts so many times as long, in kTempoLengths
  /// the same of the parts of a movement (see movement_phases), on top
  float anticipation = 1, stroke = 1, recovery = 1;
  float spread = 0;  ///< standard deviation of how long single movements last, a share of it
  std::vector<TempoMark> marks;
};
template <class V, class S>
FieldsOf<S, TempoEdit> fields(V& visit, S& tempo) {
  visit("by", tempo.by, kTempoNames);
  visit("length", tempo.length, kTempoLengths);
  visit("anticipation", tempo.anticipation, kTempoLengths);
  visit("stroke", tempo.stroke, kTempoLengths);
  visit("recovery", tempo.recovery, kTempoLengths);
  visit("spread", tempo.spread, Within<float>{0, 0.2f});
  visit("marks", tempo.marks);
}

/// How long a take lasts against its source, so that things fall on the target as they do on the source.
float body_tempo(float leg_target_m, float leg_source_m);

/// Rest: nothing moves fast.
enum class MovementPhase : uint8_t { Rest, Anticipation, Stroke, Recovery };

/// The phase of each frame, by the acting limb: of hands and feet, relative to the pelvis, the one that is
/// fastest there. A stroke is where it is faster than half of what a movement reaches at most (0.5 legs/s at
/// the least); the quarter of a second before it, or as much as lies after the movement before, is its
/// anticipation, that after it its recovery. Looks both ways.
std::vector<MovementPhase> movement_phases(const std::vector<Joints>& joints, float fps);

/// The moment in the take of each frame of the motion, seconds: the first at 0, each later than the one
/// before. joints: of the target, a frame each; leg_ratio: of the target's legs to the source's. Throws Error
/// where marks would stop time or turn it back.
std::vector<double> tempo_times(const TempoEdit& edit, const std::vector<Joints>& joints, float fps,
                                float leg_ratio);

/// A moment between two frames of a motion.
struct MomentBetween {
  int before = 0, after = 0;
  float share = 0;  ///< 0: at `before` .. 1: at `after`
};
/// What is shown of a motion's kept frames at `fps`, so that nothing is cut off at the end. times: of all
/// frames, as tempo_times gives them; empty: those frames themselves.
std::vector<MomentBetween> moments_of(const std::vector<int>& kept, const std::vector<double>& times,
                                      float fps);

/// Rotations on the shortest arc, the root on a line.
Pose pose_between(const Pose& before, const Pose& after, float share);

/// Tempo of a stream: one frame out for one in. The moment that is shown runs behind the newest frame by a
/// reserve of at most `delay_s`, which fast strokes use up and rests regain; the reverse where the tempo is
/// slower. Looks only back; a constant amount is kept.
class LiveTempo {
 public:
  explicit LiveTempo(float delay_s) : delay_(delay_s) {}
  /// The newest joints, dt seconds after those before. length: as body_tempo: strokes last so many times as
  /// long, rests the inverse. By how many seconds the moment to be shown is behind.
  float push(const Joints& joints, float dt, float length);
  /// After the last push(), each time another `dt` has passed: the same; 0 at the end.
  float finish(float dt) { return behind_ = std::max(0.0f, behind_ - dt); }
  float behind_s() const { return behind_; }

 private:
  struct Kept {
    double at = 0;  // seconds
    bool fast = false;
  };
  float delay_;
  std::deque<Kept> kept_;  // those still to be shown, and one before
  Joints last_ = Joints::Zero();
  float behind_ = 0;
};

}  // namespace understudy
