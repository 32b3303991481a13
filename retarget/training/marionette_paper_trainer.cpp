#include "retarget/base/error.hpp"
#include "retarget/metrics/rig_metrics.hpp"
#include "retarget/nn/modules/voxel_keypoints.hpp"
#include "retarget/pipeline/keypoint_finder.hpp"
#include "retarget/training/losses/affinity_losses.hpp"
#include "retarget/training/losses/keypoint_losses.hpp"
#include "retarget/training/training_run.hpp"
#include "retarget/training/voxel_data.hpp"

namespace understudy::training {
namespace {

// Table 3 has three windows a step, of which there are hundreds of thousands. Of two thousand steps each is
// worth more than its gradient's quality.
constexpr int kVoxelBatch = 1;
constexpr int kMostApart = 6;  // frames between two of a window: from a third of a second to two seconds
// L_sparse grows to its weight between these shares of the training: from the start, all keypoints but a few
// are faint before they have left the middle of the box.
constexpr double kSparseBegins = 0.1, kSparseGrown = 0.5;
constexpr int kVoxelFigureWindows = 12, kDecodedWindows = 3;
constexpr uint64_t kVoxelFigureSeed = 78;

/// What the paper's data sets have of their own (supplement, tables 4 to 8).
struct KindForm {
  const char* kind;
  int64_t keypoints;
  double sigma, vol, traj, local;
};
constexpr std::array<KindForm, 4> kKindForms = {{{"person", 24, 1.5, 10, 1, 0.001},        // AIST++
                                                 {"quadruped", 24, 2.0, 10, 1e-6, 0.001},  // Animals
                                                 {"hand", 28, 1.0, 0.1, 1e-6, 1},          // HanCo
                                                 {"arm", 12, 1.5, 10, 0.001, 1}}};         // Panda

const KindForm& form_of(const std::string& kind) {
  for (const KindForm& form : kKindForms)
    if (kind == form.kind) return form;
  throw Error("there is no kind \"" + kind + "\"");
}

nn::VoxelKeypointsForm network_form(const nn::MarionettePaperTrainOptions& options) {
  const KindForm& of_kind = form_of(options.kind);
  return {of_kind.keypoints, options.grid, options.width, of_kind.sigma};
}

/// The authors' code learns at 4e-4 over 200 epochs, falling in two steps; here there are minutes: ten times
/// as fast, and falling evenly.
Schedule marionette_paper_schedule() {
  Schedule schedule;
  schedule.rate = 4e-3;
  schedule.warm_up = 20;
  schedule.average_decay = 0.98;
  schedule.first_row = 20;
  schedule.row_seconds = 240;
  return schedule;
}

class MarionettePaperTrainer final : public TrainingRun {
 public:
  explicit MarionettePaperTrainer(const nn::MarionettePaperTrainOptions& options)
      : TrainingRun(options, options.kNetwork, marionette_paper_schedule()),
        options_(options),
        weights_(form_of(options.kind)),
        rng_(options.seed),
        data_(options.kind, options.data, Split::Train, options.grid),
        dev_(options.kind, options.data, Split::Dev, options.grid),
        net_(network_form(options)),
        average_(network_form(options)) {
    net_->to(device());
    average_->to(device());
    average_->eval();
    own(net_.ptr(), average_.ptr(),
        std::make_unique<torch::optim::Adam>(net_->parameters(), torch::optim::AdamOptions(1e-3)));
  }

 private:
  Step learn() override {
    const int count = options_.batch > 0 ? options_.batch : kVoxelBatch;
    const VoxelBatch batch = data_.batch(count, kMostApart, rng_);
    const auto voxels = batch.voxels.to(device());
    const nn::VoxelKeypoints found = net_->forward(voxels);
    LossSum loss = loss_of_keypoints(batch, found, net_->decoded(found, voxels));
    const auto in_time = [count](const torch::Tensor& x) { return x.unflatten(0, {count, kVoxelWindow}); };
    add_affinity(in_time(found.places), in_time(found.intensity), loss);
    loss.total.backward();
    return {count, loss.parts};
  }

  // Eq. 23, with table 3's weights where kinds are alike.

  LossSum loss_of_keypoints(const VoxelBatch& batch, const nn::VoxelKeypoints& found,
                            const torch::Tensor& logits) const {
    LossSum loss;
    loss.add("recon", reconstruction_loss(logits, batch.voxels.flatten(0, 1).to(device())), 100);
    const auto vol = volume_fitting_loss(batch.cells.to(device()), batch.counts.to(device()), found.places);
    loss.add("vol", vol, options_.losses.volume ? weights_.vol : 0);
    loss.add("sparse", sparsity_loss(found.heatmaps),
             5 * phased_in(done_share(), kSparseBegins, kSparseGrown));
    loss.add("sep", separation_loss(found.places.unflatten(0, {-1, kVoxelWindow})), 0.1);
    return loss;
  }

  void add_affinity(const torch::Tensor& places, const torch::Tensor& intensity, LossSum& loss) const {
    const auto affinities = net_->affinities();
    const auto affinity = joined_affinity(affinities);
    loss.add("traj", trajectory_loss(places, affinity, intensity),
             options_.losses.trajectory ? weights_.traj : 0);
    loss.add("local", local_loss(places, affinity, intensity), options_.losses.local ? weights_.local : 0);
    loss.add("time", time_loss(places, affinity, intensity), options_.losses.time ? 1 : 0);
    loss.add("complex", complexity_loss(affinities), 0.01);
  }

  /// sc of eq. 21 over bodies that are not trained on; the distance of decoded grids from the true ones, each
  /// of which is in cells of this grid: coarser ones are further apart.
  Figures evaluate() override {
    SemanticConsistency sc;
    double cd = 0, bright = 0;
    Rng rng(kVoxelFigureSeed);
    for (int w = 0; w < kVoxelFigureWindows; ++w) {
      const VoxelBatch batch = dev_.batch(1, kMostApart, rng);
      const auto voxels = batch.voxels.to(device());
      const nn::VoxelKeypoints found = average_->forward(voxels);
      const auto hidden = found.intensity < kLeastIntensity;
      const auto places = found.places.masked_fill(hidden.unsqueeze(2), kNowhere).cpu().contiguous();
      for (int t = 0; t < kVoxelWindow; ++t)
        sc.push(Eigen::Map<const Points>(places[t].data_ptr<float>(), places.size(1), 3),
                batch.joints[static_cast<size_t>(t)]);
      bright += (~hidden).to(torch::kFloat32).sum(1).mean().item<double>() / kVoxelFigureWindows;
      if (w < kDecodedWindows) cd += distance(batch, average_->decoded(found, voxels)) / kDecodedWindows;
    }
    return {{"sc", sc.value()}, {"sc_keypoints", bright}, {"cd_1e4", 1e4 * cd}};
  }

  double distance(const VoxelBatch& batch, const torch::Tensor& logits) const {
    double sum = 0;
    for (int64_t t = 0; t < kVoxelWindow; ++t) {
      const auto full = (logits[t].flatten() > 0).nonzero().flatten().to(torch::kInt32).cpu().contiguous();
      const int* cells = full.data_ptr<int>();
      sum += voxel_distance({cells, cells + full.numel()}, batch.occupied[static_cast<size_t>(t)],
                            options_.grid);
    }
    return sum / kVoxelWindow;
  }

  nn::WeightsHeader header() const override {
    const nn::VoxelKeypointsForm& form = net_->form();
    return {options_.kNetwork,
            nn::kVoxelKeypointsVersion,
            {{"keypoints", static_cast<double>(form.keypoints)},
             {"grid", static_cast<double>(form.grid)},
             {"width", static_cast<double>(form.width)}},
            {{"kind", options_.kind}}};
  }
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  static constexpr float kNowhere = 1e4f;  // where faint keypoints are nearest to nothing

  nn::MarionettePaperTrainOptions options_;
  KindForm weights_;
  Rng rng_;
  VoxelData data_, dev_;
  nn::VoxelKeypointsNet net_, average_;
};

}  // namespace

int train(const nn::MarionettePaperTrainOptions& options) {
  return MarionettePaperTrainer(options).run();
}

}  // namespace understudy::training
