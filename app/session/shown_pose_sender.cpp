#include "app/session/shown_pose_sender.hpp"

#include "app/run/pose_output.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {
namespace {

bool is_equal(const Pose& a, const Pose& b) {
  return a.local == b.local && a.root == b.root;
}

/// In the frame that is shown, whose pose the caller has.
SentPose sent_pose(const Session& session, int frame) {
  SentPose sent;
  sent.number = frame;
  sent.seconds = moment_of(session, frame);
  const auto& seen = performed_by(session, static_cast<size_t>(session.selected_take));
  if (static_cast<size_t>(frame) < seen.size()) {
    const KeptSource& source = seen[static_cast<size_t>(frame)];
    sent.is_tracked = !source.flagged;
    sent.confidence = source.confidence_of;
  }
  return sent;
}

}  // namespace

bool ShownPoseSender::push(const Session& session, double seconds) {
  since_sent_s_ += seconds;
  const TakeState* const take = at_or_null(session.takes, session.selected_take);
  const int frame = shown_frame(session);
  const Pose* const shown = take != nullptr ? at_or_null(take->shown.poses, frame) : nullptr;
  if (shown == nullptr || !take->target) return false;
  if (take->target != target_) {
    target_ = take->target;
    blend_.emplace(hip_height_of(*target_));
  }
  SentPose sent = sent_pose(session, frame);
  const bool is_live = session.playback.live && !session.playback.playing;
  sent.pose = blend_->push(*shown, sent.is_tracked || !is_live, static_cast<float>(seconds));
  if (last_ && is_equal(*last_, sent.pose) && since_sent_s_ < kStillEvery_s) return false;
  sent.joints = forward_kinematics(target_->joints, sent.pose).joints;
  to_.send(target_->joints, sent);
  last_ = sent.pose;
  since_sent_s_ = 0;
  return true;
}

}  // namespace understudy::app
