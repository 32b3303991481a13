// Sends what the studio shows of the current take to another program: an engine, a virtual character.
#pragma once

#include <memory>
#include <optional>

#include "app/session/session.hpp"
#include "retarget/live/pose_sender.hpp"

namespace understudy::app {

/// One receiver. What is seen is sent: the user's edits, the playhead, its tempo. While new frames are shown
/// as they come, a source that is lost lets the target blend to its T-pose (TPoseBlend).
class ShownPoseSender {
 public:
  explicit ShownPoseSender(PoseSender to) : to_(std::move(to)) {}
  /// Sends the current take in the frame that is shown, where that is another pose than the last one or
  /// kStillEvery_s have gone by. seconds: since the last call. Whether it did: a take that does not perform
  /// yet, and one of 2D poses, sends nothing.
  bool push(const Session& session, double seconds);

  static constexpr double kStillEvery_s = 0.1;  ///< receivers take silence for an end

 private:
  PoseSender to_;
  std::shared_ptr<const Target> target_;  // that blend_ is of
  std::optional<TPoseBlend> blend_;
  std::optional<Pose> last_;
  double since_sent_s_ = 0;
};

}  // namespace understudy::app
