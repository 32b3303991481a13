#include "retarget/nn/modules/voxel_keypoints.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/affinity.hpp"

namespace understudy::nn {
namespace {

constexpr double kLeak = 0.2;
constexpr double kSharp = 10;  // of the decoder's answer
// Maps of each branch are leaky, as the authors' are, so that the floor of all K maps is one number. Without
// that a keypoint that is sparse fades by powers, until one or two are left that are not faint.
constexpr double kMapLeak = 0.01;
constexpr double kMapFloor = -5;      // before softplus; from 0, means of maps leave the box's middle slowly
constexpr double kAffinityPace = 10;  // affinities are learnt so much faster than weights

torch::nn::Conv3d voxel_convolution(int64_t from, int64_t to, int64_t size, int64_t stride = 1) {
  return torch::nn::Conv3d(torch::nn::Conv3dOptions(from, to, size).stride(stride).padding(size / 2));
}

/// Groups of 16 channels; one, where there are fewer or they do not divide.
torch::nn::GroupNorm voxel_norm(int64_t channels) {
  const int64_t groups = std::max<int64_t>(1, channels / 16);
  return torch::nn::GroupNorm(channels % groups == 0 ? groups : 1, channels);
}

torch::Tensor leaky(const torch::Tensor& x) {
  return torch::leaky_relu(x, kLeak);
}

/// Coordinates of the cells' centres, -1 to 1: channels x, y, z, [1, 3, G, G, G].
torch::Tensor cell_centres(int64_t grid) {
  const auto line = torch::linspace(-1, 1, grid);
  const auto zyx = torch::meshgrid({line, line, line}, "ij");
  return torch::stack({zyx[2], zyx[1], zyx[0]}).unsqueeze(0);
}

torch::Tensor twice_as_fine(const torch::Tensor& x) {
  namespace F = torch::nn::functional;
  return F::interpolate(
      x, F::InterpolateFuncOptions().scale_factor(std::vector<double>{2, 2, 2}).mode(torch::kNearest));
}

std::string numbered(const char* name, size_t i) {
  return name + std::to_string(i);
}

}  // namespace

VoxelResidualImpl::VoxelResidualImpl(int64_t from, int64_t to)
    : first(register_module("first", voxel_convolution(from, to, 3))),
      second(register_module("second", voxel_convolution(to, to, 3))),
      first_norm(register_module("first_norm", voxel_norm(to))),
      second_norm(register_module("second_norm", voxel_norm(to))) {
  if (from != to) straight = register_module("straight", voxel_convolution(from, to, 1));
}

torch::Tensor VoxelResidualImpl::forward(const torch::Tensor& x) {
  const auto y = second_norm(second(leaky(first_norm(first(x)))));
  return leaky(y + (straight.is_empty() ? x : straight(x)));
}

VoxelHourglassImpl::VoxelHourglassImpl(const std::vector<int64_t>& channels) {
  for (size_t i = 0; i + 1 < channels.size(); ++i) {
    const int64_t here = channels[i], deeper = channels[i + 1];
    beside.push_back(register_module(numbered("beside", i), VoxelResidual(here, here)));
    narrow.push_back(register_module(numbered("narrow", i), voxel_convolution(here, deeper, 3, 2)));
    norms.push_back(register_module(numbered("norm", i), voxel_norm(deeper)));
    within.push_back(register_module(numbered("within", i), VoxelResidual(deeper, deeper)));
    wide.push_back(register_module(numbered("wide", i), voxel_convolution(deeper, here, 1)));
  }
}

torch::Tensor VoxelHourglassImpl::forward(const torch::Tensor& x) {
  std::vector<torch::Tensor> skips;
  auto deep = x;
  for (size_t i = 0; i < narrow.size(); ++i) {
    skips.push_back(beside[i](deep));
    deep = within[i](leaky(norms[i](narrow[i](deep))));  // half as fine
  }
  for (size_t i = narrow.size(); i-- > 0;) deep = twice_as_fine(wide[i](deep)) + skips[i];
  return deep;
}

VoxelFeaturesImpl::VoxelFeaturesImpl(int64_t grid, int64_t width) : cells(cell_centres(grid)) {
  see = register_module("see", voxel_convolution(1, width / 4, 5));
  see_where = register_module("see_where", voxel_convolution(3, width / 4, 5));
  see_norm = register_module("see_norm", voxel_norm(width / 4));
  halve = register_module("halve", voxel_convolution(width / 4, width / 4, 3, 2));
  halve_norm = register_module("halve_norm", voxel_norm(width / 4));
  wider = register_module("wider", VoxelResidual(width / 4, width / 2));
  halve_again = register_module("halve_again", voxel_convolution(width / 2, width / 2, 3, 2));
  halve_again_norm = register_module("halve_again_norm", voxel_norm(width / 2));
  hourglass = register_module(
      "hourglass", VoxelHourglass(std::vector<int64_t>{width / 2, width / 4, 3 * width / 8, 9 * width / 16}));
  last = register_module("last", VoxelResidual(width / 2, width));
}

torch::Tensor VoxelFeaturesImpl::forward(const torch::Tensor& voxels) {
  // One convolution of voxels and coordinates; the latter are the same in all frames, so done once.
  const auto seen = see(voxels) + see_where(cells.to(voxels.device()));    // [F, C/4, G, G, G]
  const auto half = leaky(halve_norm(halve(leaky(see_norm(seen)))));       // [F, C/4, G/2, ..]
  const auto quarter = leaky(halve_again_norm(halve_again(wider(half))));  // [F, C/2, G/4, ..]
  return last(hourglass(quarter));                                         // [F, C, G/4, ..]
}

VoxelDecoderImpl::VoxelDecoderImpl(const VoxelKeypointsForm& form) : cells(cell_centres(form.grid / 4)) {
  const int64_t width = form.width;
  join = register_module("join", voxel_convolution(2 * form.keypoints + width + 3, width, 1));
  join_norm = register_module("join_norm", voxel_norm(width));
  half = register_module("half", voxel_convolution(width, width / 2, 3));
  half_norm = register_module("half_norm", voxel_norm(width / 2));
  half_again = register_module("half_again", voxel_convolution(width / 2, width / 2, 3));
  half_again_norm = register_module("half_again_norm", voxel_norm(width / 2));
  full = register_module("full", voxel_convolution(width / 2, width / 4, 3));
  full_norm = register_module("full_norm", voxel_norm(width / 4));
  full_again = register_module("full_again", voxel_convolution(width / 4, width / 4, 3));
  full_again_norm = register_module("full_again_norm", voxel_norm(width / 4));
  out = register_module("out", voxel_convolution(width / 4, 1, 1));
}

torch::Tensor VoxelDecoderImpl::forward(const torch::Tensor& now, const torch::Tensor& first,
                                        const torch::Tensor& features, const torch::Tensor& voxels) {
  const auto where = cells.to(now.device()).expand({now.size(0), -1, -1, -1, -1});
  auto x = leaky(join_norm(join(torch::cat({now, first, features, where}, 1))));  // [F, C, G/4, ..]
  x = leaky(half_norm(half(twice_as_fine(x))));                                   // [F, C/2, G/2, ..]
  x = leaky(half_again_norm(half_again(x)));
  x = leaky(full_norm(full(twice_as_fine(x))));  // [F, C/4, G, ..]
  x = leaky(full_again_norm(full_again(x)));
  return kSharp * (torch::tanh(out(x)) + voxels - 0.5);
}

VoxelKeypointsNetImpl::VoxelKeypointsNetImpl(const VoxelKeypointsForm& form) : form_(form) {
  US_CHECK(form.grid >= 32 && form.grid % 32 == 0, "a grid of keypoints has 32, 64, .. cells, not ",
           form.grid);
  US_CHECK(form.width >= 16 && form.width % 16 == 0, "features have 16, 32, .. channels, not ", form.width);
  US_CHECK(form.keypoints > kAffinityMatrices, "a tree needs more than ", kAffinityMatrices, " keypoints");
  const int64_t K = form.keypoints;
  features = register_module("features", VoxelFeatures(form.grid, form.width));
  features_over_time = register_module("features_over_time", VoxelFeatures(form.grid, 2 * form.width));
  maps = register_module("maps", voxel_convolution(form.width, K, 1));
  maps_of_time = register_module("maps_of_time", voxel_convolution(2 * form.width, K, 1));
  mix = register_module("mix", voxel_convolution(2, 1, 1));
  decoder = register_module("decoder", VoxelDecoder(form));
  free_affinity =
      register_parameter("free_affinity", 0.1 / kAffinityPace * torch::randn({kAffinityMatrices, K, K - 1}));
  line = torch::linspace(-1, 1, form.grid / 4);
  const torch::NoGradGuard no_grad;
  mix->weight.fill_(1);  // both branches, alike, where it begins
  mix->bias.fill_(kMapFloor);
}

torch::Tensor VoxelKeypointsNetImpl::maps_over_time(const torch::Tensor& voxels) {
  return maps_of_time(features_over_time(voxels.mean(1)));
}

VoxelKeypoints VoxelKeypointsNetImpl::of_frames(const torch::Tensor& voxels, const torch::Tensor& over_time) {
  VoxelKeypoints found;
  found.features = features(voxels);
  const auto both = torch::leaky_relu(torch::stack({maps(found.features), over_time}, 2), kMapLeak);
  const auto mixed = mix(both.flatten(0, 1));                  // [F K, 2, g, g, g] -> [F K, 1, g, g, g]
  found.heatmaps = torch::softplus(mixed).view_as(over_time);  // [F, K, g, g, g]
  const auto& m = found.heatmaps;
  const auto sum = m.sum({2, 3, 4}) + 1e-8;  // [F, K]
  const auto at = line.to(m.device());
  const auto mean_along = [&](int64_t a, int64_t b) { return (m.sum({a, b}) * at).sum(2) / sum; };
  found.places = torch::stack({mean_along(2, 3), mean_along(2, 4), mean_along(3, 4)}, 2);  // x, y, z
  const auto mean = m.mean({2, 3, 4});
  found.intensity = mean / (std::get<0>(mean.max(1, true)) + 1e-8);
  return found;
}

VoxelKeypoints VoxelKeypointsNetImpl::forward(const torch::Tensor& voxels) {
  const int64_t T = voxels.size(1);
  return of_frames(voxels.flatten(0, 1), maps_over_time(voxels).repeat_interleave(T, 0));
}

torch::Tensor VoxelKeypointsNetImpl::gaussians(const VoxelKeypoints& keypoints) const {
  const auto at = line.to(keypoints.places.device());
  const double sigma = form_.sigma * 2 / 16;
  const auto along = [&](int64_t axis) {  // [F, K, g]
    return (-(at - keypoints.places.select(2, axis).unsqueeze(2)).square() / (2 * sigma * sigma)).exp();
  };
  const auto alpha = keypoints.intensity.unsqueeze(2).unsqueeze(3).unsqueeze(4);
  return alpha * along(2).unsqueeze(3).unsqueeze(4) * along(1).unsqueeze(2).unsqueeze(4) *
         along(0).unsqueeze(2).unsqueeze(3);  // [F, K, z, y, x]
}

torch::Tensor VoxelKeypointsNetImpl::decoded(const VoxelKeypoints& keypoints, const torch::Tensor& voxels) {
  const int64_t W = voxels.size(0), T = voxels.size(1);
  const auto firsts = [&](const torch::Tensor& of_frames) {  // each frame its window's first
    return of_frames.unflatten(0, {W, T}).select(1, 0).repeat_interleave(T, 0);
  };
  const auto g = gaussians(keypoints);
  return decoder(g, firsts(g), firsts(keypoints.features), firsts(voxels.flatten(0, 1)));
}

torch::Tensor VoxelKeypointsNetImpl::affinities() const {
  return affinities_of(kAffinityPace * free_affinity);
}

torch::Tensor voxels_of(const std::vector<std::vector<int>>& cells, int64_t grid) {
  const auto T = static_cast<int64_t>(cells.size());
  auto voxels = torch::zeros({T, 1, grid, grid, grid});
  float* at = voxels.data_ptr<float>();
  for (const std::vector<int>& frame : cells) {
    for (const int cell : frame) at[cell] = 1;
    at += grid * grid * grid;
  }
  return voxels;
}

}  // namespace understudy::nn
