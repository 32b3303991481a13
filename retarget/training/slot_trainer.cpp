#include "retarget/metrics/rig_metrics.hpp"
#include "retarget/training/losses/affinity_losses.hpp"
#include "retarget/training/losses/keypoint_losses.hpp"
#include "retarget/training/losses/slot_losses.hpp"
#include "retarget/training/slot_data.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kSlotBatch = 8, kSlotFigureClips = 40, kSlotFigureFrames = 8;
constexpr int kWarpedPoints = 256;
constexpr double kSlowestWalk = 0.5;  // of the body's size, a second: slower, it may go anywhere
constexpr double kTreeBegins = 0.1;   // share of the training: keypoints find their places first
constexpr uint64_t kSlotFigureSeed = 77;

Schedule slot_schedule() {
  Schedule schedule;
  schedule.rate = 1.5e-3;
  schedule.warm_up = 200;
  schedule.average_decay = 0.995;
  schedule.row_seconds = 60;
  return schedule;
}

int64_t slots_of(const std::string& kind) {
  return kind == "hand" ? 28 : kind == "arm" ? 12 : 24;  // paper 3, tables 4 to 8
}

/// Rows of what the network says.
nn::SlotOutput rows_of(const nn::SlotOutput& all, const torch::Tensor& rows) {
  return {all.heading.index_select(0, rows), all.places.index_select(0, rows),
          all.turns.index_select(0, rows), all.shares.narrow(1, 0, kWarpedPoints).index_select(0, rows)};
}

class SlotTrainer final : public TrainingRun {
 public:
  explicit SlotTrainer(const nn::MarionetteSlotsTrainOptions& options)
      : TrainingRun(options, options.kNetwork, slot_schedule()),
        options_(options),
        rng_(options.seed),
        data_(options.kind, options.data, Split::Train),
        dev_(options.kind, options.data, Split::Dev),
        net_(slots_of(options.kind)),
        average_(slots_of(options.kind)) {
    net_->to(device());
    average_->to(device());
    average_->eval();
    own(net_.ptr(), average_.ptr(),
        std::make_unique<torch::optim::AdamW>(net_->parameters(),
                                              torch::optim::AdamWOptions(1e-3).weight_decay(1e-4)));
  }

 private:
  Step learn() override {
    const int count = options_.batch > 0 ? options_.batch : kSlotBatch;
    const int apart = 1 + static_cast<int>(done_share() * 11);
    const SlotBatch batch = data_.batch(count, apart, rng_);
    const nn::SlotOutput all = net_->forward(batch.input);
    const LossSum loss = loss_of(batch, all, count);
    loss.total.backward();
    return {count, loss.parts};
  }

  LossSum loss_of(const SlotBatch& batch, const nn::SlotOutput& all, int count) {
    const auto index = torch::arange(count * kSlotWindow, torch::kInt64).view({count, kSlotWindow});
    const auto& points = batch.input.points;
    std::vector<torch::Tensor> from, to;
    for (const int step : {1, 2}) {
      from.push_back(index.flatten());
      to.push_back(index.roll(step, 1).flatten());
    }
    const auto f = torch::cat(from), t = torch::cat(to);
    const auto few = points.narrow(1, 0, kWarpedPoints);  // they are in no order
    const nn::SlotOutput before = rows_of(all, f), after = rows_of(all, t);
    const auto moved = carried(few.index_select(0, f), before, after);
    const auto there = few.index_select(0, t);
    LossSum loss;
    loss.add("warp", nearest_distance(moved, there) + nearest_distance(there, moved));
    loss.add("vol", volume_fitting_loss(points, torch::ones({points.size(0), points.size(1)}), all.places),
             options_.losses.volume ? 1 : 0);
    loss.add("inside", nearest_distance(all.places, points), 0.1);
    const auto first = index.select(1, 0), turned = torch::arange(count, torch::kInt64) + count * kSlotWindow;
    const auto wanted = torch::matmul(all.places.index_select(0, first), batch.turned.transpose(1, 2));
    loss.add("turned", ((wanted - all.places.index_select(0, turned)).square().sum(-1) + 1e-4).sqrt().mean());
    const auto wanted_turns = torch::matmul(
        torch::matmul(batch.turned.unsqueeze(1), all.turns.index_select(0, first)), batch.side.unsqueeze(1));
    loss.add("turns", (wanted_turns - all.turns.index_select(0, turned)).square().mean(), 0.5);
    add_heading(batch, all.heading, count, loss);
    const auto frames = all.places.narrow(0, 0, count * kSlotWindow).unflatten(0, {count, kSlotWindow});
    add_keypoints(frames, loss);
    const auto missed = missed_by(before, after);
    const auto apart = nn::squared_distance(before.places, before.places).clamp_min(0).sqrt();
    average_->learn_links(missed.mean(0), apart.mean(0));
    const auto affinity = affinity_of_links(average_->link_costs());
    const double hangs = done_share() > kTreeBegins ? 1 : 0;
    loss.add("joint", joint_loss(affinity, missed), 0.15 * hangs);
    add_tree(affinity, frames, hangs, loss);
    return loss;
  }

  /// Keypoints do not gather in one place, move apart from each other, and do not exchange their places.
  static void add_keypoints(const torch::Tensor& frames, LossSum& loss) {
    loss.add("sep", separation_loss(frames), 0.1);
    loss.add("crowd", crowding_loss(frames.flatten(0, 1)), 0.02);
    loss.add("slow", place_steps(frames), 0.1);
  }

  /// Paper 3's of what hangs together, with affinities that follow from how keypoints carry each other.
  void add_tree(const torch::Tensor& affinity, const torch::Tensor& places, double weight,
                LossSum& loss) const {
    const nn::MarionetteLosses& there = options_.losses;
    const auto intensity = torch::ones({places.size(0), places.size(1), places.size(2)});
    loss.add("traj", trajectory_loss(places, affinity, intensity), there.trajectory ? weight : 0);
    loss.add("local", local_loss(places, affinity, intensity), there.local ? 0.1 * weight : 0);
    loss.add("time", time_loss(places, affinity, intensity), there.time ? weight : 0);
  }

  /// Where a body faces turns with it, hardly changes from frame to frame, and is mostly where it goes.
  void add_heading(const SlotBatch& batch, const torch::Tensor& heading, int count, LossSum& loss) const {
    const auto windows = heading.narrow(0, 0, count * kSlotWindow).view({count, kSlotWindow, 2});
    const auto flat = torch::tensor({0, 2}, torch::kInt64);
    const auto turn = batch.turned.index_select(1, flat).index_select(2, flat);  // [W, 2, 2]
    const auto wanted = torch::matmul(turn, windows.select(1, 0).unsqueeze(2)).squeeze(2);
    loss.add("faces", (1 - (wanted * heading.narrow(0, count * kSlotWindow, count)).sum(1)).mean());
    loss.add("steady", (1 - (windows * windows.roll(1, 1)).sum(2)).mean(), 0.1);
    const auto moved = batch.moved.index_select(2, flat);
    const auto speed = moved.norm(2, 2);
    const auto counts = (speed - kSlowestWalk).clamp(0, 1);
    const auto way = moved / (speed + 1e-3).unsqueeze(2);
    loss.add("goes", (counts * (1 - (windows * way).sum(2))).sum() / (counts.sum() + 1), 0.3);
  }

  Figures evaluate() override {
    torch::NoGradGuard guard;
    SemanticConsistency sc;
    double alone = 0;
    Rng rng(kSlotFigureSeed);
    for (int c = 0; c < kSlotFigureClips; ++c) {
      const RiggedMotion body = dev_.bodies().draw(kSlotFigureFrames, 7.5, rng);
      const SkinnedPoints drawn = points_on(body.rig, 1500, rng);
      SemanticConsistency own;
      for (const RigPose& pose : body.motion.poses) {
        const BoneMotions bones = bone_motions(body.rig, pose);
        Points points = some_rows(skinned(drawn.rest, drawn.skin, bones), nn::kSlotPoints, rng);
        const Eigen::RowVector3f middle = points.colwise().mean();
        const float scale = std::sqrt((points.rowwise() - middle).rowwise().squaredNorm().mean());
        points = ((points.rowwise() - middle) / scale).eval();
        nn::SlotInput input = nn::empty_slot_input(1);
        nn::put_slot_points(points, 0, input);
        const auto places = average_->forward(input).places.contiguous();
        const Points found = Eigen::Map<const Points>(places.data_ptr<float>(), places.size(1), 3);
        const Points joints = (joint_places(body.rig, bones).rowwise() - middle) / scale;
        sc.push(found, joints);
        own.push(found, joints);
      }
      alone += own.value() / kSlotFigureClips;
    }
    return {{"sc", sc.value()}, {"sc_alone", alone}};
  }
  nn::WeightsHeader header() const override {
    return {"marionette-slots",
            nn::kSlotVersion,
            {{"slots", static_cast<double>(net_->slots())}},
            {{"kind", options_.kind}}};
  }
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  nn::MarionetteSlotsTrainOptions options_;
  Rng rng_;
  SlotData data_, dev_;
  nn::SlotNet net_, average_;
};

}  // namespace

int train(const nn::MarionetteSlotsTrainOptions& options) {
  return SlotTrainer(options).run();
}

}  // namespace understudy::training
