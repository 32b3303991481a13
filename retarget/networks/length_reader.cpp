#include "retarget/networks/length_reader.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/networks/linear_layer.hpp"
#include "retarget/pose2d/proportion_input.hpp"
#include "retarget/pose2d/reference_remarks.hpp"

namespace understudy::nn {
namespace {

class NetworkLengthReader final : public LengthReader {
 public:
  explicit NetworkLengthReader(const NetworkWeights& file)
      : first_(file.linear(kernels(), "first", kProportionInputs, kProportionWidth)),
        second_(file.linear(kernels(), "second", kProportionWidth, kProportionWidth)),
        third_(file.linear(kernels(), "third", kProportionWidth, kProportionWidth)),
        last_(file.linear(kernels(), "last", kProportionWidth, 2 * kFlatBoneCount)) {}

  PoseLengths read(const FlatPose& pose) const override {
    // It has seen few handstands.
    const FlatPose seen = is_upside_down(pose) ? turned_by_half(pose) : pose;
    const ProportionInput input = proportion_input(seen), mirrored = proportion_input(in_mirror(seen));
    RowMatrix x(2, kProportionInputs), a, b;
    x << input.numbers, mirrored.numbers;
    first_.apply(x, a, Finish::Relu);
    second_.apply(a, b, Finish::Relu);
    third_.apply(b, a, Finish::Relu);
    last_.apply(a, b);
    PoseLengths told;
    for (int bone = 0; bone < kFlatBoneCount; ++bone) {
      const int other = kFlatBoneMirror[static_cast<size_t>(bone)];
      told.log_length[bone] = (b(0, bone) + b(1, other)) / 2 + std::log(input.size);
      const float doubt = (b(0, kFlatBoneCount + bone) + b(1, kFlatBoneCount + other)) / 2;
      told.doubt[bone] = std::exp(std::clamp(doubt, kLeastLogDoubt, kMostLogDoubt));
    }
    US_CHECK(told.log_length.allFinite() && told.doubt.allFinite(),
             "the network that reads lengths has no finite answer to a pose");
    return told;
  }

 private:
  LinearLayer first_, second_, third_, last_;
};

}  // namespace

std::unique_ptr<LengthReader> load_network_length_reader(const std::string& path) {
  return std::make_unique<NetworkLengthReader>(NetworkWeights(path, "proportions", kProportionVersion));
}

}  // namespace understudy::nn
