#include "retarget/nn/modules/slot_net.hpp"

#include <algorithm>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/nn/modules/skeleton_extractor.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t kSlotWidth = 96, kSlotHeads = 4, kSlotLayers = 3;
constexpr int64_t kHeadingWidth = 64, kHeadingLayers = 2;
constexpr double kAxis = 0.1;        // normalised: nearer the middle there is no way away from it
constexpr double kLinkPace = 0.005;  // of the running mean, a step
constexpr double kApartCosts = 0.2;  // of keypoints that carry each other alike, near ones hang together
constexpr double kSlotReach = 0.12;  // normalised: points are shared by slots about as near

/// Numbers of the `count` nearest of `among` to a place, nearest first.
std::vector<int> nearest_rows(const Points& among, const Eigen::RowVector3f& to, int count) {
  const Eigen::VectorXf squared = (among.rowwise() - to).rowwise().squaredNorm();
  std::vector<int> order(static_cast<size_t>(among.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::partial_sort(order.begin(), order.begin() + count, order.end(),
                    [&](int a, int b) { return std::pair(squared[a], a) < std::pair(squared[b], b); });
  order.resize(static_cast<size_t>(count));
  return order;
}

/// x and z of [..., 3].
torch::Tensor flattened(const torch::Tensor& points) {
  return torch::stack({points.select(-1, 0), points.select(-1, 2)}, -1);
}

/// Both of directions [..., 2] -> [..., 2].
torch::Tensor dot_and_cross(const torch::Tensor& a, const torch::Tensor& b) {
  const auto ax = a.select(-1, 0), az = a.select(-1, 1), bx = b.select(-1, 0), bz = b.select(-1, 1);
  return torch::stack({ax * bx + az * bz, ax * bz - az * bx}, -1);
}

/// Rotations about the vertical that take +z to these headings, [B, 2] -> [B, 3, 3].
torch::Tensor frames_of(const torch::Tensor& heading) {
  const auto x = heading.select(1, 0), z = heading.select(1, 1), none = torch::zeros_like(x);
  return torch::stack({z, none, x, none, none + 1, none, -x, none, z}, 1).view({-1, 3, 3});
}

}  // namespace

SlotInput empty_slot_input(int64_t scans) {
  return {torch::empty({scans, kSlotPoints, 3}), torch::empty({scans, kSlotPatches, 3}),
          torch::empty({scans, kSlotPatches, kSlotPatchPoints, 3})};
}

void put_slot_points(const Points& points, int64_t row, SlotInput& input) {
  US_CHECK(points.rows() == kSlotPoints, "a scan of ", points.rows(), " points, not ", kSlotPoints);
  const auto of_row = [row](torch::Tensor& tensor) { return tensor.select(0, row).data_ptr<float>(); };
  Eigen::Map<Points>(of_row(input.points), kSlotPoints, 3) = points;
  Eigen::Index first;  // the order of the points must not matter
  const Eigen::RowVector3f middle = points.colwise().mean();
  (points.rowwise() - middle).rowwise().squaredNorm().minCoeff(&first);
  const std::vector<int> chosen = farthest_points(points, kSlotPatches, static_cast<int>(first));
  Eigen::Map<Points> centres(of_row(input.centres), kSlotPatches, 3);
  Eigen::Map<Points> offsets(of_row(input.offsets), kSlotPatches * kSlotPatchPoints, 3);
  for (int m = 0; m < kSlotPatches; ++m) {
    centres.row(m) = points.row(chosen[static_cast<size_t>(m)]);
    const std::vector<int> near = nearest_rows(points, centres.row(m), kSlotPatchPoints);
    for (int p = 0; p < kSlotPatchPoints; ++p)
      offsets.row(m * kSlotPatchPoints + p) = points.row(near[static_cast<size_t>(p)]) - centres.row(m);
  }
}

SlotEncoderImpl::SlotEncoderImpl(int64_t layers, int64_t width) {
  using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;
  patch_mlp = register_module("patch_mlp", Sequential(Linear(3, 48), ReLU(), Linear(48, 64), ReLU()));
  patch_out = register_module("patch_out", Linear(64, width));
  position_mlp = register_module("position_mlp", Sequential(Linear(3, width), ReLU(), Linear(width, width)));
  layers_ = register_module("layers", torch::nn::ModuleList());
  for (int64_t i = 0; i < layers; ++i) layers_->push_back(EncoderLayer(width, kSlotHeads));
  norm = register_module("norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({width})));
}

torch::Tensor SlotEncoderImpl::forward(const torch::Tensor& centres, const torch::Tensor& offsets) {
  const auto B = offsets.size(0), M = offsets.size(1), P = offsets.size(2);
  const auto position = position_mlp->forward(centres);     // [B, M, C]
  const auto squared = squared_distance(centres, centres);  // [B, M, M]
  const auto patch = patch_mlp->forward((3.0 * offsets).reshape({B * M * P, 3}));
  auto x = patch_out(std::get<0>(patch.view({B, M, P, -1}).max(2))) + position;  // [B, M, C]
  for (const auto& layer : *layers_) x = layer->as<EncoderLayer>()->forward(x, position, squared);
  return norm(x);
}

HeadingNetImpl::HeadingNetImpl() {
  using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;
  const int64_t W = kHeadingWidth;
  patch_mlp = register_module("patch_mlp", Sequential(Linear(4, 48), ReLU(), Linear(48, 64), ReLU()));
  patch_out = register_module("patch_out", Linear(64, W));
  place_mlp = register_module("place_mlp", Sequential(Linear(8, W), ReLU(), Linear(W, W)));
  layers_ = register_module("layers", torch::nn::ModuleList());
  for (int64_t i = 0; i < kHeadingLayers; ++i) layers_->push_back(EncoderLayer(W, kSlotHeads));
  norm = register_module("norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({W})));
  weigh = register_module("weigh", Linear(W, 6));
}

torch::Tensor HeadingNetImpl::forward(const torch::Tensor& centres, const torch::Tensor& offsets) {
  const auto B = offsets.size(0), M = offsets.size(1), P = offsets.size(2);
  // Three directions of each patch: away from the middle, and to the middles of what is near and further.
  const auto flat = flattened(centres);  // [B, M, 2]
  const auto out = flat / (flat.norm(2, 2, true) + kAxis);
  const auto squared = squared_distance(centres, centres);  // [B, M, M]
  const auto towards = [&](double reach) {
    const auto near = torch::softmax(-squared / (2 * reach * reach), 2);
    return (flattened(torch::matmul(near, centres)) - flat) / reach;
  };
  const auto near = towards(0.2), far = towards(0.5);
  const auto ways = torch::stack({out, near, far}, 2);  // [B, M, 3, 2]
  const auto place = torch::cat({centres.select(2, 1).unsqueeze(2), flat.norm(2, 2, true),
                                 dot_and_cross(out, near), dot_and_cross(out, far), dot_and_cross(near, far)},
                                2);              // [B, M, 8]
  const auto around = 3.0 * flattened(offsets);  // [B, M, P, 2]
  const auto seen = torch::cat({dot_and_cross(out.unsqueeze(2).expand_as(around), around),
                                3.0 * offsets.select(3, 1).unsqueeze(3), around.norm(2, 3, true)},
                               3);  // [B, M, P, 4]
  const auto position = place_mlp->forward(place);
  const auto patch = patch_mlp->forward(seen.reshape({B * M * P, 4}));
  auto x = patch_out(std::get<0>(patch.view({B, M, P, -1}).max(2))) + position;  // [B, M, C]
  for (const auto& layer : *layers_) x = layer->as<EncoderLayer>()->forward(x, position, squared);
  const auto weight = weigh(norm(x)).view({B, M, 3, 2});  // along each way, and across it
  const auto across = torch::stack({ways.select(3, 1), -ways.select(3, 0)}, 3);
  const auto sum = (weight.narrow(3, 0, 1) * ways + weight.narrow(3, 1, 1) * across).sum(2).mean(1);
  return torch::nn::functional::normalize(sum);
}

SlotNetImpl::SlotNetImpl(int64_t slots) : slots_(slots) {
  using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;
  const int64_t W = kSlotWidth;
  heading = register_module("heading", HeadingNet());
  encoder = register_module("encoder", SlotEncoder(kSlotLayers, W));
  choice_head = register_module("choice_head", Linear(W, slots));
  slot_head = register_module("slot_head", Sequential(Linear(W, 128), ReLU(), Linear(128, 3 + 6)));
  slot_embedding = register_parameter("slot_embedding", 0.5 * torch::randn({1, slots, W}));
  missed_ = register_buffer("missed", torch::zeros({slots, slots}));
  apart_ = register_buffer("apart", torch::zeros({slots, slots}));
  seen_ = register_buffer("seen", torch::zeros({1}));
}

void SlotNetImpl::learn_links(const torch::Tensor& missed, const torch::Tensor& apart) {
  missed_.lerp_(missed.detach(), kLinkPace);
  apart_.lerp_(apart.detach(), kLinkPace);
  seen_.lerp_(torch::ones_like(seen_), kLinkPace);
}

torch::Tensor SlotNetImpl::link_costs() const {
  return (missed_ + kApartCosts * apart_) / seen_.clamp_min(1e-6);
}

SlotOutput SlotNetImpl::forward(const SlotInput& input) {
  SlotOutput out;
  out.heading = heading->forward(input.centres, input.offsets);  // [B, 2]
  const auto frame = frames_of(out.heading);                     // [B, 3, 3]
  const auto centres = torch::matmul(input.centres, frame), points = torch::matmul(input.points, frame);
  const auto offsets = torch::matmul(input.offsets, frame.unsqueeze(1));

  const auto x = encoder->forward(centres, offsets);
  const auto choice = torch::softmax(choice_head(x), 1).transpose(1, 2);            // [B, K, M]
  const auto head = slot_head->forward(torch::matmul(choice, x) + slot_embedding);  // [B, K, 9]
  const auto places = torch::matmul(choice, centres) + 0.3 * head.narrow(2, 0, 3);
  const auto usual = torch::tensor({1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}, head.options());
  const auto turns = rotations_from_6d(head.narrow(2, 3, 6) + usual);
  out.places = torch::matmul(places, frame.transpose(1, 2));
  out.turns = torch::matmul(frame.unsqueeze(1), turns);

  out.shares = torch::softmax(-squared_distance(points, places) / (2 * kSlotReach * kSlotReach), 2);
  return out;
}

}  // namespace understudy::nn
