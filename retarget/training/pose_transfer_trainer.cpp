#include "retarget/training/pose_transfer_trainer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/checkpoint_archive.hpp"

namespace understudy::training {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kLearningRate = 3e-4, kEdgeWeight = 0.1, kReportMinutes = 3;
constexpr int kBatch = 8, kDevBatches = 8;
constexpr int64_t kNeighbours = 4;

torch::Tensor to_tensor(const Points& points) {
  return torch::from_blob(const_cast<float*>(points.data()), {points.rows(), 3}, torch::kFloat32).clone();
}

/// Around their mean and over their mean distance from it; that distance.
std::pair<torch::Tensor, double> normalised(const torch::Tensor& points) {
  const auto centred = points - points.mean(0, true);
  const double size = centred.norm(2, -1).mean().item<double>();
  return {centred / size, size};
}

/// How much the distances between neighbours on the target differ from the truth's.
torch::Tensor edge_loss(const torch::Tensor& made, const PoseTransferBatch& batch) {
  const auto near = std::get<1>(torch::cdist(batch.rest, batch.rest).topk(kNeighbours + 1, -1, false))
                        .slice(2, 1);  // [B, N, k]
  const auto lengths = [&near](const torch::Tensor& x) {
    const auto N = x.size(1);
    const auto index = near.reshape({x.size(0), -1, 1}).expand({-1, -1, 3});
    const auto ends = x.gather(1, index).view({x.size(0), N, kNeighbours, 3});
    return ((ends - x.unsqueeze(2)).square().sum(-1) + 1e-8).sqrt();
  };
  return (lengths(made) - lengths(batch.posed)).abs().mean();
}

double progress_of(const PoseTransferTrainer& trainer, const nn::TrainOptions& options) {
  const double by_samples =
      options.samples > 0 ? static_cast<double>(trainer.samples) / static_cast<double>(options.samples) : 0;
  return std::max(by_samples, options.minutes > 0 ? trainer.minutes / options.minutes : 0);
}

void keep(PoseTransferTrainer& trainer, const PoseTransferBatch& dev, double loss,
          const nn::TrainOptions& options) {
  const double error_mm = 1000 * trainer.judge(dev);
  const std::string curve = options.curve.empty() ? options.out + ".csv" : options.curve;
  const bool fresh = !std::filesystem::exists(curve);
  std::ofstream out(curve, std::ios::app);
  if (fresh) out << "minutes,samples,loss,dev_mm\n";
  out << trainer.minutes << ',' << trainer.samples << ',' << loss << ',' << error_mm << '\n';
  US_CHECK(out.good(), curve, ": cannot be written");
  log::info(
      detail::join("pose transfer: ", trainer.samples, " samples, loss ", loss, ", dev ", error_mm, " mm"));
  nn::save_weights(options.out,
                   {"pose-transfer",
                    nn::kPoseTransferVersion,
                    {{"samples", static_cast<double>(trainer.samples)}, {"dev_mm", error_mm}}},
                   *trainer.net);
  trainer.save_checkpoint(options.out + ".checkpoint");
}

}  // namespace

PoseTransferBatch make_pose_transfer_batch(ScanMaker& maker, int count) {
  std::vector<torch::Tensor> source, rest, posed;
  std::vector<float> sizes;
  for (int i = 0; i < count; ++i) {
    const PosedPair pair = maker.pair();
    source.push_back(normalised(to_tensor(pair.source)).first);
    const auto [places, size] = normalised(to_tensor(pair.rest));
    rest.push_back(places);
    const auto there = to_tensor(pair.posed);
    posed.push_back((there - there.mean(0, true)) / size);  // the target keeps its size
    sizes.push_back(static_cast<float>(size));
  }
  return {torch::stack(source), torch::stack(rest), torch::stack(posed), torch::tensor(sizes)};
}

PoseTransferTrainer::PoseTransferTrainer(uint64_t seed) {
  torch::manual_seed(seed);
  net = nn::PoseTransferNet();
  optimizer_ =
      std::make_unique<torch::optim::Adam>(net->parameters(), torch::optim::AdamOptions(kLearningRate));
}

double PoseTransferTrainer::step(const PoseTransferBatch& batch, double progress) {
  const double fall = 0.5 * (1 + std::cos(M_PI * std::clamp(progress, 0.0, 1.0)));
  for (auto& group : optimizer_->param_groups())
    static_cast<torch::optim::AdamOptions&>(group.options()).lr(kLearningRate * (0.01 + 0.99 * fall));
  const auto made = net->forward(batch.source, batch.rest);
  const auto points = (made - batch.posed).square().sum(-1).mean();
  const auto loss = points + kEdgeWeight * edge_loss(made, batch);
  US_CHECK(std::isfinite(loss.item<double>()), "training of pose transfer: the loss is not finite");
  optimizer_->zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(net->parameters(), 1.0);
  optimizer_->step();
  samples += batch.source.size(0);
  return points.item<double>();
}

double PoseTransferTrainer::judge(const PoseTransferBatch& batch) {
  const torch::NoGradGuard no_grad;
  double sum = 0;
  for (int64_t i = 0; i < batch.source.size(0); ++i) {  // one by one: small in memory
    const auto made = net->forward(batch.source.slice(0, i, i + 1), batch.rest.slice(0, i, i + 1));
    sum += (batch.size[i] * (made[0] - batch.posed[i]).norm(2, -1).mean()).item<double>();
  }
  return sum / static_cast<double>(batch.source.size(0));
}

void PoseTransferTrainer::save_checkpoint(const std::string& path) {
  torch::serialize::OutputArchive archive;
  put(archive, "net", *net);
  put(archive, "optimizer", *optimizer_);
  archive.write("samples", torch::full({1}, samples, torch::kInt64));
  archive.write("minutes", number(minutes));
  save_archive(archive, path);
}

void PoseTransferTrainer::load_checkpoint(const std::string& path) {
  read_archive(path, torch::kCPU, [&](torch::serialize::InputArchive& archive) {
    take(archive, "net", *net);
    take(archive, "optimizer", *optimizer_);
    samples = number_from(archive, "samples").item<int64_t>();
    minutes = number_from(archive, "minutes").item<double>();
  });
}

int train_pose_transfer(const nn::TrainOptions& options) {
  US_CHECK(!options.out.empty(), "train pose-transfer wants a file for the weights");
  at::set_num_threads(std::max(1, options.threads));
  const TrainingData train = load_training_data(options.data, Split::Train),
                     dev = load_training_data(options.data, Split::Dev);
  PoseTransferTrainer trainer(options.seed);
  if (const std::string checkpoint = options.out + ".checkpoint"; std::filesystem::exists(checkpoint))
    trainer.load_checkpoint(checkpoint);
  ScanMaker dev_maker(dev, {}, 77);
  // A resumed run makes new pairs, not the first ones again.
  ScanMaker maker(train, {}, options.seed * 1000003 + static_cast<uint64_t>(trainer.samples) * 101);
  const int size = options.batch > 0 ? options.batch : kBatch;
  const PoseTransferBatch judged = make_pose_transfer_batch(dev_maker, kDevBatches * size);
  const double before = trainer.minutes;
  const auto start = Clock::now();
  double kept = before, loss = 0;
  bool cancelled = false;
  while (progress_of(trainer, options) < 1 && !cancelled) {
    loss = trainer.step(make_pose_transfer_batch(maker, size), progress_of(trainer, options));
    trainer.minutes = before + std::chrono::duration<double>(Clock::now() - start).count() / 60;
    if (trainer.minutes - kept > kReportMinutes) {
      keep(trainer, judged, loss, options);
      kept = trainer.minutes;
    }
    cancelled = options.cancelled && options.cancelled();
  }
  keep(trainer, judged, loss, options);
  return cancelled ? 1 : 0;
}

}  // namespace understudy::training
