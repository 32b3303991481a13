#include "retarget/nn/skeleton_form.hpp"

#include "retarget/base/error.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

class DenseForm : public SkeletonForm {
 public:
  DenseForm() { net_ = register_module("net", SkeletonExtractorNet()); }
  ExtractorOutput forward(const torch::Tensor& centres, const torch::Tensor& offsets) override {
    return net_->forward(centres, offsets);
  }

 private:
  SkeletonExtractorNet net_{nullptr};
};

}  // namespace

std::shared_ptr<SkeletonForm> make_skeleton_form(const std::string& name) {
  US_CHECK(name == "dense", "there is no extraction network '", name, "': dense or paper");
  return std::make_shared<DenseForm>();
}

void save_skeleton_form(const std::string& path, const std::string& name, const SkeletonForm& form,
                        int64_t samples) {
  save_weights(path, {"skeleton-" + name, kSkeletonVersion, {{"samples", static_cast<double>(samples)}}},
               form);
}

void load_skeleton_form(const std::string& path, const std::string& name, SkeletonForm& form) {
  load_weights(path, "skeleton-" + name, kSkeletonVersion, form);
}

}  // namespace understudy::nn
