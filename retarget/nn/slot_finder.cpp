#include <torch/torch.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/marionette/link_tree.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/slot_net.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

constexpr uint64_t kSlotSeed = 20260321;  // the same scan gives the same keypoints

/// Exactly kSlotPoints of a scan that are finite, with repeats where it has fewer; none of an empty one.
Points slot_points(const Mesh& scan) {
  if (scan.vertices.rows() == 0) return Points(0, 3);
  Rng rng(kSlotSeed);
  const Points drawn = finite_points(sample_points(scan, kSlotPoints, rng));
  if (drawn.rows() == 0) return drawn;
  Points points(kSlotPoints, 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = drawn.row(i % drawn.rows());
  return points;
}

class SlotFinder final : public KeypointFinder {
 public:
  SlotFinder(SlotNet net, std::string kind) : net_(std::move(net)), kind_(std::move(kind)) {
    net_->eval();
    torch::NoGradGuard guard;
    const auto costs = net_->link_costs().contiguous();
    parents_ =
        tree_of_links(Eigen::Map<const RowMatrix>(costs.data_ptr<float>(), net_->slots(), net_->slots()));
  }

  std::vector<FoundKeypoints> find(const std::vector<Mesh>& scans) override {
    std::vector<Points> drawn;
    double sum = 0;
    int seen = 0;
    for (const Mesh& scan : scans) {
      drawn.push_back(slot_points(scan));
      if (drawn.back().rows() == 0) continue;
      const Eigen::RowVector3f middle = drawn.back().colwise().mean();
      sum += (drawn.back().rowwise() - middle).rowwise().squaredNorm().mean();
      ++seen;
    }
    US_CHECK(seen > 0, "no scan has points");
    const auto scale = static_cast<float>(std::sqrt(sum / seen));
    US_CHECK(scale > 0, "all points of the scans coincide");
    std::vector<FoundKeypoints> found;
    for (size_t t = 0; t < scans.size(); ++t)
      if (drawn[t].rows() > 0)
        found.push_back(found_in(drawn[t], scale, scans[t].vertices));
      else if (!found.empty())
        found.push_back(found.back()), found.back().owner.clear();
    while (found.size() < scans.size())
      found.insert(found.begin(), found.front()), found.front().owner.clear();
    return found;
  }
  const std::vector<int>& parents() const override { return parents_; }
  const std::string& kind() const override { return kind_; }
  std::string name() const override { return "slots"; }

 private:
  FoundKeypoints found_in(const Points& drawn, float scale, const Points& all) {
    torch::NoGradGuard guard;
    const Eigen::RowVector3f middle = drawn.colwise().mean();
    SlotInput input = empty_slot_input(1);
    put_slot_points((drawn.rowwise() - middle) / scale, 0, input);
    const SlotOutput out = net_->forward(input);
    const auto places = out.places.contiguous(), turns = out.turns.contiguous();
    US_CHECK(torch::isfinite(places).all().item<bool>() && torch::isfinite(turns).all().item<bool>(),
             "the keypoints found are not finite");
    const int64_t K = net_->slots();
    FoundKeypoints found;
    found.places = (scale * Eigen::Map<const Points>(places.data_ptr<float>(), K, 3)).rowwise() + middle;
    found.intensity.assign(static_cast<size_t>(K), 1);
    for (int64_t k = 0; k < K; ++k)
      found.turns.emplace_back(
          Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(turns.data_ptr<float>() + 9 * k));
    const auto owner = out.shares[0].argmax(1).contiguous();
    for (Eigen::Index i = 0; i < all.rows(); ++i) {
      Eigen::Index nearest;
      (drawn.rowwise() - all.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
      found.owner.push_back(static_cast<int>(owner.data_ptr<int64_t>()[nearest]));
    }
    return found;
  }

  SlotNet net_;
  std::string kind_;
  std::vector<int> parents_;
};

}  // namespace

std::unique_ptr<KeypointFinder> load_slots(const std::string& path) {
  const WeightsHeader header = read_weights_header(path);
  SlotNet net(header_size(path, header, "slots", 24, 256));
  load_weights(path, "marionette-slots", kSlotVersion, *net);
  const auto kind = header.texts.find("kind");
  US_CHECK(kind != header.texts.end(), path, ": does not say of which kind it is");
  return std::make_unique<SlotFinder>(std::move(net), kind->second);
}

}  // namespace understudy::nn
