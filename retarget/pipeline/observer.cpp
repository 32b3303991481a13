#include "retarget/pipeline/observer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/root_path.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"

namespace understudy {
namespace {

constexpr float kImplausible = 0.25f,
                kOdd = 0.17f;            // bones that are no person's, and that are unsure to be one's
constexpr float kUnsure = 0.6f;          // confidence
constexpr int kFewest = 3, kFirst = 60;  // frames that are looked at
constexpr Eigen::Index kComparable = 6;  // bones that are seen
constexpr int kFewestPoints = 32;        // finite ones below which a scan is not looked at
constexpr float kPast_s = 0.25f;         // how long joints are passed on: some frames at any usual rate

/// What the scan shows around a skeleton.
void look_around(Observation& seen, const Mesh& scan) {
  if (!seen.joints.allFinite()) return;
  seen.sole_height = sole_height(seen, scan.vertices);
  seen.girth = measure_girth(seen, scan.vertices);
}

using BoneRatios = Eigen::Array<float, kJointCount - 1, 1>;

/// Logarithms of the bones' lengths against a mean human's.
BoneRatios log_ratios(const Joints& joints) {
  const BoneRatios human = bone_lengths(human_rest()).tail<kJointCount - 1>();
  return (bone_lengths(joints).tail<kJointCount - 1>().max(1e-6f) / human).log();
}

float deviation(const Eigen::Ref<const Eigen::ArrayXf>& values) {
  return std::sqrt((values - values.mean()).square().mean());
}

/// The same of the bones with both ends seen; 0 where they are too few to be compared.
float seen_implausibility(const Extraction& seen) {
  const BoneRatios ratios = log_ratios(seen.joints);
  Eigen::ArrayXf of_seen(ratios.size());
  Eigen::Index count = 0;
  for (int j = 1; j < kJointCount; ++j)
    if (shows_bone(seen, j)) of_seen[count++] = ratios[j - 1];
  return count < kComparable ? 0.0f : deviation(of_seen.head(count));
}

}  // namespace

float bone_implausibility(const Joints& joints) {
  return deviation(log_ratios(joints));
}

bool is_implausible(const Extraction& seen) {
  const float implausibility = seen_implausibility(seen);
  return implausibility > kImplausible || (implausibility > kOdd && mean_confidence(seen) < kUnsure);
}

std::string PersonCheck::push(const Extraction& seen) {
  if (seen.exact || warned_ || frames_ >= kFirst || !seen.joints.allFinite()) return {};
  ++frames_;
  if (is_implausible(seen)) ++implausible_;
  warned_ = frames_ >= kFewest && implausible_ * 5 >= frames_ * 4;
  if (!warned_) return {};
  return "may not be a person, or its poses are not recognised: its bones are unlike a human's in " +
         std::to_string(implausible_) + " of its first " + std::to_string(frames_) + " frames";
}

Observer::Observer(std::shared_ptr<SkeletonExtractor> extractor) : extractor_(std::move(extractor)) {}

void Observer::restart() {
  surface_.restart();
  recent_ = {};
  looked_.reset();
  unseen_s_ = 0;
  person_ = {};
}

void Observer::pass(float dt) {
  unseen_s_ += dt;
  if (unseen_s_ <= kPast_s) return;
  recent_ = {};
  surface_.restart();
}

Observation Observer::observe(const Mesh& scan, float dt) {
  US_CHECK(extractor_, "the pipeline has no skeleton extractor");
  const auto began = std::chrono::steady_clock::now();
  pass(dt);
  Observation seen;
  try {
    const Eigen::Index usable = finite_count(scan.vertices);
    US_CHECK(usable >= kFewestPoints, "the scan has ", usable, " usable points");
    static_cast<Extraction&>(seen) = extracted(scan);
    if (refusal(seen).empty()) {
      recent_.push(seen.joints);
      static_cast<Extraction&>(seen) = surface_.follow(seen, scan);
    }
    look_around(seen, scan);
  } catch (const Error& error) {
    seen = without_skeleton(error.what());
  }
  if (refusal(seen).empty()) {
    unseen_s_ = 0;
    seen.warning = person_.push(seen);
  }
  seen.points = scan.vertices.rows();
  seen.extract_ms = ms_since(began);
  return seen;
}

Observation Observer::observe(const Extraction& given, const Mesh& scan, float dt) {
  Observation seen = observe(given, dt);
  look_around(seen, scan);
  seen.points = scan.vertices.rows();
  return seen;
}

Observation Observer::observe(const Extraction& given, float dt) {
  pass(dt);
  Observation seen;
  static_cast<Extraction&>(seen) = given;
  return seen;
}

Extraction Observer::look(const Mesh& scan) {
  US_CHECK(extractor_, "the pipeline has no skeleton extractor");
  looked_ = Look{scan.vertices, extractor_->extract(scan)};
  return looked_->seen;
}

Extraction Observer::extracted(const Mesh& scan) {
  const std::optional<Look> looked = std::exchange(looked_, std::nullopt);
  const bool same_size = looked && looked->points.rows() == scan.vertices.rows();
  if (same_size && !recent_.last && looked->points == scan.vertices) return looked->seen;
  return extractor_->extract_after(recent_, scan);
}

Observation Observer::skip(std::string problem, float dt) {
  pass(dt);
  return without_skeleton(std::move(problem));
}

}  // namespace understudy
