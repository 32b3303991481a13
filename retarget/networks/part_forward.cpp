#include "retarget/networks/part_forward.hpp"

#include "retarget/networks/linear_layer.hpp"
#include "retarget/networks/near_order.hpp"

namespace understudy::nn {
namespace {

constexpr int kNear1 = 64, kNear2 = 128, kMixed = 256,
              kSeen = kMixed + kPartContext;  // as the module has them
constexpr int kTurn1 = 256, kTurn2 = 128, kPlace1 = 128;
constexpr int kTurns = 6 * kPartJoints, kPlaces = 4 * kPartJoints;

/// A PointNet of one kind of part. The layer that sees each point beside what all share is two: `own` of the
/// point, whose bias is the result of `shared`.
struct PartLayers {
  LinearLayer near1, near2, own, shared, mixed, turn1, turn2, turn3, place1, place2;
};

PartLayers part_layers(const Kernels& with, const NetworkWeights& file, const std::string& kind) {
  const auto linear = [&](const std::string& name, int inputs, int outputs) {
    return file.linear(with, kind + "." + name, inputs, outputs);
  };
  const RowMatrix mix = file.tensor(kind + ".whole.0.weight", kMixed, 2 * kNear2 + kPartContext),
                  bias = file.tensor(kind + ".whole.0.bias", kMixed, 1);
  PartLayers net = {linear("near.0", 3, kNear1),
                    linear("near.2", kNear1, kNear2),
                    LinearLayer(with, mix.leftCols(kNear2), RowMatrix::Zero(kMixed, 1)),
                    LinearLayer(with, mix.rightCols(kNear2 + kPartContext), bias),
                    linear("whole.2", kMixed, kMixed),
                    linear("head.0", kSeen, kTurn1),
                    linear("head.2", kTurn1, kTurn2),
                    linear("head.4", kTurn2, kTurns),
                    linear("place.0", kSeen, kPlace1),
                    linear("place.2", kPlace1, kPlaces)};
  net.near1.followed_by(net.shared);
  net.near2.followed_by(net.own);
  net.own.followed_by(net.mixed);
  net.mixed.followed_by(net.turn1);
  net.turn1.followed_by(net.turn2);
  net.turn2.followed_by(net.place1);
  return net;
}

}  // namespace

struct PartForward::Impl {
  std::vector<PartLayers> kinds;
  RowMatrix points, near1, near2, all, shared, hidden, found, turn1, turn2, turn, place1, place;  // buffers
  void look(const PartLayers& net, const std::vector<PartCrop>& crops);
};

PartForward::PartForward(const std::string& path, const Kernels& with) : impl_(std::make_unique<Impl>()) {
  const NetworkWeights file(path, kPartFileKind, kPartVersion);
  for (const char* kind : {"hand", "skull", "foot", "arm", "leg"})  // in the order of PartKind
    impl_->kinds.push_back(part_layers(with, file, kind));
}
PartForward::~PartForward() = default;

/// found [crops, kSeen]: the largest of every feature among the points, and the context.
void PartForward::Impl::look(const PartLayers& net, const std::vector<PartCrop>& crops) {
  const auto count = static_cast<Eigen::Index>(crops.size());
  points.resize(count * kPartPoints, 3);
  for (Eigen::Index i = 0; i < count; ++i)
    points.middleRows(i * kPartPoints, kPartPoints) =
        5.0f * crops[i].points(near_order(crops[i].points), Eigen::all);  // a hand is about 0.2 long
  net.near1.apply(points, near1, Finish::Relu);
  net.near2.apply(near1, near2, Finish::Relu, /*sparse=*/true);
  all.resize(count, kNear2 + kPartContext);
  for (Eigen::Index i = 0; i < count; ++i)
    all.row(i) << near2.middleRows(i * kPartPoints, kPartPoints).colwise().maxCoeff(),
        crops[i].context.transpose();
  net.shared.apply(all, shared);
  hidden.resize(kPartPoints, kMixed);
  found.setZero(count, kSeen);  // the pooled features are rectified
  for (Eigen::Index i = 0; i < count; ++i) {
    Product own = net.own.product(near2.row(i * kPartPoints).data(), kNear2, kPartPoints, hidden.data());
    own.bias = shared.row(i).data();
    own.finish = Finish::Relu;
    own.sparse = true;
    net.own.run(own);
    Product mixed = net.mixed.product(hidden.data(), kMixed, kPartPoints, found.row(i).data());
    mixed.finish = Finish::Max;
    mixed.sparse = true;
    net.mixed.run(mixed);
    found.row(i).tail<kPartContext>() = crops[i].context.transpose();
  }
}

std::vector<PartOutput> PartForward::run(PartKind kind, const std::vector<PartCrop>& crops) {
  Impl& b = *impl_;
  const PartLayers& net = b.kinds[static_cast<size_t>(kind)];
  b.look(net, crops);
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
