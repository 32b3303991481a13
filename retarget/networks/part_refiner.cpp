#include "retarget/networks/part_refiner.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/networks/part_forward.hpp"

namespace understudy::nn {
namespace {

constexpr int kRounds = 2;  // the second crop lies better than the first

// A crop shows more of a joint's error than the whole body does, the two together still more.
constexpr float kShareOfCrop = 0.7f;
// A joint that may be farther off than so is perhaps looked for in the wrong place, at the other leg say,
// where the crop does not show it. Metres: from where that begins to where the crop is not believed at
// all.
constexpr float kNear = 0.05f, kAstray = 0.12f;
constexpr int kSurfacePoints = 8192;
constexpr uint64_t kSurfaceSeed = 20240319;

/// All points of a cloud, many of a surface.
Points dense_points(const Mesh& scan) {
  if (scan.is_cloud() || !scan.vertices.allFinite()) return scan.vertices;
  Rng rng(kSurfaceSeed);
  return sample_points(scan, kSurfacePoints, rng);
}

/// Of a joint that was seen with the confidence `whole`, then from near with `crop`.
float confidence_of_both(float crop, float whole);

class NetworkPartRefiner final : public PartRefiner {
 public:
  explicit NetworkPartRefiner(const std::string& path) : net_(path) {}

  void refine(const Mesh& scan, Extraction& seen) override {
    if (!seen.global) return;
    const Points points = dense_points(scan);
    const auto whole = seen.confidence;  // from the whole body
    // From the trunk outwards: a hand is looked at beside the forearm as it is known by then.
    for (int round = 0; round < kRounds; ++round)
      for (const PartKind kind :
           {PartKind::Arm, PartKind::Hand, PartKind::Head, PartKind::Leg, PartKind::Foot})
        refine_kind(points, kind, seen);
    for (int j = 0; j < kJointCount; ++j)
      if (seen.confidence[j] != whole[j])
        seen.confidence[j] = confidence_of_both(seen.confidence[j], whole[j]);
  }

 private:
  void refine_kind(const Points& points, PartKind kind, Extraction& seen);
  static void correct(int slot, const Part& part, const PartOutput& output, const Extraction& before,
                      Extraction& seen);

  PartForward net_;
};

void NetworkPartRefiner::refine_kind(const Points& points, PartKind kind, Extraction& seen) {
  std::vector<const Part*> parts;
  std::vector<PartCrop> crops;
  for (const Part& part : kCroppedParts) {
    if (part.kind != kind) continue;
    auto crop = cut_part(points, seen, part);
    if (!crop) continue;
    parts.push_back(&part);
    crops.push_back(std::move(*crop));
  }
  if (parts.empty()) return;
  const std::vector<PartOutput> outputs = net_.run(kind, crops);
  const Extraction before = seen;
  for (size_t i = 0; i < parts.size(); ++i)
    for (int k = 0; k < kPartJoints; ++k) correct(k, *parts[i], outputs[i], before, seen);
}

void NetworkPartRefiner::correct(int slot, const Part& part, const PartOutput& output,
                                 const Extraction& before, Extraction& seen) {
  const int joint = part.corrects[slot];
  if (joint < 0) return;
  const Mat3 local = rotation_from_6d(output.row(slot).head<6>().transpose());
  (*seen.global)[joint] = from_part(local, before, part);
  if (slot >= part.moves) return;
  const Vec3 displacement = vector_from_part(output.row(slot).segment<3>(6).transpose(), before, part);
  seen.joints.row(joint) = before.joints.row(joint) + displacement.transpose();
  seen.confidence[joint] = confidence_for(std::exp(output(slot, 9)) * leg_length(before.joints));
}

float confidence_of_both(float crop, float whole) {
  constexpr float kLeast = 0.001f;  // metres
  const float near = std::max(kLeast, expected_error_for(crop)),
              far = std::max(kLeast, expected_error_for(whole));
  const float both = std::pow(near, kShareOfCrop) * std::pow(far, 1 - kShareOfCrop);
  const float astray = smooth_step(kNear, kAstray, far);
  return confidence_for(both + astray * (std::max(both, far) - both));
}

}  // namespace

std::unique_ptr<PartRefiner> load_part_refiner(const std::string& path) {
  return std::make_unique<NetworkPartRefiner>(path);
}

}  // namespace understudy::nn
