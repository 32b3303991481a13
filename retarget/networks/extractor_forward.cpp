#include "retarget/networks/extractor_forward.hpp"

#include "retarget/networks/near_order.hpp"
#include "retarget/networks/transformer_layers.hpp"

namespace understudy::nn {
namespace {

constexpr int J = kJointCount, kParts = J + 1;
constexpr int C = 192;  // width of every token, as the module has it
constexpr int kEncoderLayers = 4, kDecoderLayers = 2, kPatchHidden = 64, kPatchWidth = 96;
constexpr int kVotes = 256, kVoteNumbers = kParts + J + 3 * J, kJointHidden = 128, kJointNumbers = 3 + 6 + 1;
constexpr int kPastNumbers = 8;
constexpr float kFarthest = 1.5f;

struct DecoderWeights {
  NormLayer norm1, norm2, norm3;
  LinearLayer self_qkv, self_out, cross_q, cross_out;
  Nearness self_nearness, cross_nearness;
  TwoLayers feed;
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
  Joints vote();
  void add_past(const ScanPatches& patches, const RecentJoints& recent, const Joints& voted);
  void decode(const Joints& voted);

  const Kernels& kernels;
  Transformer transformer;
  PatchLayers patch_layers;
  LinearLayer patch_out, visibility_head, cross_kv;
  TwoLayers position_mlp, recent_mlp, vote_head, joint_head;
  NormLayer token_norm, joint_norm;
  std::vector<EncoderLayerWeights> encoder;
  std::vector<DecoderWeights> decoder;
  RowMatrix joint_embedding;
  bool knows_visibility = false;

  // buffers
  Points centres;  // of the patches, neighbours behind each other
  RowMatrix x, position, squared, h, qkv, pooled, votes, choice;
  RowMatrix y, y_position, tokens, q, kv, past;
};

ExtractorForward::Impl::Impl(const std::string& path, const Kernels& with)
    : kernels(with), transformer(with) {
  const NetworkWeights file(path, "skeleton-dense", kSkeletonVersion);
  const auto linear = [&](const std::string& name, int inputs, int outputs) {
    return file.linear(with, "net." + name, inputs, outputs);
  };
  const auto norm = [&](const std::string& name) { return file.norm("net." + name, C); };
  const auto prepared = [&](const Projection& p) { return LinearLayer(with, p.weight, p.bias); };
  const auto mlp = [&](const std::string& name, int inputs, int hidden, int outputs) {
    return two_layers(file, with, "net." + name, inputs, hidden, outputs);
  };
  patch_layers = {linear("patch_mlp.0", 3, kPatchHidden), linear("patch_mlp.2", kPatchHidden, kPatchWidth)};
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
  for (int i = 0; i < kEncoderLayers; ++i)
    encoder.push_back(encoder_layer(file, with, "net.encoder." + std::to_string(i), C));
  Projection across{RowMatrix(0, C), RowMatrix(0, 1)};
  for (int i = 0; i < kDecoderLayers; ++i) {
    const std::string name = "decoder." + std::to_string(i), self = "net." + name + ".self_attention",
                      cross = "net." + name + ".cross_attention";
    decoder.push_back({norm(name + ".norm1"), norm(name + ".norm2"), norm(name + ".norm3"),
                       prepared(queries(file, self, C).with(keys_and_values(file, self, C))),
                       linear(name + ".self_attention.to_out", C, C), prepared(queries(file, cross, C)),
                       linear(name + ".cross_attention.to_out", C, C), nearness(file, self, C),
                       nearness(file, cross, C), feed_forward(file, with, "net." + name + ".feed", C)});
    across = across.with(keys_and_values(file, cross, C));
  }
  cross_kv = prepared(across);
  for (EncoderLayerWeights& layer : encoder) layer.feed.first.followed_by(layer.feed.second);
}

/// x: what each patch looks like and where it is.
void ExtractorForward::Impl::embed(const ScanPatches& patches) {
  const std::vector<int> order = near_order(patches.centres);
  centres = patches.centres(order, Eigen::all);
  const RowMatrix points = 5.0f * patches.offsets;  // a patch is about 0.2 wide
  pooled.setZero(kPatches, kPatchWidth);
  for (int m = 0; m < kPatches; ++m)  // in the cache, patch by patch
    patch_layers.apply(points.row(order[m] * kPatchPoints).data(), kPatchPoints, pooled.row(m).data());
  position_mlp.apply(centres, position);
  x = position;
  patch_out.apply(pooled, x, Finish::Add);
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
    const Attended themselves = {qkv.data(), qkv.data() + C, qkv.data() + 2 * C, 3 * C, 3 * C, J, J};
    layer.self_out.apply(transformer.attend(themselves, among, layer.self_nearness), y, Finish::Add);
    layer.norm2.apply(kernels, y, &y_position, h);
    layer.cross_q.apply(h, q);
    const float* const keys = kv.data() + 2 * C * i;
    const Attended patches = {q.data(), keys, keys + C, C, kv.cols(), J, kPatches};
    layer.cross_out.apply(transformer.attend(patches, across, layer.cross_nearness), y, Finish::Add);
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
  for (const EncoderLayerWeights& layer : net.encoder)
    net.transformer.encode(layer, net.position, net.squared, net.x);
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
