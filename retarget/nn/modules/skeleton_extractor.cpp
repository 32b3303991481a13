#include "retarget/nn/modules/skeleton_extractor.hpp"

#include <cmath>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t J = kJointCount;
constexpr int64_t kParts = J + 1;
constexpr int64_t C = 192, kAttentionHeads = 6;  // C: width of every token
constexpr int64_t kEncoderLayers = 4, kDecoderLayers = 2;
constexpr double kFarthest = 1.5;  // beyond that the frame before is of somebody else

torch::nn::LayerNorm layer_norm(int64_t width = C) {
  return torch::nn::LayerNorm(torch::nn::LayerNormOptions({width}));
}

}  // namespace

torch::Tensor squared_distance(const torch::Tensor& a, const torch::Tensor& b) {
  return a.square().sum(-1, true) + b.square().sum(-1).unsqueeze(1) - 2 * torch::matmul(a, b.transpose(1, 2));
}

DistanceAttentionImpl::DistanceAttentionImpl(int64_t width, int64_t heads) : heads_(heads) {
  for (auto [layer, name] : {std::pair{&to_q, "to_q"}, {&to_k, "to_k"}, {&to_v, "to_v"}, {&to_out, "to_out"}})
    *layer = register_module(name, torch::nn::Linear(width, width));
  nearness = register_parameter("nearness", torch::linspace(-3.0, 2.0, heads).view({1, heads, 1, 1}));
}

torch::Tensor DistanceAttentionImpl::forward(const torch::Tensor& q, const torch::Tensor& k,
                                             const torch::Tensor& v, const torch::Tensor& squared) {
  const auto split = [this](const torch::Tensor& x) {  // [B, N, C] -> [B, H, N, C/H]
    return x.view({x.size(0), x.size(1), heads_, -1}).transpose(1, 2);
  };
  const auto Q = split(to_q(q)), K = split(to_k(k)), V = split(to_v(v));
  const double scale = 1.0 / std::sqrt(static_cast<double>(Q.size(3)));
  const auto score = torch::matmul(Q * scale, K.transpose(2, 3)) -
                     torch::nn::functional::softplus(nearness) * squared.unsqueeze(1);  // [B, H, Q, K]
  const auto mixed = torch::matmul(torch::softmax(score, -1), V);                       // [B, H, Q, C/H]
  return to_out(mixed.transpose(1, 2).reshape({q.size(0), q.size(1), -1}));
}

FeedForwardImpl::FeedForwardImpl(int64_t width) {
  up = register_module("up", torch::nn::Linear(width, 2 * width));
  down = register_module("down", torch::nn::Linear(2 * width, width));
}

torch::Tensor FeedForwardImpl::forward(const torch::Tensor& x) {
  return down(torch::relu(up(x)));
}

EncoderLayerImpl::EncoderLayerImpl(int64_t width, int64_t heads) {
  norm1 = register_module("norm1", layer_norm(width));
  norm2 = register_module("norm2", layer_norm(width));
  attention = register_module("attention", DistanceAttention(width, heads));
  feed = register_module("feed", FeedForward(width));
}

torch::Tensor EncoderLayerImpl::forward(const torch::Tensor& x, const torch::Tensor& position,
                                        const torch::Tensor& squared) {
  const auto h = norm1(x) + position;
  const auto y = x + attention(h, h, h, squared);
  return y + feed(norm2(y));
}

JointDecoderLayerImpl::JointDecoderLayerImpl() {
  norm1 = register_module("norm1", layer_norm());
  norm2 = register_module("norm2", layer_norm());
  norm3 = register_module("norm3", layer_norm());
  self_attention = register_module("self_attention", DistanceAttention(C, kAttentionHeads));
  cross_attention = register_module("cross_attention", DistanceAttention(C, kAttentionHeads));
  feed = register_module("feed", FeedForward(C));
}

torch::Tensor JointDecoderLayerImpl::forward(const torch::Tensor& x, const torch::Tensor& x_position,
                                             const torch::Tensor& tokens, const torch::Tensor& among,
                                             const torch::Tensor& across) {
  const auto h = norm1(x) + x_position;
  auto y = x + self_attention(h, h, h, among);
  y = y + cross_attention(norm2(y) + x_position, tokens, tokens, across);
  return y + feed(norm3(y));
}

SkeletonExtractorNetImpl::SkeletonExtractorNetImpl() {
  using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;
  patch_mlp = register_module("patch_mlp", Sequential(Linear(3, 64), ReLU(), Linear(64, 96), ReLU()));
  patch_out = register_module("patch_out", Linear(96, C));
  position_mlp = register_module("position_mlp", Sequential(Linear(3, C), ReLU(), Linear(C, C)));
  recent_mlp = register_module("recent_mlp", Sequential(Linear(8, C), ReLU(), Linear(C, C)));
  // At first the past has no effect: a network of single scans is trained on from where it is.
  torch::nn::init::zeros_(recent_mlp[2]->as<torch::nn::LinearImpl>()->weight);
  torch::nn::init::zeros_(recent_mlp[2]->as<torch::nn::LinearImpl>()->bias);
  encoder = register_module("encoder", torch::nn::ModuleList());
  for (int64_t i = 0; i < kEncoderLayers; ++i) encoder->push_back(EncoderLayer(C, kAttentionHeads));
  token_norm = register_module("token_norm", layer_norm());
  vote_head =
      register_module("vote_head", Sequential(Linear(C, 256), ReLU(), Linear(256, kParts + J + 3 * J)));
  decoder = register_module("decoder", torch::nn::ModuleList());
  for (int64_t i = 0; i < kDecoderLayers; ++i) decoder->push_back(JointDecoderLayer());
  joint_norm = register_module("joint_norm", layer_norm());
  joint_head = register_module("joint_head", Sequential(Linear(C, 128), ReLU(), Linear(128, 3 + 6 + 1)));
  visibility_head = register_module("visibility_head", Linear(C, 1));
  // At first most joints are seen, whatever the scan: training begins near what is most often true.
  torch::nn::init::zeros_(visibility_head->weight);
  torch::nn::init::constant_(visibility_head->bias, 2);
  joint_embedding = register_parameter("joint_embedding", 0.5 * torch::randn({1, J, C}));
}

torch::Tensor SkeletonExtractorNetImpl::embed_patches(const torch::Tensor& offsets) {
  const auto B = offsets.size(0), M = offsets.size(1), K = offsets.size(2);
  // [BMK, 96]; a patch is about 0.2 wide
  const auto x = patch_mlp->forward((5.0 * offsets).view({B * M * K, 3}));
  const auto pooled = std::get<0>(x.view({B, M, K, -1}).max(2));  // [B, M, 96]; amax is slower backward
  return patch_out(pooled);                                       // [B, M, C]
}

ExtractorOutput SkeletonExtractorNetImpl::forward(const ExtractorInput& input) {
  const auto &centres = input.centres, &offsets = input.offsets;
  const auto B = centres.size(0), M = centres.size(1);
  const auto position = position_mlp->forward(centres);     // [B, M, C]
  const auto squared = squared_distance(centres, centres);  // [B, M, M]
  auto x = embed_patches(offsets) + position;               // [B, M, C]
  for (const auto& layer : *encoder) x = layer->as<EncoderLayer>()->forward(x, position, squared);
  x = token_norm(x);

  ExtractorOutput out;
  const auto output = vote_head->forward(x);  // [B, M, 23 + 22 + 66]
  out.parts = output.narrow(2, 0, kParts);
  const auto choice = torch::softmax(output.narrow(2, kParts, J), 1);  // [B, M, 22] over patches
  out.votes = centres.unsqueeze(2) + output.narrow(2, kParts + J, 3 * J).view({B, M, J, 3});
  out.voted = (choice.unsqueeze(3) * out.votes).sum(1);  // [B, 22, 3]
  decode(x + position, input, choice, out);
  return out;
}

torch::Tensor SkeletonExtractorNetImpl::embed_recent(const ExtractorInput& input,
                                                     const torch::Tensor& voted) {
  const auto known = input.recent_known.unsqueeze(1);                        // [B, 1, 2]
  const auto there = known.narrow(2, 0, 1), moving = known.narrow(2, 1, 1);  // [B, 1, 1]
  const auto displacement = (input.recent.narrow(2, 0, 3) - voted).clamp(-kFarthest, kFarthest);
  const auto moved = input.recent.narrow(2, 3, 3).clamp(-kFarthest, kFarthest);  // [B, 22, 3]
  const auto output = torch::cat({displacement * there, moved * moving, known.expand({-1, J, -1})}, 2);
  return there * recent_mlp->forward(output);  // [B, 22, C]
}

void SkeletonExtractorNetImpl::decode(const torch::Tensor& tokens, const ExtractorInput& input,
                                      const torch::Tensor& choice, ExtractorOutput& out) {
  const auto& centres = input.centres;
  // The votes are trained by their own loss: the decoder takes them as they are.
  const auto at = out.voted.detach();
  const auto among = squared_distance(at, at), across = squared_distance(at, centres);
  const auto position = position_mlp->forward(at);                           // [B, 22, C]
  auto x = joint_embedding + torch::matmul(choice.transpose(1, 2), tokens);  // [B, 22, C]
  if (input.recent.defined()) x = x + embed_recent(input, at);
  for (const auto& layer : *decoder)
    x = layer->as<JointDecoderLayer>()->forward(x, position, tokens, among, across);
  x = joint_norm(x);
  const auto output = joint_head->forward(x);  // [B, 22, 10]
  out.joints = out.voted + 0.1 * output.narrow(2, 0, 3);
  const auto upright = torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f}, centres.options());
  out.rotations = output.narrow(2, 3, 6) + upright;
  out.log_spread = output.select(2, 9) - 3.0;
  out.visibility = visibility_head->forward(x).squeeze(2);
}

}  // namespace understudy::nn
