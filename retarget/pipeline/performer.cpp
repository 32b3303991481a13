#include "retarget/pipeline/performer.hpp"

#include <cmath>
#include <utility>

#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy {
namespace {

/// Where no leg is bent for the floor the pelvis alone takes the soles there.
RootPathOptions root_options(const RetargetOptions& options) {
  RootPathOptions root = options.root;
  if (!options.lock_feet) root.contact = 1;
  return root;
}

/// Poses alone need no deformer, as long as no hand is to touch the body's surface.
void check_needs(bool transfer, bool deformer, const RetargetOptions& options) {
  US_CHECK(transfer, "the pipeline needs a motion transfer");
  US_CHECK(deformer || (!options.vertices && !options.keep_contacts), "the pipeline needs a deformer");
}

}  // namespace

Performer::Performer(const RetargetOptions& options)
    : options_(options),
      now_{UnseenLimbs(),
           JointFilter(options.filter),
           RootPath(root_options(options)),
           FootLock(options.feet),
           ArmReach(options.arm_reach),
           HandContacts(),
           {}} {}

Performer::Performer(Target target, std::shared_ptr<MotionTransfer> transfer,
                     std::shared_ptr<Deformer> deformer, const RetargetOptions& options)
    : Performer(options) {
  check_needs(transfer != nullptr, deformer != nullptr, options);
  target_ = std::move(target);
  transfer_ = std::move(transfer);
  deformer_ = std::move(deformer);
  for (const std::string& warning : target_.warnings) log::warn(warning);
  if (deformer_) {
    deformer_->bind(target_.mesh.vertices, target_.joints);
    now_.hands.bind(target_.mesh, target_.joints, deformer_->weights());
    surface_ = TornSurface(target_.mesh, deformer_->weights());
  }
  restart();
}

void Performer::restart() {
  now_.unseen.reset();
  now_.filter.reset();
  now_.feet.reset();
  now_.arms.reset();
  now_.hands.reset();
  if (transfer_) {
    transfer_->reset(target_.joints);
    now_.root.reset(target_.mesh.vertices, target_.joints);
  }
  last_ = {};
  ahead_.reset();
  waited_ = 0;
}

void Performer::restart(const RetargetOptions& options) {
  if (transfer_) check_needs(true, deformer_ != nullptr, options);
  options_ = options;
  now_.filter = JointFilter(options.filter);
  now_.root = RootPath(root_options(options));
  now_.feet = FootLock(options.feet);
  now_.arms = ArmReach(options.arm_reach);
  restart();
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
  if (options_.predict && transfer_) {
    if (!ahead_) ahead_.emplace();
    ahead_->push(frame.pose, frame.standing, waited_);
  }
  waited_ = 0;
  last_ = kept(frame);
  return frame;
}

/// All stages of a frame: the source's, then the target's, where there is one.
void Performer::run(PerformedFrame& frame) {
  using Stage = void (*)(Performer&, PerformedFrame&);
  static constexpr Stage kUnseen = [](Performer& p, PerformedFrame& f) {
    static_cast<Extraction&>(f.source) = p.now_.unseen.push(f.source, p.waited_);
    f.limbs = f.source.unstyled ? f.source.unstyled->limbs : p.now_.unseen.limbs();
  };
  static constexpr Stage kFilter = [](Performer& p, PerformedFrame& f) {
    static_cast<Extraction&>(f.source) = p.now_.filter.push(f.source, p.waited_);
  };
  static constexpr Stage kTransfer = [](Performer& p, PerformedFrame& f) {
    f.pose.local = p.transfer_->push(f.source, p.waited_);
    if (p.options_.rest_pose) f.pose.local = from_rest_pose(f.pose.local, *p.options_.rest_pose);
  };
  static constexpr Stage kRoot = [](Performer& p, PerformedFrame& f) {
    f.pose.root = p.now_.root.push(f.source, f.pose.local, p.waited_);
  };
  static constexpr Stage kSteps = [](Performer& p, PerformedFrame& f) {
    p.copied_ = f.pose.local;
    f.pose = p.now_.root.step(f.pose);
  };
  static constexpr Stage kFeet = [](Performer& p, PerformedFrame& f) {
    if (!p.options_.lock_feet) return;
    const Standing seen = f.source.unstyled ? f.source.unstyled->feet : p.now_.unseen.feet();
    if (seen[0] || seen[1]) f.pose = p.now_.root.plant(f.pose, p.waited_);
    if (p.options_.root.mode != RootMode::Scaled) return;
    f.pose = p.now_.feet.push(f.pose, p.target_.joints, p.waited_, f.source.joints, seen);
    f.standing = p.now_.feet.standing();
  };
  static constexpr Stage kArms = [](Performer& p, PerformedFrame& f) {
    f.pose = p.now_.arms.push(f.pose, p.target_.joints, f.source.joints);
  };
  static constexpr Stage kHands = [](Performer& p, PerformedFrame& f) {
    if (p.options_.keep_contacts)
      f.pose = p.now_.hands.push(f.pose, f.source.joints, f.source.girth, p.waited_,
                                 p.options_.places_limbs() ? &p.copied_ : nullptr);
  };
  static constexpr Stage kSkin = [](Performer& p, PerformedFrame& f) {
    US_CHECK(finite(f.pose.local) && f.pose.root.allFinite(),
             "the motion transfer gave numbers that are not finite");
    p.finish(f);
    US_CHECK(f.vertices.allFinite(), "the deformation gave numbers that are not finite");
    p.watch(f);
  };
  const auto began = std::chrono::steady_clock::now();
  for (const Stage stage : {kUnseen, kFilter}) stage(*this, frame);
  if (transfer_)
    for (const Stage stage : {kTransfer, kRoot, kSteps, kFeet, kArms, kHands, kSkin}) stage(*this, frame);
  frame.transfer_ms = ms_since(began) - frame.deform_ms;
}

Performer::Memory Performer::remembered() const {
  Memory memory = now_;
  if (transfer_) memory.transfer = transfer_->memory();
  return memory;
}

void Performer::put_back(Memory memory) {
  if (transfer_) transfer_->restore(std::exchange(memory.transfer, {}));
  now_ = std::move(memory);
}

PerformedFrame Performer::repeat(PerformedFrame frame, std::string reason) {
  frame.flagged = true;
  frame.reason = std::move(reason);
  frame.confidence.setZero();
  frame.pose = ahead_ ? ahead_->after(waited_, target_.joints) : last_.pose;
  frame.observed.doubt_m = ahead_ ? PosePrediction::doubt_m(waited_) : 0;
  frame.standing = last_.standing;
  frame.limbs = last_.limbs;
  frame.source.joints = last_.source;
  frame.source.unstyled.reset();
  if (transfer_) finish(frame);
  return frame;
}

void Performer::finish(PerformedFrame& frame) const {
  const auto began = std::chrono::steady_clock::now();
  frame.joints = forward_kinematics(target_.joints, frame.pose).joints;
  if (options_.vertices) frame.vertices = deformer_->deform(frame.pose);
  frame.deform_ms = ms_since(began);
}

/// Tells once that the target falls apart, which lasts: every fifth frame is enough.
void Performer::watch(PerformedFrame& frame) {
  constexpr int kEvery = 5;
  if (is_torn_ || watched_++ % kEvery != 0) return;
  const float share = surface_.parted(target_.joints, frame.pose);
  if (share <= TornSurface::kMost) return;
  is_torn_ = true;
  frame.warning = "the target falls apart: its pieces part by " + std::to_string(std::lround(100 * share)) +
                  " % of its height; the bones of its joints may be wrong";
  log::warn(frame.warning);
}

const Joints& source_joints(const PerformedFrame& frame) {
  return frame.source.unstyled ? frame.source.unstyled->joints : frame.source.joints;
}

KeptFrame kept(const PerformedFrame& frame) {
  return {frame.pose,     source_joints(frame), frame.flagged,
          frame.standing, frame.limbs,          frame.observed.doubt_m};
}

}  // namespace understudy
