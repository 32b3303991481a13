// Completes a motion by the most similar one of a set of clips: a baseline that knows motions by heart.
#pragma once

#include <vector>

#include "retarget/body/clips.hpp"
#include "retarget/motion_space/motion_window.hpp"
#include "retarget/motion_space/plain_space.hpp"

namespace understudy {

/// `nearest`: each gap is filled from the stretch of the clips, mirrored ones too, whose joints come nearest
/// to those of the known frames beside it, up to 10 on each side, both looked at from the last known frame.
/// It is bent through both ends: what it is off there is spread over the gap, rotations slerped. Where no
/// frame is wholly known, hermite's curve. complete() throws Error where no clip has a stretch as long as a
/// gap and what is known beside it.
class NearestSpace final : public PlainSpace {
 public:
  /// Throws Error without clips. They are at 30 frames/s; of questions at another rate they are looked at
  /// between their frames.
  explicit NearestSpace(std::vector<Clip> clips);
  std::string name() const override { return "nearest"; }

 private:
  struct View {  // of one frame
    Joints joints;
    Outlook outlook;
  };
  struct Window {
    int first, count, before, after;  // of the question; known frames at its ends
    float step;                       // frames of a clip in one of the question
    int outlook() const { return before > 0 ? before - 1 : count - after; }
  };
  /// A moment of a clip.
  struct Moment {
    int frame;
    float share;  // of the way to the next frame
  };
  static Moment moment(int first, float frames);
  void fill(const KnownMotion& question, Motion& motion) override;
  void set_rest(const Joints& rest);
  Outlook outlook_at(int clip, const Moment& at) const;
  Joints joints_at(int clip, const Moment& at) const;
  Pose pose_at(int clip, const Moment& at) const;
  ClipRun nearest(const KnownMotion& question, const Window& window) const;
  void fill_window(const KnownMotion& question, const Window& window, Motion& motion) const;

  std::vector<Clip> clips_;
  std::vector<ClipRun> runs_;
  Joints rest_ = Joints::Zero();          // that the views are of
  std::vector<std::vector<View>> views_;  // of each clip and frame
};

}  // namespace understudy
