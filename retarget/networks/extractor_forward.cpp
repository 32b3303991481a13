#include "retarget/networks/extractor_forward.hpp"

#include <array>
#include <cmath>

#include "retarget/networks/linear_layer.hpp"
#include "retarget/networks/near_order.hpp"

namespace understudy::nn {
namespace {

constexpr int J = kJointCount, kParts = J + 1;
constexpr int C = 192, kHeads = 6, kHeadWidth = C / kHeads, kFeedForward = 384;  // as the module has them
constexpr int kEncoderLayers = 4, kDecoderLayers = 2, kPatchHidden = 64, kPatchWidth = 96;
constexpr int kVotes = 256, kVoteNumbers = kParts + J + 3 * J, kJointHidden = 128, kJointNumbers = 3 + 6 + 1;
constexpr int kPastNumbers = 8;
constexpr float kFarthest = 1.5f;
static_assert(kHeadWidth == kPanel, "the values of a head are a panel");

using Factors = std::array<float, kHeads>;

RowMatrix stacked(const RowMatrix& a, const RowMatrix& b) {
  RowMatrix both(a.rows() + b.rows(), a.cols());
  both << a, b;
  return both;
}

/// Weights and biases of projections that are computed together.
struct Projection {
  RowMatrix weight, bias;
  Projection scaled(float by) const { return {weight * by, bias * by}; }
  Projection with(const Projection& next) const {
    return {stacked(weight, next.weight), stacked(bias, next.bias)};
  }
};

Projection projection(const NetworkWeights& file, const std::string& name) {
  return {file.tensor(name + ".weight", C, C), file.tensor(name + ".bias", C, 1)};
}
Projection queries(const NetworkWeights& file, const std::string& attention) {
  return projection(file, attention + ".to_q").scaled(1 / std::sqrt(static_cast<float>(kHeadWidth)));
}
Projection keys_and_values(const NetworkWeights& file, const std::string& attention) {
  return projection(file, attention + ".to_k").with(projection(file, attention + ".to_v"));
}
/// softplus of what was learned
Factors factors(const NetworkWeights& file, const std::string& attention) {
  const RowMatrix nearness = file.tensor(attention + ".nearness", 1, kHeads);
  Factors found;
  for (int h = 0; h < kHeads; ++h) found[h] = std::log1p(std::exp(nearness(0, h)));
  return found;
}

/// Two layers with a rectifier between.
struct TwoLayers {
  LinearLayer first, second;
  mutable RowMatrix hidden{};
  void apply(const RowMatrix& x, RowMatrix& out, Finish finish = Finish::Store) const {
    first.apply(x, hidden, Finish::Relu);
    second.apply(hidden, out, finish, /*sparse=*/true);
  }
};

struct EncoderWeights {
  NormLayer norm1, norm2;
  LinearLayer qkv, out;
  Factors nearness;
  TwoLayers feed;
};

struct DecoderWeights {
  NormLayer norm1, norm2, norm3;
  LinearLayer self_qkv, self_out, cross_q, cross_out;
  Factors self_nearness, cross_nearness;
  TwoLayers feed;
};

RowMatrix squared_distances(const Points& a, const Points& b) {
  RowMatrix squared(a.rows(), (b.rows() + kPanel - 1) / kPanel * kPanel);
  squared.setZero();
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    squared.row(i).head(b.rows()) = (b.rowwise() - a.row(i)).rowwise().squaredNorm().transpose();
  return squared;
}

/// Queries, keys and values in rows of their own strides; the heads' columns lie one behind the other.
struct Attended {
  const float *q, *k, *v;
  std::ptrdiff_t q_stride, kv_stride;
  int queries, keys;
};

}  // namespace

Eigen::Matrix<float, kJointCount, 6, Eigen::RowMajor> normalised_past(const RecentJoints& recent,
                                                                      const ScanPatches& patches) {
  Eigen::Matrix<float, kJointCount, 6, Eigen::RowMajor> rows;
  rows.setZero();
  if (recent.last) rows.leftCols(3) = (recent.last->rowwise() - patches.centre.transpose()) / patches.scale;
  if (recent.before_last) rows.rightCols(3) = (*recent.last - *recent.before_last) / patches.scale;
  return rows;
}

struct ExtractorForward::Impl {
  Impl(const std::string& path, const Kernels& with);

  void embed(const ScanPatches& patches);
  void encode(const EncoderWeights& layer);
  Joints vote();
  void add_past(const ScanPatches& patches, const RecentJoints& recent, const Joints& voted);
  void decode(const Joints& voted);
  void attend(const Attended& a, const RowMatrix& squared, const Factors& nearness);

  const Kernels& kernels;
  LinearLayer patch1, patch2, patch_out, visibility_head, cross_kv;
  TwoLayers position_mlp, recent_mlp, vote_head, joint_head;
  NormLayer token_norm, joint_norm;
  std::vector<EncoderWeights> encoder;
  std::vector<DecoderWeights> decoder;
  RowMatrix joint_embedding;
  bool knows_visibility = false;

  // buffers
  Points centres;  // of the patches, neighbours behind each other
  RowMatrix x, position, squared, h, qkv, mixed, pooled, patch_hidden, turned_keys, scores, votes, choice;
  RowMatrix y, y_position, tokens, q, kv, past;
};

ExtractorForward::Impl::Impl(const std::string& path, const Kernels& with) : kernels(with) {
  const NetworkWeights file(path, "skeleton-dense", kSkeletonVersion);
  const auto linear = [&](const std::string& name, int inputs, int outputs) {
    return file.linear(with, "net." + name, inputs, outputs);
  };
  const auto norm = [&](const std::string& name) { return file.norm("net." + name, C); };
  const auto prepared = [&](const Projection& p) { return LinearLayer(with, p.weight, p.bias); };
  const auto feed = [&](const std::string& name) {
    return TwoLayers{linear(name + ".feed.up", C, kFeedForward),
                     linear(name + ".feed.down", kFeedForward, C)};
  };
  const auto mlp = [&](const std::string& name, int inputs, int hidden, int outputs) {
    return TwoLayers{linear(name + ".0", inputs, hidden), linear(name + ".2", hidden, outputs)};
  };
  patch1 = linear("patch_mlp.0", 3, kPatchHidden);
  patch2 = linear("patch_mlp.2", kPatchHidden, kPatchWidth);
  patch_out = linear("patch_out", kPatchWidth, C);
  position_mlp = mlp("position_mlp", 3, C, C);
  recent_mlp = mlp("recent_mlp", kPastNumbers, C, C);
  vote_head = mlp("vote_head", C, kVotes, kVoteNumbers);
  joint_head = mlp("joint_head", C, kJointHidden, kJointNumbers);
  token_norm = norm("token_norm");
  joint_norm = norm("joint_norm");
  joint_embedding = file.tensor("net.joint_embedding", J, C);
  knows_visibility = file.has(std::string(kVisibilityHead) + "weight");
  if (knows_visibility) visibility_head = linear("visibility_head", C, 1);
  for (int i = 0; i < kEncoderLayers; ++i) {
    const std::string name = "encoder." + std::to_string(i), attention = "net." + name + ".attention";
    encoder.push_back({norm(name + ".norm1"), norm(name + ".norm2"),
                       prepared(queries(file, attention).with(keys_and_values(file, attention))),
                       linear(name + ".attention.to_out", C, C), factors(file, attention), feed(name)});
  }
  Projection across{RowMatrix(0, C), RowMatrix(0, 1)};
  for (int i = 0; i < kDecoderLayers; ++i) {
    const std::string name = "decoder." + std::to_string(i), self = "net." + name + ".self_attention",
                      cross = "net." + name + ".cross_attention";
    decoder.push_back({norm(name + ".norm1"), norm(name + ".norm2"), norm(name + ".norm3"),
                       prepared(queries(file, self).with(keys_and_values(file, self))),
                       linear(name + ".self_attention.to_out", C, C), prepared(queries(file, cross)),
                       linear(name + ".cross_attention.to_out", C, C), factors(file, self),
                       factors(file, cross), feed(name)});
    across = across.with(keys_and_values(file, cross));
  }
  cross_kv = prepared(across);
  for (EncoderWeights& layer : encoder) layer.feed.first.followed_by(layer.feed.second);
}

/// x: what each patch looks like and where it is.
void ExtractorForward::Impl::embed(const ScanPatches& patches) {
  const std::vector<int> order = near_order(patches.centres);
  centres = patches.centres(order, Eigen::all);
  const RowMatrix points = 5.0f * patches.offsets;  // a patch is about 0.2 wide
  pooled.setZero(kPatches, kPatchWidth);
  patch_hidden.resize(kPatchPoints, kPatchHidden);
  for (int m = 0; m < kPatches; ++m) {  // in the cache, patch by patch
    Product first =
        patch1.product(points.row(order[m] * kPatchPoints).data(), 3, kPatchPoints, patch_hidden.data());
    first.finish = Finish::Relu;
    patch1.run(first);
    Product second = patch2.product(patch_hidden.data(), kPatchHidden, kPatchPoints, pooled.row(m).data());
    second.finish = Finish::Max;  // from 0: rectified
    patch2.run(second);
  }
  position_mlp.apply(centres, position);
  x = position;
  patch_out.apply(pooled, x, Finish::Add);
}

void ExtractorForward::Impl::attend(const Attended& a, const RowMatrix& squared_distance,
                                    const Factors& nearness) {
  const int panels = (a.keys + kPanel - 1) / kPanel, padded = panels * kPanel;
  turned_keys.setZero(panels * kHeadWidth, kPanel);
  scores.resize(a.queries, padded);
  mixed.resize(a.queries, C);
  for (int head = 0; head < kHeads; ++head) {
    for (int n = 0; n < a.keys; ++n) {
      const float* const key = a.k + n * a.kv_stride + head * kHeadWidth;
      float* const to = turned_keys.data() + n / kPanel * kHeadWidth * kPanel + n % kPanel;
      for (int i = 0; i < kHeadWidth; ++i) to[i * kPanel] = key[i];
    }
    kernels.multiply({a.q + head * kHeadWidth, a.q_stride, a.queries, kHeadWidth, turned_keys.data(), kPanel,
                      kHeadWidth * kPanel, panels, nullptr, scores.data(), padded, Finish::Store, nullptr, 0,
                      false});
    kernels.softmax({scores.data(), padded, squared_distance.data(), squared_distance.cols(), a.queries,
                     a.keys, nearness[head]});
    kernels.multiply({scores.data(), padded, a.queries, a.keys, a.v + head * kHeadWidth, a.kv_stride, 0, 1,
                      nullptr, mixed.data() + head * kHeadWidth, C, Finish::Store, nullptr, 0, false});
  }
}

void ExtractorForward::Impl::encode(const EncoderWeights& layer) {
  layer.norm1.apply(kernels, x, &position, h);
  layer.qkv.apply(h, qkv);
  attend({qkv.data(), qkv.data() + C, qkv.data() + 2 * C, 3 * C, 3 * C, kPatches, kPatches}, squared,
         layer.nearness);
  layer.out.apply(mixed, x, Finish::Add);
  layer.norm2.apply(kernels, x, nullptr, h);
  layer.feed.apply(h, x, Finish::Add);
}

/// The patches' votes for the joints; `choice` [22, patches] becomes how much each is believed.
Joints ExtractorForward::Impl::vote() {
  vote_head.apply(x, votes);
  choice = votes.middleCols(kParts, J).transpose();
  kernels.softmax({choice.data(), kPatches, nullptr, 0, J, kPatches, 0});
  Joints voted = choice * centres;
  for (int m = 0; m < kPatches; ++m)
    voted += choice.col(m).asDiagonal() * Eigen::Map<const Joints>(votes.row(m).data() + kParts + J);
  return voted;
}

void ExtractorForward::Impl::add_past(const ScanPatches& patches, const RecentJoints& recent,
                                      const Joints& voted) {
  if (!recent.last) return;
  const auto seen = normalised_past(recent, patches);
  past.setZero(J, kPastNumbers);
  past.leftCols<3>() = (seen.leftCols<3>() - voted).cwiseMax(-kFarthest).cwiseMin(kFarthest);
  past.col(6).setOnes();
  if (recent.before_last) {
    past.middleCols<3>(3) = seen.rightCols<3>().cwiseMax(-kFarthest).cwiseMin(kFarthest);
    past.col(7).setOnes();
  }
  recent_mlp.apply(past, y, Finish::Add);
}

/// y [22, C]: the joints as tokens, from what was voted.
void ExtractorForward::Impl::decode(const Joints& voted) {
  const Points at = voted;
  const RowMatrix among = squared_distances(at, at), across = squared_distances(at, centres);
  position_mlp.apply(at, y_position);
  cross_kv.apply(tokens, kv);
  for (int i = 0; i < kDecoderLayers; ++i) {
    const DecoderWeights& layer = decoder[i];
    layer.norm1.apply(kernels, y, &y_position, h);
    layer.self_qkv.apply(h, qkv);
    attend({qkv.data(), qkv.data() + C, qkv.data() + 2 * C, 3 * C, 3 * C, J, J}, among, layer.self_nearness);
    layer.self_out.apply(mixed, y, Finish::Add);
    layer.norm2.apply(kernels, y, &y_position, h);
    layer.cross_q.apply(h, q);
    const float* const keys = kv.data() + 2 * C * i;
    attend({q.data(), keys, keys + C, C, kv.cols(), J, kPatches}, across, layer.cross_nearness);
    layer.cross_out.apply(mixed, y, Finish::Add);
    layer.norm3.apply(kernels, y, nullptr, h);
    layer.feed.apply(h, y, Finish::Add);
  }
}

ExtractorForward::ExtractorForward(const std::string& path, const Kernels& with)
    : impl_(std::make_unique<Impl>(path, with)) {}
ExtractorForward::~ExtractorForward() = default;

ExtractorForwardOutput ExtractorForward::run(const ScanPatches& patches, const RecentJoints& recent) {
  Impl& net = *impl_;
  net.embed(patches);
  net.squared = squared_distances(net.centres, net.centres);
  for (const EncoderWeights& layer : net.encoder) net.encode(layer);
  net.token_norm.apply(net.kernels, net.x, nullptr, net.h);
  net.x.swap(net.h);
  const Joints voted = net.vote();
  net.tokens = net.x + net.position;
  net.y = net.joint_embedding;
  net.kernels.multiply({net.choice.data(), kPatches, J, kPatches, net.tokens.data(), C, kPanel, C / kPanel,
                        nullptr, net.y.data(), C, Finish::Add, nullptr, 0, false});
  net.add_past(patches, recent, voted);
  net.decode(voted);
  net.joint_norm.apply(net.kernels, net.y, nullptr, net.h);
  net.joint_head.apply(net.h, net.q);
  ExtractorForwardOutput out;
  out.joints = voted + 0.1f * net.q.leftCols<3>();
  out.rotations = net.q.middleCols<6>(3);
  out.rotations.col(0).array() += 1;
  out.rotations.col(4).array() += 1;
  out.log_spread = net.q.col(9).array() - 3;
  if (!net.knows_visibility) return out;
  net.visibility_head.apply(net.h, net.q);
  out.visibility = net.q.col(0).array();
  return out;
}

}  // namespace understudy::nn
