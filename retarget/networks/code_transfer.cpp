#include "retarget/networks/code_transfer.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/networks/linear_layer.hpp"
#include "retarget/pose2d/pose_code.hpp"
#include "retarget/pose2d/ride_along.hpp"

namespace understudy::nn {
namespace {

/// A layer over points and one within each: x [15, C] -> [15, D].
class CodeLayer {
 public:
  CodeLayer(const NetworkWeights& file, const std::string& name, int width)
      : mix_(file.tensor(name + ".mix", kPaperPoints, kPaperPoints)),
        within_(file.linear(kernels(), name + ".within", width, width)) {}

  RowMatrix apply(const RowMatrix& x) const {
    RowMatrix y;
    within_.apply(mix_ * x, y);
    return y;
  }

 private:
  RowMatrix mix_;
  LinearLayer within_;
};

/// Each column with mean 0 and variance 1 over the points.
void normalise(RowMatrix& x) {
  const Eigen::RowVectorXf mean = x.colwise().mean();
  x.rowwise() -= mean;
  const Eigen::RowVectorXf variance = x.array().square().colwise().mean();
  x.array().rowwise() *= (variance.array() + kCodeVariance).rsqrt();
}

class CodeTransfer final : public KeypointTransfer {
 public:
  explicit CodeTransfer(const NetworkWeights& file)
      : in_(file.linear(kernels(), "pose.first", kPoseCodeInputs, kPoseCodeWidth)),
        code_(file.linear(kernels(), "pose.last", kPoseCodeWidth, kPoseDecoderWidth)),
        person_{file.linear(kernels(), "person.first", kFlatBoneCount, kPersonHidden),
                file.linear(kernels(), "person.second", kPersonHidden, kPersonHidden),
                file.linear(kernels(), "person.last", kPersonHidden, kPersonCodeWidth),
                file.linear(kernels(), "style.first", kPersonCodeWidth, kPersonHidden),
                file.linear(kernels(), "style.last", kPersonHidden, 4 * kPoseCodeBlocks * kPoseDecoderWidth)},
        out_(file.linear(kernels(), "out.first", kPoseDecoderWidth, kPoseCodeWidth)),
        points_(file.linear(kernels(), "out.last", kPoseCodeWidth, 2)) {
    for (int k = 0; k < kPoseCodeBlocks; ++k) {
      encoder_.emplace_back(file, "pose.block" + std::to_string(k), kPoseCodeWidth);
      decoder_.emplace_back(file, "decoder.first" + std::to_string(k), kPoseDecoderWidth);
      decoder_.emplace_back(file, "decoder.second" + std::to_string(k), kPoseDecoderWidth);
    }
  }

  FlatPose transfer(const FlatPose& seen, const Proportions& from, const Proportions& to) override {
    FlatPose source = seen;
    add_middles(source);
    const float unit = kPoseCodeUnit * stature_of(to.length);
    const RowMatrix made =
        decoded(encoded(pose_code_input(source, stature_of(from.length))), styles_of(to.length));
    US_CHECK(made.allFinite(), "the network of engine paper has no finite answer to a pose");
    FlatPose pose;
    const int still = source.has(body25::MidHip) ? body25::MidHip : body25::Neck;
    for (int p = 0; p < kPaperPoints; ++p) {
      if (!source.has(p)) continue;
      const Vec2 way(made(p, 0) - made(still, 0), made(still, 1) - made(p, 1));
      pose.set(p, source.at(still) + unit * way, source.confidence(p));
    }
    ride_along(source, to.length / from.length, pose);
    return pose;
  }
  std::string name() const override { return "paper"; }

 private:
  RowMatrix encoded(const PoseCodeInput& input) const {
    RowMatrix x, code;
    in_.apply(RowMatrix(input), x);
    for (const CodeLayer& block : encoder_) {
      RowMatrix y = block.apply(x);
      normalise(y);
      x += y.cwiseMax(0);
    }
    code_.apply(x, code);
    return code;
  }
  /// A row each: scale and shift of the first layer, then of the second, of each block.
  RowMatrix styles_of(const BoneLengths& lengths) const {
    RowMatrix x = RowMatrix(person_code_input(lengths)), y;
    person_[0].apply(x, y, Finish::Relu);
    person_[1].apply(y, x, Finish::Relu);
    person_[2].apply(x, y);
    person_[3].apply(y, x, Finish::Relu);
    person_[4].apply(x, y);
    return Eigen::Map<const RowMatrix>(y.data(), 4 * kPoseCodeBlocks, kPoseDecoderWidth);
  }
  RowMatrix decoded(RowMatrix x, const RowMatrix& styles) const {
    for (int k = 0; k < kPoseCodeBlocks; ++k) {
      RowMatrix y = x;
      for (int half = 0; half < 2; ++half) {
        const int row = 4 * k + 2 * half;
        y = decoder_[static_cast<size_t>(2 * k + half)].apply(y);
        normalise(y);
        y.array().rowwise() *= 1 + styles.row(row).array();
        y.rowwise() += styles.row(row + 1);
        if (half == 0) y = y.cwiseMax(0);
      }
      x += y;
    }
    RowMatrix hidden, points;
    out_.apply(x, hidden, Finish::Relu);
    points_.apply(hidden, points);
    return points.leftCols(2);
  }

  LinearLayer in_, code_;
  std::vector<CodeLayer> encoder_, decoder_;
  std::array<LinearLayer, 5> person_;
  LinearLayer out_, points_;
};

}  // namespace

std::unique_ptr<KeypointTransfer> load_code_transfer(const std::string& path) {
  return std::make_unique<CodeTransfer>(NetworkWeights(path, "pose2d", kPoseCodeVersion));
}

}  // namespace understudy::nn
