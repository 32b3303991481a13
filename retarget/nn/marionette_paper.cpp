#include <torch/torch.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/marionette/affinity_tree.hpp"
#include "retarget/metrics/voxel_metrics.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/affinity.hpp"
#include "retarget/nn/modules/voxel_keypoints.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

constexpr int kVoxelPoints = 20000;        // of each scan (paper 3, B.1)
constexpr uint64_t kVoxelSeed = 20260403;  // the same scan gives the same keypoints

/// Paper 3's own form (eq. 5 and 6; the tree by Algorithm 1), at whatever size it was trained.
class PaperKeypoints final : public KeypointFinder {
 public:
  PaperKeypoints(VoxelKeypointsNet net, std::string kind)
      : net_(std::move(net)), kind_(std::move(kind)), parents_(tree_of(net_)) {
    net_->eval();
  }

  std::vector<FoundKeypoints> find(const std::vector<Mesh>& scans) override {
    const torch::NoGradGuard no_grad;
    const auto drawn = drawn_points(scans);
    const auto grid = static_cast<int>(net_->form().grid);
    const VoxelGrid box(drawn, grid);  // about all frames, as the paper has it
    std::vector<std::vector<int>> cells;
    for (const Points& points : drawn)
      if (points.rows() > 0) cells.push_back(box.cells(points));
    const auto voxels = voxels_of(cells, grid);
    const auto over_time = net_->maps_over_time(voxels.unsqueeze(0));
    std::vector<FoundKeypoints> found;
    int64_t seen = 0;
    for (const Points& points : drawn) {
      if (points.rows() > 0)
        found.push_back(in_frame(voxels.narrow(0, seen++, 1), over_time, box));
      else if (!found.empty())
        found.push_back(found.back());
    }
    found.insert(found.begin(), scans.size() - found.size(), found.front());  // empty ones before the first
    return found;
  }
  const std::vector<int>& parents() const override { return parents_; }
  const std::string& kind() const override { return kind_; }
  std::string name() const override { return "paper"; }

 private:
  static std::vector<int> tree_of(VoxelKeypointsNet& net) {
    const torch::NoGradGuard no_grad;
    return tree_of_affinity(matrices_of(net->affinities()));
  }
  static std::vector<Points> drawn_points(const std::vector<Mesh>& scans) {
    std::vector<Points> drawn;
    for (const Mesh& scan : scans) {
      Rng rng(kVoxelSeed);
      const bool empty = scan.vertices.rows() == 0;
      drawn.push_back(empty ? Points(0, 3) : finite_points(sample_points(scan, kVoxelPoints, rng)));
    }
    US_CHECK(std::any_of(drawn.begin(), drawn.end(), [](const Points& points) { return points.rows() > 0; }),
             "no scan has points");
    return drawn;
  }
  FoundKeypoints in_frame(const torch::Tensor& voxels, const torch::Tensor& over_time, const VoxelGrid& box) {
    const VoxelKeypoints out = net_->of_frames(voxels, over_time);
    const auto places = out.places[0].contiguous(), intensity = out.intensity[0].contiguous();
    US_CHECK(torch::isfinite(places).all().item<bool>() && torch::isfinite(intensity).all().item<bool>(),
             "the keypoints found are not finite");
    const int64_t K = net_->form().keypoints;
    FoundKeypoints found;
    found.places = box.world(Eigen::Map<const Points>(places.data_ptr<float>(), K, 3));
    found.intensity.assign(intensity.data_ptr<float>(), intensity.data_ptr<float>() + K);
    return found;
  }

  VoxelKeypointsNet net_;
  std::string kind_;
  std::vector<int> parents_;
};

VoxelKeypointsForm form_in(const std::string& path, const WeightsHeader& header) {
  VoxelKeypointsForm form;
  form.keypoints = header_size(path, header, "keypoints", form.keypoints, 256);
  form.grid = header_size(path, header, "grid", form.grid, 128);
  form.width = header_size(path, header, "width", form.width, 256);
  return form;  // sigma is for training alone
}

}  // namespace

std::unique_ptr<KeypointFinder> load_paper_keypoints(const std::string& path) {
  const WeightsHeader header = read_weights_header(path);
  const std::string network = "marionette-paper";
  US_CHECK(header.kind == network, path, ": holds weights for '", header.kind, "', not for '", network, "'");
  const auto kind = header.texts.find("kind");
  US_CHECK(kind != header.texts.end(), path, ": does not say of which kind of body it is");
  VoxelKeypointsNet net(form_in(path, header));
  load_weights(path, network, kVoxelKeypointsVersion, *net);
  return std::make_unique<PaperKeypoints>(std::move(net), kind->second);
}

}  // namespace understudy::nn
