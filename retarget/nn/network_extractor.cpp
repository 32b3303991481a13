#include "retarget/nn/load.hpp"

#include <torch/torch.h>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/skeleton_form.hpp"

namespace understudy::nn {
namespace {

// Which of a scan's points are looked at: always the same ones, so that the same scan gives the same joints.
constexpr uint64_t kThinningSeed = 20240318;

class NetworkExtractor : public SkeletonExtractor {
 public:
  NetworkExtractor(const std::string& path, const std::string& form, std::unique_ptr<PartRefiner> parts)
      : form_(form), parts_(std::move(parts)), net_(make_skeleton_form(form)) {
    load_skeleton_form(path, form, *net_);
    net_->eval();
  }

  Extraction extract(const Mesh& scan) override { return extract_after({}, scan); }
  std::string name() const override { return form_; }

 private:
  Extraction extract_after(const RecentJoints& recent, const Mesh& scan) override {
    const torch::NoGradGuard no_grad;
    const ScanPatches patches = cut_patches(thin_scan(scan, kThinningSeed));
    Extraction seen = to_world(net_->forward(extractor_input({patches}, {recent})), patches);
    if (parts_) parts_->refine(scan, seen);
    return seen;
  }

  static Extraction to_world(const ExtractorOutput& out, const ScanPatches& patches);

  std::string form_;
  std::unique_ptr<PartRefiner> parts_;
  std::shared_ptr<SkeletonForm> net_;
};

Extraction NetworkExtractor::to_world(const ExtractorOutput& out, const ScanPatches& patches) {
  Extraction extraction;
  const auto joints = out.joints.contiguous();
  const Joints normalised = Eigen::Map<const Joints>(joints.data_ptr<float>());
  extraction.joints = (normalised * patches.scale).rowwise() + patches.centre.transpose();
  US_CHECK(extraction.joints.allFinite(), "the extraction network gave joints that are not finite");
  if (!out.rotations.defined()) return extraction;
  const auto spread = torch::exp(out.log_spread).contiguous();
  for (int j = 0; j < kJointCount; ++j) {
    extraction.confidence[j] = confidence_for(spread.data_ptr<float>()[j] * patches.scale);
  }
  const auto rotations = out.rotations.contiguous();
  extraction.global.emplace();
  for (int j = 0; j < kJointCount; ++j)
    (*extraction.global)[j] = rotation_from_6d(Eigen::Map<const Vec6>(rotations.data_ptr<float>() + 6 * j));
  return extraction;
}

}  // namespace

std::unique_ptr<SkeletonExtractor> load_network_extractor(const std::string& path, const std::string& form,
                                                          std::unique_ptr<PartRefiner> parts) {
  return std::make_unique<NetworkExtractor>(path, form, std::move(parts));
}

}  // namespace understudy::nn
