#include "retarget/nn/modules/deformation.hpp"

#include <cmath>
#include <future>
#include <thread>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {
namespace {

using torch::Tensor;

constexpr double kAdultBones = 4.42;    // metres: the length of all 21 bones of an adult together
constexpr int64_t kPositionWaves = 5;   // wavelengths 2 m .. 12 cm
constexpr int64_t kCanonicalWaves = 6;  // wavelengths 2 m .. 6 cm
constexpr double kBasisUnit = 0.02;     // a typical entry of an offset basis, metres
constexpr int64_t kBones = kJointCount - 1;

Tensor index_tensor(const std::vector<int64_t>& values) {
  return torch::tensor(values, torch::kLong);
}

Tensor parent_index() {
  return index_tensor({kParents.begin() + 1, kParents.end()});
}
Tensor mirror_index() {
  return index_tensor({kMirror.begin(), kMirror.end()});
}

/// sin and cos of pi 2^k x for k = 0 .. count-1, [.., 2 count D].
Tensor waves(const Tensor& x, int64_t count) {
  std::vector<Tensor> parts;
  for (int64_t k = 0; k < count; ++k) {
    const Tensor angle = x * (M_PI * std::pow(2.0, static_cast<double>(k)));
    parts.push_back(angle.sin());
    parts.push_back(angle.cos());
  }
  return torch::cat(parts, -1);
}

/// Where each entry of a mirrored offset basis comes from, and its sign.
std::pair<Tensor, Tensor> mirrored_basis_table() {
  std::vector<int64_t> from(3 * kPoseFeatureCount);
  std::vector<float> sign(3 * kPoseFeatureCount);
  const auto s = [](int axis) { return axis == 0 ? -1.f : 1.f; };
  for (int c = 0; c < 3; ++c)
    for (int j = 1; j < kJointCount; ++j)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const auto at = c * kPoseFeatureCount + 9 * (j - 1) + 3 * a + b;
          from[at] = c * kPoseFeatureCount + 9 * (kMirror[j] - 1) + 3 * a + b;
          sign[at] = s(c) * s(a) * s(b);
        }
  return {index_tensor(from), torch::tensor(sign)};
}

}  // namespace

Tensor body_scale(const Tensor& joints) {
  const Tensor bones = joints.slice(1, 1) - joints.index_select(1, parent_index().to(joints.device()));
  return (bones.norm(2, -1).sum(1) / kAdultBones).clamp_min(1e-4).view({-1, 1, 1});
}

Tensor point_features(const Tensor& points, const Tensor& joints) {
  const Tensor scale = body_scale(joints);
  const Tensor parents = parent_index().to(joints.device());
  const Tensor j = joints / scale, p = points / scale;
  const Tensor d = p.unsqueeze(2) - j.unsqueeze(1);                // [B, N, 22, 3]
  const Tensor bone = j.slice(1, 1) - j.index_select(1, parents);  // [B, 21, 3]
  const Tensor length2 = bone.square().sum(-1).clamp_min(1e-6);    // [B, 21]
  const Tensor from = d.index_select(2, parents);                  // [B, N, 21, 3]
  // [B, N, 21]
  const Tensor along = ((from * bone.unsqueeze(1)).sum(-1) / length2.unsqueeze(1)).clamp(-1, 2);
  const Tensor away = (from - along.clamp(0, 1).unsqueeze(-1) * bone.unsqueeze(1)).norm(2, -1);
  const Tensor place = p - j.slice(1, 0, 1);
  return torch::cat(
      {2 * d.flatten(2), 2 * d.norm(2, -1), along, 2 * away, waves(place, kPositionWaves), waves(along, 2)},
      -1);
}

Tensor mirror_points(const Tensor& points, const Tensor& middle) {
  const Tensor x = 2 * middle.unsqueeze(-1) - points.select(-1, 0);
  return torch::cat({x.unsqueeze(-1), points.slice(-1, 1)}, -1);
}

Tensor mirror_joints(const Tensor& joints, const Tensor& middle) {
  return mirror_points(joints.index_select(1, mirror_index().to(joints.device())), middle);
}

Tensor middle_plane(const Tensor& joints) {
  return joints.select(-1, 0).mean(1);
}

Tensor mirror_weights(const Tensor& weights) {
  return weights.index_select(-1, mirror_index().to(weights.device()));
}

Tensor mirror_basis(const Tensor& basis) {
  static const auto table = mirrored_basis_table();
  return basis.index_select(-1, table.first.to(basis.device())) * table.second.to(basis.device());
}

FilmBlockImpl::FilmBlockImpl(int64_t width, int64_t code)
    : norm(register_module("norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({width})))),
      fc1(register_module("fc1", torch::nn::Linear(width, width))),
      fc2(register_module("fc2", torch::nn::Linear(width, width))),
      film(register_module("film", torch::nn::Linear(code, 2 * width))) {
  torch::NoGradGuard no_grad;
  film->weight.mul_(0.3);
  film->bias.zero_();
  fc2->weight.mul_(0.5);  // near the identity at first
}

Tensor FilmBlockImpl::forward(const Tensor& h, const Tensor& code) {
  const auto film_parts = film(code).unsqueeze(1).chunk(2, -1);  // [B, 1, width] twice
  const Tensor hidden = fc1(norm(h)) * (1 + film_parts[0]) + film_parts[1];
  return h + fc2(torch::silu(hidden));
}

DeformationNetImpl::DeformationNetImpl(const DeformationOptions& net_options) : options(net_options) {
  const auto linear = [this](const char* name, int64_t from, int64_t to) {
    return register_module(name, torch::nn::Linear(from, to));
  };
  const int64_t w = options.width;
  context1 = linear("context1", kPointFeatureCount, 128);
  context2 = linear("context2", 128, 128);
  context3 = linear("context3", 256, options.context);
  code1 = linear("code1", 3 * kJointCount + 1 + options.context, 256);
  code2 = linear("code2", 256, options.code);
  entry = linear("entry", kPointFeatureCount, w);
  to_canonical = linear("to_canonical", w, 3);
  from_canonical = linear("from_canonical", 3 + 6 * kCanonicalWaves, w);
  trunk = register_module("trunk", torch::nn::ModuleList());
  for (int64_t i = 0; i < options.trunk_blocks; ++i) trunk->push_back(FilmBlock(w, options.code));
  weight_block = register_module("weight_block", FilmBlock(w, options.code));
  offset_block = register_module("offset_block", FilmBlock(w, options.code));
  weight_norm = register_module("weight_norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({w})));
  offset_norm = register_module("offset_norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({w})));
  to_weights = linear("to_weights", w, kJointCount);
  to_basis = linear("to_basis", w, 3 * kPoseFeatureCount);
  to_gate = linear("to_gate", w, kBones);
}

Tensor DeformationNetImpl::body_code(const Tensor& joints, const Tensor& surface) {
  const Tensor scale = body_scale(joints);
  Tensor seen = torch::silu(context1(point_features(surface, joints)));
  seen = torch::silu(context2(seen));                                             // [B, M, 128]
  const Tensor summary = context3(torch::cat({seen.amax(1), seen.mean(1)}, -1));  // [B, context]
  const Tensor body = ((joints - joints.slice(1, 0, 1)) / scale).flatten(1) * 2;  // [B, 66]
  // Size enters only within people's range: a giant is a scaled person (bind_surface scales his offsets).
  const Tensor size = scale.view({-1, 1}).clamp(0.5, 1.4).log() * 3;
  return torch::silu(code2(torch::silu(code1(torch::cat({body, size, summary}, -1)))));
}

SurfaceFunctions DeformationNetImpl::forward(const Tensor& points, const Tensor& joints, const Tensor& code) {
  Tensor h = entry(point_features(points, joints));
  h = trunk[0]->as<FilmBlockImpl>()->forward(h, code);
  SurfaceFunctions out;
  out.canonical = to_canonical(h);
  h = h + from_canonical(torch::cat({out.canonical, waves(out.canonical, kCanonicalWaves)}, -1));
  for (size_t i = 1; i < trunk->size(); ++i) h = trunk[i]->as<FilmBlockImpl>()->forward(h, code);

  out.log_weights = torch::log_softmax(to_weights(weight_norm(weight_block(h, code))), -1);
  const Tensor o = offset_norm(offset_block(h, code));
  const Tensor gate = torch::sigmoid(to_gate(o)).unsqueeze(2).unsqueeze(-1);  // [B, N, 1, 21, 1]
  // offsets are local: most are 0
  const Tensor basis = to_basis(o).view({o.size(0), o.size(1), 3, kBones, 9}) * gate;
  out.basis = basis.flatten(2) * kBasisUnit;
  return out;
}

Tensor pose_offsets(const Tensor& basis, const Tensor& features) {
  const int64_t batch = basis.size(0), count = basis.size(1);
  const Tensor flat = basis.reshape({batch, count * 3, kPoseFeatureCount});
  return torch::bmm(flat, features.transpose(1, 2)).view({batch, count, 3, features.size(1)});
}

Tensor blend_skin(const Tensor& weights, const Tensor& rest, const Tensor& transforms) {
  const int64_t batch = weights.size(0), count = weights.size(1), poses = transforms.size(1);
  const Tensor by_joint = transforms.permute({0, 2, 1, 3}).reshape({batch, kJointCount, poses * 12});
  const Tensor blended = torch::bmm(weights, by_joint).view({batch, count, poses, 12});
  const Tensor R = blended.slice(-1, 0, 9).view({batch, count, poses, 3, 3});
  return (R * rest.transpose(2, 3).unsqueeze(3)).sum(-1) + blended.slice(-1, 9);
}

namespace {

constexpr int64_t kChunk = 2048;  // points at a time: bounds the memory of a target of any size

/// Gives take(rows, weights, basis) what holds for the points of those rows, all seen from the side whose
/// joints these are. The basis of all points at once would be copied through the memory again and again.
template <class Take>
void one_side(DeformationNet& net, const Tensor& points, const Tensor& rows, const Tensor& joints,
              const Tensor& surface, Take take) {
  if (rows.size(0) == 0) return;
  const Tensor code = net->body_code(joints, surface);
  // Beyond people's range of sizes the body is seen as one of the nearest size: offsets grow with it.
  const double scale = body_scale(joints).item<double>();
  const double beyond = scale / std::min(1.4, std::max(0.5, scale));
  // Nothing else runs while a target is bound: chunks go to two cores. Each writes rows of its own.
  const auto every_other = [&](int64_t first, int64_t step) {
    const torch::NoGradGuard no_grad;  // of this thread
    for (int64_t from = first * kChunk; from < rows.size(0); from += step * kChunk) {
      const Tensor chunk = rows.slice(0, from, std::min(from + kChunk, rows.size(0)));
      const SurfaceFunctions out = net->forward(points.index_select(0, chunk).unsqueeze(0), joints, code);
      take(chunk, out.log_weights.squeeze(0).exp(), out.basis.squeeze(0) * beyond);
    }
  };
  if (rows.size(0) <= 2 * kChunk || std::thread::hardware_concurrency() < 2) return every_other(0, 1);
  auto other = std::async(std::launch::async, every_other, 1, 2);
  every_other(0, 2);
  other.get();
}

}  // namespace

BoundSurface bind_surface(DeformationNet& net, const Tensor& points, const Tensor& joints,
                          const Tensor& surface) {
  const torch::NoGradGuard no_grad;
  const Tensor j = joints.unsqueeze(0);
  const Tensor middle = middle_plane(j);
  const double band = kMirrorBand * body_scale(j).item<double>();
  const Tensor x = points.select(-1, 0) - middle;  // [V]
  const Tensor t = ((x + band) / (2 * band)).clamp(0, 1);
  const Tensor own = t * t * (3 - 2 * t);  // 1 on the left, 0 on the right

  BoundSurface out{torch::zeros({points.size(0), kJointCount}, points.options()),
                   torch::zeros({points.size(0), 3 * kPoseFeatureCount}, points.options())};
  const Tensor left = (own > 0).nonzero().flatten(), right = (own < 1).nonzero().flatten();
  one_side(net, points, left, j, surface.unsqueeze(0),
           [&](const Tensor& rows, const Tensor& weights, const Tensor& basis) {
             const Tensor share = own.index_select(0, rows).unsqueeze(-1);
             out.weights.index_add_(0, rows, weights * share);
             out.basis.index_add_(0, rows, basis * share);
           });
  one_side(net, mirror_points(points.unsqueeze(0), middle).squeeze(0), right, mirror_joints(j, middle),
           mirror_points(surface.unsqueeze(0), middle),
           [&](const Tensor& rows, const Tensor& weights, const Tensor& basis) {
             const Tensor share = 1 - own.index_select(0, rows).unsqueeze(-1);
             out.weights.index_add_(0, rows, mirror_weights(weights) * share);
             out.basis.index_add_(0, rows, mirror_basis(basis) * share);
           });
  return out;
}

}  // namespace understudy::nn
