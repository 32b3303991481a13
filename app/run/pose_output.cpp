#include "app/run/pose_output.hpp"

#include <thread>

#include "retarget/base/clock.hpp"

namespace understudy::app {

float hip_height_of(const Target& target) {
  const Points& vertices = target.mesh.vertices;
  return target.joints(Pelvis, 1) - (vertices.rows() > 0 ? vertices.col(1).minCoeff() : 0);
}

PoseOutput::PoseOutput(const PoseOutputOptions& options, const Target& target)
    : options_(options), rest_(target.joints), blend_(hip_height_of(target)) {
  for (const std::string& address : options_.addresses) senders_.emplace_back(address);
}

void PoseOutput::push(const PerformedFrame& frame, const std::optional<LiveMoment>& live) {
  SentPose sent;
  sent.number = frames_++;
  sent.seconds = static_cast<double>(sent.number) / options_.fps;
  sent.is_tracked = !frame.flagged;
  sent.confidence = frame.confidence;
  sent.pose = blend_.push(frame.pose, sent.is_tracked, static_cast<float>(1 / options_.fps));
  sent.joints = forward_kinematics(rest_, sent.pose).joints;
  if (sent.number == 0) start_ = std::chrono::steady_clock::now();
  if (options_.in_time)
    std::this_thread::sleep_until(start_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                               std::chrono::duration<double>(sent.seconds)));
  for (PoseSender& sender : senders_) {
    sent.age_ms = live ? ms_since(live->captured) : 0;
    sender.send(rest_, sent);
  }
}

}  // namespace understudy::app
