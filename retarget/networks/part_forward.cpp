#include "retarget/networks/part_forward.hpp"

#include "retarget/networks/near_order.hpp"
#include "retarget/networks/transformer_layers.hpp"

namespace understudy::nn {
namespace {

constexpr int kMixed = 256, kSeen = kMixed + kPartContext;  // as the modules have them
constexpr int kTurn1 = 256, kTurn2 = 128, kPlace1 = 128;
constexpr int kTurns = 6 * kPartJoints, kPlaces = 4 * kPartJoints;

/// The layers of one kind under its name in a file.
struct KindLayers {
  const Kernels& with;
  const NetworkWeights& file;
  std::string kind;
  LinearLayer linear(const std::string& name, int inputs, int outputs) const {
    return file.linear(with, kind + "." + name, inputs, outputs);
  }
};

/// What a kind's crops look like.
class PartLook {
 public:
  virtual ~PartLook() = default;
  /// Into the first kMixed columns of found [crops, kSeen], which are zero: the largest of every feature,
  /// rectified.
  virtual void look(const std::vector<PartCrop>& crops, RowMatrix& found) = 0;
};

/// A PointNet. The layer that sees each point beside what all share is two: `own` of the point, whose bias is
/// the result of `shared`.
class PointLook final : public PartLook {
 public:
  explicit PointLook(const KindLayers& kind);
  void look(const std::vector<PartCrop>& crops, RowMatrix& found) override;

 private:
  static constexpr int kNear1 = 64, kNear2 = 128;
  LinearLayer near1_, near2_, own_, shared_, mixed_;
  RowMatrix points_, first_, second_, all_, together_, hidden_;  // buffers
};

PointLook::PointLook(const KindLayers& kind)
    : near1_(kind.linear("near.0", 3, kNear1)),
      near2_(kind.linear("near.2", kNear1, kNear2)),
      mixed_(kind.linear("whole.2", kMixed, kMixed)) {
  const RowMatrix mix = kind.file.tensor(kind.kind + ".whole.0.weight", kMixed, 2 * kNear2 + kPartContext),
                  bias = kind.file.tensor(kind.kind + ".whole.0.bias", kMixed, 1);
  own_ = LinearLayer(kind.with, mix.leftCols(kNear2), RowMatrix::Zero(kMixed, 1));
  shared_ = LinearLayer(kind.with, mix.rightCols(kNear2 + kPartContext), bias);
  near1_.followed_by(shared_);
  near2_.followed_by(own_);
  own_.followed_by(mixed_);
}

void PointLook::look(const std::vector<PartCrop>& crops, RowMatrix& found) {
  const auto count = static_cast<Eigen::Index>(crops.size());
  points_.resize(count * kPartPoints, 3);
  for (Eigen::Index i = 0; i < count; ++i)
    points_.middleRows(i * kPartPoints, kPartPoints) =
        5.0f * crops[i].points(near_order(crops[i].points), Eigen::all);  // a hand is about 0.2 long
  near1_.apply(points_, first_, Finish::Relu);
  near2_.apply(first_, second_, Finish::Relu, /*sparse=*/true);
  all_.resize(count, kNear2 + kPartContext);
  for (Eigen::Index i = 0; i < count; ++i)
    all_.row(i) << second_.middleRows(i * kPartPoints, kPartPoints).colwise().maxCoeff(),
        crops[i].context.transpose();
  shared_.apply(all_, together_);
  hidden_.resize(kPartPoints, kMixed);
  for (Eigen::Index i = 0; i < count; ++i) {
    Product own = own_.product(second_.row(i * kPartPoints).data(), kNear2, kPartPoints, hidden_.data());
    own.bias = together_.row(i).data();
    own.finish = Finish::Relu;
    own.sparse = true;
    own_.run(own);
    Product mixed = mixed_.product(hidden_.data(), kMixed, kPartPoints, found.row(i).data());
    mixed.finish = Finish::Max;
    mixed.sparse = true;
    mixed_.run(mixed);
  }
}

/// Patches as the tokens of a transformer.
class PatchLook final : public PartLook {
 public:
  explicit PatchLook(const KindLayers& kind);
  void look(const std::vector<PartCrop>& crops, RowMatrix& found) override;

 private:
  void look(const PartCrop& crop, float* found);

  static constexpr int kWidth = 128, kLayers = 3, kPatch1 = 64, kPatch2 = 128;
  const Kernels& kernels_;
  PatchLayers patch_layers_;
  LinearLayer patch_out_, told_, widen_;
  TwoLayers position_mlp_;
  std::vector<EncoderLayerWeights> encoder_;
  NormLayer norm_;
  Transformer transformer_;
  RowMatrix looks_, position_, told_here_, x_, normed_;  // buffers
};

PatchLook::PatchLook(const KindLayers& kind)
    : kernels_(kind.with),
      patch_layers_{kind.linear("patch_mlp.0", 3, kPatch1), kind.linear("patch_mlp.2", kPatch1, kPatch2)},
      patch_out_(kind.linear("patch_out", kPatch2, kWidth)),
      told_(kind.linear("told", kPartContext, kWidth)),
      widen_(kind.linear("widen", kWidth, kMixed)),
      position_mlp_(two_layers(kind.file, kind.with, kind.kind + ".position_mlp", 3, kWidth, kWidth)),
      norm_(kind.file.norm(kind.kind + ".norm", kWidth)),
      transformer_(kind.with) {
  for (int i = 0; i < kLayers; ++i)
    encoder_.push_back(
        encoder_layer(kind.file, kind.with, kind.kind + ".encoder." + std::to_string(i), kWidth));
}

void PatchLook::look(const std::vector<PartCrop>& crops, RowMatrix& found) {
  for (size_t i = 0; i < crops.size(); ++i) look(crops[i], found.row(static_cast<Eigen::Index>(i)).data());
}

void PatchLook::look(const PartCrop& crop, float* found) {
  // A hand is about 0.2 long, a patch 0.05.
  const Points centres = 5.0f * crop.points.topRows(kPartPatches);
  const RowMatrix offsets = 20.0f * crop.points.bottomRows(kPartPatches * kPartPatchPoints);
  looks_.setZero(kPartPatches, kPatch2);
  for (int m = 0; m < kPartPatches; ++m)
    patch_layers_.apply(offsets.row(m * kPartPatchPoints).data(), kPartPatchPoints, looks_.row(m).data());
  position_mlp_.apply(centres, position_);
  told_.apply(crop.context.transpose(), told_here_);
  x_ = position_.rowwise() + told_here_.row(0);
  patch_out_.apply(looks_, x_, Finish::Add);
  const RowMatrix squared = squared_distances(centres, centres);
  for (const EncoderLayerWeights& layer : encoder_) transformer_.encode(layer, position_, squared, x_);
  norm_.apply(kernels_, x_, nullptr, normed_);
  Product widened = widen_.product(normed_.data(), kWidth, kPartPatches, found);
  widened.finish = Finish::Max;
  widen_.run(widened);
}

struct PartLayers {
  std::unique_ptr<PartLook> look;
  LinearLayer turn1, turn2, turn3, place1, place2;
};

PartLayers part_layers(const KindLayers& kind, bool in_patches) {
  PartLayers net;
  if (in_patches)
    net.look = std::make_unique<PatchLook>(kind);
  else
    net.look = std::make_unique<PointLook>(kind);
  net.turn1 = kind.linear("head.0", kSeen, kTurn1);
  net.turn2 = kind.linear("head.2", kTurn1, kTurn2);
  net.turn3 = kind.linear("head.4", kTurn2, kTurns);
  net.place1 = kind.linear("place.0", kSeen, kPlace1);
  net.place2 = kind.linear("place.2", kPlace1, kPlaces);
  net.turn1.followed_by(net.turn2);
  net.turn2.followed_by(net.place1);
  return net;
}

}  // namespace

struct PartForward::Impl {
  std::vector<PartLayers> kinds;
  RowMatrix found, turn1, turn2, turn, place1, place;  // buffers
};

PartForward::PartForward(const std::string& path, const Kernels& with) : impl_(std::make_unique<Impl>()) {
  const NetworkWeights file(path, kPartFileKind, kPartVersion);
  for (size_t k = 0; k < kPartKinds; ++k)
    impl_->kinds.push_back(
        part_layers({with, file, kPartNames[k]}, seen_in_patches(static_cast<PartKind>(k))));
}
PartForward::~PartForward() = default;

std::vector<PartOutput> PartForward::run(PartKind kind, const std::vector<PartCrop>& crops) {
  Impl& b = *impl_;
  const PartLayers& net = b.kinds[static_cast<size_t>(kind)];
  b.found.setZero(static_cast<Eigen::Index>(crops.size()), kSeen);
  net.look->look(crops, b.found);
  for (size_t i = 0; i < crops.size(); ++i)
    b.found.row(static_cast<Eigen::Index>(i)).tail<kPartContext>() = crops[i].context.transpose();
  net.turn1.apply(b.found, b.turn1, Finish::Relu);
  net.turn2.apply(b.turn1, b.turn2, Finish::Relu, /*sparse=*/true);
  net.turn3.apply(b.turn2, b.turn, Finish::Store, /*sparse=*/true);
  net.place1.apply(b.found, b.place1, Finish::Relu);
  net.place2.apply(b.place1, b.place, Finish::Store, /*sparse=*/true);
  // Untrained: no rotation, hardly any displacement, an error of 2 % of a leg.
  Eigen::Matrix<float, 1, kPartNumbers> none, unit;
  none << 1, 0, 0, 0, 1, 0, 0, 0, 0, -4;
  unit << 1, 1, 1, 1, 1, 1, .1f, .1f, .1f, 1;
  std::vector<PartOutput> outputs(crops.size());
  for (size_t i = 0; i < crops.size(); ++i)
    for (int k = 0; k < kPartJoints; ++k) {
      const auto row = static_cast<Eigen::Index>(i);
      outputs[i].row(k) << b.turn.row(row).segment<6>(6 * k), b.place.row(row).segment<4>(4 * k);
      outputs[i].row(k) = outputs[i].row(k).cwiseProduct(unit) + none;
    }
  return outputs;
}

}  // namespace understudy::nn
