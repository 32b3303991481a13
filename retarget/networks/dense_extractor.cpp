#include "retarget/networks/dense_extractor.hpp"

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/networks/extractor_forward.hpp"

namespace understudy::nn {
namespace {

class DenseExtractor final : public SkeletonExtractor {
 public:
  DenseExtractor(const std::string& path, std::unique_ptr<PartRefiner> parts)
      : net_(path), parts_(std::move(parts)) {}

  Extraction extract(const Mesh& scan) override { return extract_after({}, scan); }
  Extraction extract_after(const RecentJoints& recent, const Mesh& scan) override {
    const ScanPatches patches = cut_patches(thin_scan(scan, kThinningSeed));
    Extraction seen = to_world(net_.run(patches, recent), patches);
    if (parts_) parts_->refine(scan, seen);
    return seen;
  }
  std::string name() const override { return "dense"; }

 private:
  static Extraction to_world(const ExtractorForwardOutput& out, const ScanPatches& patches);

  ExtractorForward net_;
  std::unique_ptr<PartRefiner> parts_;
};

Extraction DenseExtractor::to_world(const ExtractorForwardOutput& out, const ScanPatches& patches) {
  Extraction extraction;
  extraction.joints = (out.joints * patches.scale).rowwise() + patches.centre.transpose();
  US_CHECK(extraction.joints.allFinite(), "the extraction network gave joints that are not finite");
  extraction.global.emplace();
  for (int j = 0; j < kJointCount; ++j) {
    extraction.confidence[j] = confidence_for(std::exp(out.log_spread[j]) * patches.scale);
    (*extraction.global)[j] = rotation_from_6d(out.rotations.row(j).transpose());
  }
  if (out.visibility) extraction.visibility = (1 + (-*out.visibility).exp()).inverse();
  return extraction;
}

}  // namespace

std::unique_ptr<SkeletonExtractor> load_dense_extractor(const std::string& path,
                                                        std::unique_ptr<PartRefiner> parts) {
  return std::make_unique<DenseExtractor>(path, std::move(parts));
}

}  // namespace understudy::nn
