#include <torch/torch.h>

#include "retarget/base/error.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/skeleton_form.hpp"

namespace understudy::nn {
namespace {

constexpr const char* kForm = "paper";

class PaperExtractor final : public SkeletonExtractor {
 public:
  explicit PaperExtractor(const std::string& path) : net_(make_skeleton_form(kForm)) {
    load_skeleton_form(path, kForm, *net_);
    net_->eval();
  }
  Extraction extract(const Mesh& scan) override {
    const torch::NoGradGuard no_grad;
    const ScanPatches patches = cut_patches(thin_scan(scan, kThinningSeed));
    const auto joints = net_->forward(extractor_input({patches})).joints.contiguous();
    Extraction seen;
    const Joints normalised = Eigen::Map<const Joints>(joints.data_ptr<float>());
    seen.joints = (normalised * patches.scale).rowwise() + patches.centre.transpose();
    US_CHECK(seen.joints.allFinite(), "the extraction network gave joints that are not finite");
    return seen;
  }
  std::string name() const override { return kForm; }

 private:
  std::shared_ptr<SkeletonForm> net_;
};

}  // namespace

std::unique_ptr<SkeletonExtractor> load_paper_extractor(const std::string& path) {
  return std::make_unique<PaperExtractor>(path);
}

}  // namespace understudy::nn
