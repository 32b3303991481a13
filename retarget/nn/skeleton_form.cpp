#include "retarget/nn/skeleton_form.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/nn/modules/point_transformer.hpp"
#include "retarget/nn/modules/tensor_of.hpp"

namespace understudy::nn {
namespace {

class DenseForm : public SkeletonForm {
 public:
  DenseForm() { net_ = register_module("net", SkeletonExtractorNet()); }
  ExtractorOutput forward(const ExtractorInput& input) override { return net_->forward(input); }

 private:
  SkeletonExtractorNet net_{nullptr};
};

/// Joints alone: no parts, votes, rotations or confidence.
class PaperForm : public SkeletonForm {
 public:
  PaperForm() { net_ = register_module("net", PointTransformer()); }
  ExtractorOutput forward(const ExtractorInput& input) override {
    ExtractorOutput out;
    out.joints = net_->forward(input.points);
    return out;
  }

 private:
  PointTransformer net_{nullptr};
};

/// One member of all scans, [B, rows, 3].
torch::Tensor stacked(const std::vector<ScanPatches>& patches, Points ScanPatches::*member) {
  std::vector<torch::Tensor> all;
  for (const ScanPatches& one : patches) all.push_back(tensor_of(one.*member));
  return torch::stack(all);
}

}  // namespace

std::shared_ptr<SkeletonForm> make_skeleton_form(const std::string& name) {
  if (name == "paper") return std::make_shared<PaperForm>();
  US_CHECK(name == "dense", "there is no extraction network '", name, "': dense or paper");
  return std::make_shared<DenseForm>();
}

WeightsHeader skeleton_header(const std::string& name) {
  return {"skeleton-" + name, kSkeletonVersion, {}};
}

bool load_skeleton_form(const std::string& path, const std::string& name, SkeletonForm& form) {
  const auto may_lack = [](const std::string& tensor) { return starts_with(tensor, kVisibilityHead); };
  return load_weights(path, "skeleton-" + name, kSkeletonVersion, form, may_lack).lacking.empty();
}

ExtractorInput extractor_input(const std::vector<ScanPatches>& patches,
                               const std::vector<RecentJoints>& recent) {
  US_CHECK(recent.empty() || recent.size() == patches.size(), patches.size(), " scans with the past of ",
           recent.size());
  ExtractorInput input;
  input.points = stacked(patches, &ScanPatches::points);
  input.centres = stacked(patches, &ScanPatches::centres);
  input.offsets = stacked(patches, &ScanPatches::offsets).view({-1, kPatches, kPatchPoints, 3});
  std::vector<torch::Tensor> joints, known;
  for (size_t b = 0; b < recent.size(); ++b) {
    joints.push_back(tensor_of(normalised_past(recent[b], patches[b])));
    known.push_back(torch::tensor({recent[b].last ? 1.0f : 0.0f, recent[b].before_last ? 1.0f : 0.0f}));
  }
  if (!recent.empty()) input.recent = torch::stack(joints), input.recent_known = torch::stack(known);
  return input;
}

}  // namespace understudy::nn
