#include "retarget/pipeline/performer.hpp"

#include <utility>

#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy {

Performer::Performer(const RetargetOptions& options)
    : options_(options), now_{JointFilter(options.filter),
                              RootPath(options.root),
                              FootLock(options.feet),
                              HandContacts(),
                              {},
                              {}} {}

Performer::Performer(Target target, std::shared_ptr<MotionTransfer> transfer,
                     std::shared_ptr<Deformer> deformer, const RetargetOptions& options)
    : Performer(options) {
  US_CHECK(transfer && deformer, "the pipeline wants a motion transfer and a deformer");
  target_ = std::move(target);
  transfer_ = std::move(transfer);
  deformer_ = std::move(deformer);
  for (const std::string& warning : target_.warnings) log::warn(warning);
  deformer_->bind(target_.mesh.vertices, target_.joints);
  now_.hands.bind(target_.mesh, target_.joints, deformer_->weights());
  restart();
}

void Performer::add_style(std::unique_ptr<MotionStyle> style) {
  style->reset();
  styles_.push_back(std::move(style));
}

void Performer::restart() {
  for (const auto& style : styles_) style->reset();
  now_.filter.reset();
  now_.feet.reset();
  now_.hands.reset();
  if (transfer_) {
    transfer_->reset(target_.joints);
    now_.root.reset(target_.mesh.vertices, target_.joints);
  }
  last_ = {};
  waited_ = 0;
}

PerformedFrame Performer::perform(const Observation& seen, float dt) {
  waited_ += dt;
  PerformedFrame frame;
  frame.observed = frame.source = seen;
  std::string problem = refusal(seen);
  if (!problem.empty()) return repeat(std::move(frame), std::move(problem));
  frame.confidence = seen.confidence;
  Memory before = remembered();
  try {
    run(frame);
  } catch (const Error& error) {
    put_back(std::move(before));
    return repeat(std::move(frame), error.what());
  }
  waited_ = 0;
  last_ = kept(frame);
  return frame;
}

/// The way of a frame. Without a target styles and filter are all.
void Performer::run(PerformedFrame& frame) {
  const auto began = std::chrono::steady_clock::now();
  for (const auto& style : styles_) frame.source = style->push(std::move(frame.source), waited_);
  static_cast<Extraction&>(frame.source) = now_.filter.push(frame.source, waited_);
  if (transfer_) {
    const Observation& source = frame.source;
    Pose& pose = frame.pose;
    pose.local = transfer_->push(source, waited_);
    pose.root = now_.root.push(source, pose.local, waited_);
    if (options_.lock_feet) pose = now_.root.plant(pose, waited_);
    if (options_.lock_feet && options_.root.mode == RootMode::Scaled)
      pose = now_.feet.push(pose, target_.joints, waited_, source.joints);
    if (options_.keep_contacts) pose = now_.hands.push(pose, source.joints, source.girth, waited_);
    US_CHECK(finite(pose.local) && pose.root.allFinite(),
             "the motion transfer gave numbers that are not finite");
    finish(frame);
    US_CHECK(frame.vertices.allFinite(), "the deformation gave numbers that are not finite");
  }
  frame.transfer_ms = ms_since(began) - frame.deform_ms;
}

Performer::Memory Performer::remembered() const {
  Memory memory = now_;
  if (transfer_) memory.transfer = transfer_->memory();
  for (const auto& style : styles_) memory.styles.push_back(style->memory());
  return memory;
}

void Performer::put_back(Memory memory) {
  if (transfer_) transfer_->restore(std::exchange(memory.transfer, {}));
  for (size_t s = 0; s < styles_.size(); ++s) styles_[s]->restore(memory.styles[s]);
  memory.styles.clear();
  now_ = std::move(memory);
}

PerformedFrame Performer::repeat(PerformedFrame frame, std::string reason) {
  frame.flagged = true;
  frame.reason = std::move(reason);
  frame.confidence.setZero();
  frame.pose = last_.pose;
  frame.source.joints = last_.source;
  if (transfer_) finish(frame);
  return frame;
}

void Performer::finish(PerformedFrame& frame) const {
  const auto began = std::chrono::steady_clock::now();
  frame.joints = forward_kinematics(target_.joints, frame.pose).joints;
  if (options_.vertices) frame.vertices = deformer_->deform(frame.pose);
  frame.deform_ms = ms_since(began);
}

KeptFrame kept(const PerformedFrame& frame) {
  return {frame.pose, frame.source.joints, frame.flagged};
}

}  // namespace understudy
