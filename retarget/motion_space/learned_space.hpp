// A motion space that corrects smooth curves by what a network says of their windows.
#pragma once

#include <memory>

#include "retarget/motion_space/motion_window.hpp"
#include "retarget/pipeline/motion_space.hpp"

namespace understudy {

/// What a network makes of a window, sample by sample.
struct WindowAnswer {
  std::vector<Pose> poses;                     ///< seen from the window's outlook
  std::vector<std::array<float, 2>> standing;  ///< 0..1, that the left and the right foot stand
  std::vector<float> doubt_m;                  ///< the error that is expected of the joints, metres
};

class WindowNetwork {
 public:
  virtual ~WindowNetwork() = default;
  /// Of windows with equally many samples. Throws Error where an answer is not finite.
  virtual std::vector<WindowAnswer> answer(const std::vector<MotionWindow>& windows) = 0;
};

/// Fills by the curve (fill_curves), then adds what the network changes of it. The network is asked of the
/// mirror image, too, and what is taken is the mean of both answers: so the mirrored question has the
/// mirrored answer. Feet that it lets stand are held (hold_standing); known ones are as
/// KnownMotion::motion.standing says. Gaps of up to 0.17 s between wholly known frames stay the curve, and so
/// do those that fit into no window (of some three seconds).
/// The other answers (KnownMotion::variation 1 to 3) are what the network makes of the curve when it is bent
/// (curve_bend.hpp), by as much as it doubts the best one in each frame: sure frames stay. Their doubt is
/// that, and the way from the best answer, as of independent errors.
class LearnedSpace final : public MotionSpace {
 public:
  explicit LearnedSpace(std::unique_ptr<WindowNetwork> network) : network_(std::move(network)) {}
  Completion complete(const KnownMotion& question) override;
  std::string name() const override { return "space"; }
  int variations() const override { return kMostVariations; }

 private:
  std::unique_ptr<WindowNetwork> network_;
};

}  // namespace understudy
