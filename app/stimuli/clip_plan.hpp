// What a clip shows when: a motion that is long enough once, a shorter one again and again.
#pragma once

#include "app/study/study.hpp"

namespace understudy::app {

/// A frame of a clip.
struct ClipMoment {
  double motion_s = 0;   ///< into the motion
  bool is_card = false;  ///< the card between two runs
};

/// A motion of `motion_s` seconds (at speed 1) in a clip of exactly study.clip.seconds: cut where it is
/// longer; else a card and once more, the last run as long as there is time. Where no time is left for a card
/// and half a second of motion the last picture stays.
class ClipPlan {
 public:
  ClipPlan(const StudyClip& clip, int fps, double motion_s);
  int frames() const { return frames_; }
  /// How often the motion begins.
  int runs() const { return runs_; }
  /// Frame 0 .. frames() - 1.
  ClipMoment at(int frame) const;

 private:
  int frames_, run_, card_, runs_;  // frames: of the clip, of a run, of a card
  double step_s_;                   // of the motion from frame to frame
};

}  // namespace understudy::app
