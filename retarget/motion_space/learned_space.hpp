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

/// Which of many movements a window's is, numbers about 0, most between -1 and 1. In a mirror the second half
/// of them changes its sign.
using WindowCode = std::vector<float>;

class WindowNetwork {
 public:
  virtual ~WindowNetwork() = default;
  /// Of windows with equally many samples. `codes`: of each the movement that is asked for; none: the most
  /// likely one. Throws Error where an answer is not finite.
  virtual std::vector<WindowAnswer> answer(const std::vector<MotionWindow>& windows,
                                           const std::vector<WindowCode>& codes = {}) = 0;
  /// Numbers of a code; 0: it knows none, and looks at none. Even.
  virtual int code_size() const { return 0; }
  /// Of a window whose curve is the movement itself.
  virtual WindowCode code_of(const MotionWindow&) { return {}; }
};

/// Fills by the curve (fill_curves), then adds what the network changes of it. The network is asked of the
/// mirror image, too, and what is taken is the mean of both answers: so the mirrored question has the
/// mirrored answer. What shakes in it from sample to sample is smoothed. Feet that it lets stand are held
/// (hold_standing); known ones are as KnownMotion::motion.standing says. Gaps of up to 0.17 s between wholly
/// known frames stay the curve, and so do those that fit into no window (of some three seconds).
/// The other answers (KnownMotion::variation 1 to 3) are those of other codes than the best one's: equally
/// far from that, and at right angles to each other. Their doubt is the best one's, and the way from the best
/// answer, as of independent errors.
class LearnedSpace final : public MotionSpace {
 public:
  explicit LearnedSpace(std::unique_ptr<WindowNetwork> network);
  Completion complete(const KnownMotion& question) override;
  std::string name() const override { return "space"; }
  int variations() const override { return network_->code_size() > 0 ? kMostVariations : 1; }
  MovementEncoder* encoder() override { return encoder_.get(); }

 private:
  std::unique_ptr<WindowNetwork> network_;
  std::unique_ptr<MovementEncoder> encoder_;  // by the network; null where it has no codes
};

}  // namespace understudy
