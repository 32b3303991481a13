#include "retarget/nn/skeleton_form.hpp"

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/point_transformer.hpp"

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

}  // namespace

std::shared_ptr<SkeletonForm> make_skeleton_form(const std::string& name) {
  if (name == "paper") return std::make_shared<PaperForm>();
  US_CHECK(name == "dense", "there is no extraction network '", name, "': dense or paper");
  return std::make_shared<DenseForm>();
}

WeightsHeader skeleton_header(const std::string& name) {
  return {"skeleton-" + name, kSkeletonVersion, {}};
}

void load_skeleton_form(const std::string& path, const std::string& name, SkeletonForm& form) {
  load_weights(path, "skeleton-" + name, kSkeletonVersion, form);
}

}  // namespace understudy::nn
