#include "retarget/pipeline/observer.hpp"

#include <utility>

#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/pipeline/root_path.hpp"

namespace understudy {
namespace {

constexpr int kFewestPoints = 32;  // finite ones below which a scan is not looked at
constexpr float kPast_s = 0.25f;   // how long joints are told on: some frames at any usual rate

/// What the scan shows around a skeleton.
void look_around(Observation& seen, const Mesh& scan) {
  if (!seen.joints.allFinite()) return;
  seen.sole_height = sole_height(seen.joints, scan.vertices);
  seen.girth = measure_girth(seen, scan.vertices);
}

}  // namespace

Observer::Observer(std::shared_ptr<SkeletonExtractor> extractor) : extractor_(std::move(extractor)) {}

void Observer::restart() {
  recent_ = {};
  unseen_s_ = 0;
  person_ = {};
}

void Observer::pass(float dt) {
  unseen_s_ += dt;
  if (unseen_s_ > kPast_s) recent_ = {};
}

Observation Observer::observe(const Mesh& scan, float dt) {
  US_CHECK(extractor_, "the pipeline has no skeleton extractor");
  const auto began = std::chrono::steady_clock::now();
  pass(dt);
  Observation seen;
  try {
    const Eigen::Index usable = finite_count(scan.vertices);
    US_CHECK(usable >= kFewestPoints, "the scan has ", usable, " usable points");
    static_cast<Extraction&>(seen) = extractor_->extract_after(recent_, scan);
    look_around(seen, scan);
  } catch (const Error& error) {
    seen = without_skeleton(error.what());
  }
  if (refusal(seen).empty()) {
    recent_.push(seen.joints);
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

Observation Observer::skip(std::string problem, float dt) {
  pass(dt);
  return without_skeleton(std::move(problem));
}

}  // namespace understudy
