#include "retarget/pipeline/retargeter.hpp"

#include <chrono>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy {

namespace {

class Stopwatch {
 public:
  /// Milliseconds since it was made or last asked.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

int finite_points(const Points& points) {
  int count = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) count += points.row(i).allFinite() ? 1 : 0;
  return count;
}

bool finite(const Rotations& rotations) {
  for (const Mat3& R : rotations)
    if (!R.allFinite()) return false;
  return true;
}

}  // namespace

Retargeter::Retargeter(Networks networks, const RetargetOptions& options)
    : networks_(std::move(networks)),
      options_(options),
      filter_(options.filter),
      root_(options.root),
      feet_(options.feet),
      hands_(options.hands) {
  US_CHECK(networks_.transfer && networks_.deformer, "the pipeline wants a motion transfer and a deformer");
}

void Retargeter::set_target(const Mesh& mesh) {
  US_CHECK(networks_.extractor, "the pipeline has no skeleton extractor");
  SkeletonExtractor& extractor = networks_.rest_extractor ? *networks_.rest_extractor : *networks_.extractor;
  set_target(prepare_target(mesh, extractor));
}

void Retargeter::set_target(Target target) {
  target_ = std::move(target);
  for (const std::string& warning : target_.warnings) log::warn(warning);
  networks_.deformer->bind(target_.mesh.vertices, target_.joints);
  hands_.bind(target_.mesh, target_.joints, networks_.deformer->weights());
  has_target_ = true;
  restart();
}

void Retargeter::restart() {
  US_CHECK(has_target_, "there is no target yet");
  networks_.transfer->reset(target_.joints);
  recent_ = {};
  filter_.reset();
  root_.reset(target_.mesh.vertices, target_.joints);
  feet_.reset();
  hands_.reset();
  last_ = Pose{};
  waited_ = 0;
}

const RowMatrix& Retargeter::weights() const {
  US_CHECK(has_target_, "there is no target yet");
  return networks_.deformer->weights();
}

RetargetedFrame Retargeter::push(const Mesh& scan, float dt) {
  US_CHECK(has_target_, "there is no target yet");
  US_CHECK(networks_.extractor, "the pipeline has no skeleton extractor");
  Stopwatch watch;
  RetargetedFrame frame;
  const int points = finite_points(scan.vertices);
  if (points < options_.min_points) return skip(detail::join("the scan has ", points, " usable points"), dt);
  try {
    frame.source_raw = networks_.extractor->extract_next(scan, recent_);
  } catch (const Error& error) {
    return skip(error.what(), dt);
  }
  frame.source_raw.sole_height = sole_height(frame.source_raw.joints, scan.vertices);
  std::optional<BodyGirth> girth;
  if (options_.keep_contacts && frame.source_raw.joints.allFinite())
    girth = measure_girth(frame.source_raw, scan.vertices);
  frame.ms.extract = watch.lap();
  return transfer(std::move(frame), dt, girth ? &*girth : nullptr);
}

RetargetedFrame Retargeter::push(const Extraction& extraction, float dt, const BodyGirth* girth) {
  US_CHECK(has_target_, "there is no target yet");
  RetargetedFrame frame;
  frame.source_raw = extraction;
  return transfer(std::move(frame), dt, girth);
}

RetargetedFrame Retargeter::skip(const std::string& reason, float dt) {
  US_CHECK(has_target_, "there is no target yet");
  waited_ += dt;
  return repeat(RetargetedFrame{}, reason);
}

RetargetedFrame Retargeter::transfer(RetargetedFrame frame, float dt, const BodyGirth* girth) {
  Stopwatch watch;
  waited_ += dt;
  const Extraction& seen = frame.source_raw;
  if (!seen.joints.allFinite() || !seen.confidence.allFinite() || (seen.global && !finite(*seen.global)))
    return repeat(std::move(frame), "the extracted skeleton has numbers that are not finite");
  frame.confidence = seen.confidence.mean();
  if (frame.confidence < options_.min_confidence)
    return repeat(std::move(frame),
                  detail::join("the confidence in the skeleton is only ", frame.confidence));
  const JointFilter filter_before = filter_;
  const RootPath root_before = root_;
  const FootLock feet_before = feet_;
  const HandContacts hands_before = hands_;
  const auto refuse = [&](const std::string& reason) {
    filter_ = filter_before;  // a frame that is not believed leaves no trace here
    root_ = root_before;
    feet_ = feet_before;
    hands_ = hands_before;
    return repeat(std::move(frame), reason);
  };
  try {
    frame.source = filter_.push(seen, waited_);
    frame.pose.local = networks_.transfer->push(frame.source, waited_);
    frame.pose.root = root_.push(frame.source, frame.pose.local, waited_);
    if (options_.lock_feet) frame.pose = root_.plant(frame.pose, waited_);
    if (options_.lock_feet && options_.root.mode == RootMode::Scaled)
      frame.pose = feet_.push(frame.pose, target_.joints, waited_, frame.source.joints);
    if (options_.keep_contacts) frame.pose = hands_.push(frame.pose, frame.source.joints, girth, waited_);
    frame.ms.transfer = watch.lap();
    if (!finite(frame.pose.local) || !frame.pose.root.allFinite())
      return refuse("the motion transfer gave numbers that are not finite");
    finish(frame);
    if (!frame.vertices.allFinite()) return refuse("the deformation gave numbers that are not finite");
  } catch (const Error& error) {
    return refuse(error.what());
  }
  waited_ = 0;
  last_ = frame.pose;
  return frame;
}

RetargetedFrame Retargeter::repeat(RetargetedFrame frame, const std::string& reason) {
  frame.flagged = true;
  frame.reason = reason;
  frame.pose = last_;
  finish(frame);
  return frame;
}

void Retargeter::finish(RetargetedFrame& frame) {
  Stopwatch watch;
  frame.joints = forward_kinematics(target_.joints, frame.pose).joints;
  if (options_.vertices) frame.vertices = networks_.deformer->deform(frame.pose);
  frame.ms.deform = watch.lap();
  frame.ms.total = frame.ms.extract + frame.ms.transfer + frame.ms.deform;
}

RetargetedFrame Retargeter::pose_target(const Pose& pose) {
  US_CHECK(has_target_, "there is no target yet");
  RetargetedFrame frame;
  frame.pose = pose;
  frame.confidence = 1;
  finish(frame);
  return frame;
}

KeptFrame kept(const RetargetedFrame& frame) {
  return {frame.pose, frame.confidence, frame.flagged};
}

}  // namespace understudy
