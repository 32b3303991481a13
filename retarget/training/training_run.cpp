#include "retarget/training/training_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/math/types.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kLogSeconds = 30;
constexpr int kMostSkipped = 20;  // steps in a row

/// Whole numbers in full, others with six digits.
std::string number_text(double value) {
  const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
  return printed(whole ? "%.0f" : "%.6g", value);
}

std::vector<torch::Tensor> copies_of(const std::vector<torch::Tensor>& tensors) {
  std::vector<torch::Tensor> copies;
  for (const auto& tensor : tensors) copies.push_back(tensor.detach().clone());
  return copies;
}

void copy_into(const std::vector<torch::Tensor>& from, const std::vector<torch::Tensor>& to) {
  const torch::NoGradGuard no_grad;
  for (size_t i = 0; i < from.size(); ++i) torch::Tensor(to[i]).copy_(from[i]);
}

}  // namespace

TrainingRun::TrainingRun(const nn::TrainOptions& options, std::string network, const Schedule& schedule)
    : options_(options), network_(std::move(network)), schedule_(schedule), device_(options.device) {
  US_CHECK(options.minutes > 0 || options.samples > 0, "training needs an end: --minutes or --samples");
  US_CHECK(options.keep == 0 || !options.init.empty(), "--keep needs --init");
  US_CHECK(device_.is_cpu() || torch::cuda::is_available(), "this LibTorch finds no ", options.device,
           " device");
  at::set_num_threads(std::max(1, options.threads));  // the matrices are small: one thread by default
  torch::manual_seed(options.seed);
}

void TrainingRun::own(std::shared_ptr<torch::nn::Module> net, std::shared_ptr<torch::nn::Module> average,
                      std::unique_ptr<torch::optim::Optimizer> optimizer) {
  net_ = std::move(net);
  average_ = std::move(average);
  optimizer_ = std::move(optimizer);
  if (!options_.init.empty()) {
    const auto begun = nn::load_weights(options_.init, header().kind, header().version, *net_,
                                        [this](const std::string& tensor) { return may_lack(tensor); });
    for (const std::string& name : begun.lacking)
      log::info(options_.init + " has no '" + name + "': trained from new");
  }
  copy_into(net_->parameters(), average_->parameters());
  if (options_.keep > 0) first_ = copies_of(average_->parameters());
}

void TrainingRun::resume() {
  if (!fs::exists(checkpoint())) return;
  try {
    take_checkpoint();
  } catch (const c10::Error&) {
    throw Error(checkpoint() + ": not a checkpoint of this network's training, or of an earlier version");
  }
  log::info(detail::join("resumed ", checkpoint(), " at step ", progress_.step, ", ", progress_.samples,
                         " samples"));
}

void TrainingRun::take_checkpoint() {
  check_file(checkpoint());
  torch::serialize::InputArchive archive;
  archive.load_from(checkpoint());
  take(archive, "net", *net_);
  take(archive, "average", *average_);
  take(archive, "optimizer", *optimizer_);
  torch::Tensor numbers;
  archive.read("progress", numbers);
  TORCH_CHECK(numbers.numel() == 3 && numbers.scalar_type() == torch::kFloat64);
  const auto* n = numbers.data_ptr<double>();
  progress_ = {static_cast<int64_t>(n[0]), static_cast<int64_t>(n[1]), n[2]};
  take_own(archive);
}

double TrainingRun::done_share() const {
  const double by_time = options_.minutes > 0 ? progress_.seconds / (60 * options_.minutes) : 0;
  const double by_samples =
      options_.samples > 0 ? static_cast<double>(progress_.samples) / static_cast<double>(options_.samples)
                           : 0;
  return std::max(by_time, by_samples);
}

double TrainingRun::learning_rate() const {
  const double warm = std::min(1.0, static_cast<double>(progress_.step + 1) / std::max(1, schedule_.warm_up));
  const double fall = 0.5 * (1 + std::cos(kPi * std::min(1.0, done_share())));
  return schedule_.rate * warm * (schedule_.last_rate + (1 - schedule_.last_rate) * fall);
}

void TrainingRun::step() {
  optimizer_->zero_grad();
  const Step step = learn();
  for (auto& group : optimizer_->param_groups()) group.options().set_lr(learning_rate());
  const double norm = torch::nn::utils::clip_grad_norm_(net_->parameters(), schedule_.most_gradient);
  if (std::isfinite(norm) && all_finite(step.losses)) {
    optimizer_->step();
    update_average();
    losses_.add(step.losses);
    skipped_in_a_row_ = 0;
  } else {
    skip();
  }
  ++progress_.step;
  progress_.samples += step.samples;
}

void TrainingRun::skip() {
  ++skipped_;
  log::warn_once(network_ + ": steps without a finite loss or gradient are skipped; the curve counts them");
  US_CHECK(++skipped_in_a_row_ < kMostSkipped, "training of ", network_, ": ", kMostSkipped,
           " steps in a row had no finite loss or gradient");
}

void TrainingRun::update_average() {
  const torch::NoGradGuard no_grad;
  const auto steps = static_cast<double>(progress_.step);
  const double decay = std::min(schedule_.average_decay, (1 + steps) / (10 + steps));
  auto averaged = average_->parameters();
  const auto now = net_->parameters();
  for (size_t i = 0; i < averaged.size(); ++i) averaged[i].lerp_(now[i].to(averaged[i].device()), 1 - decay);
}

/// Of the steps since the last row.
Figures TrainingRun::figures() const {
  Figures row = {{"minutes", progress_.seconds / 60},
                 {"step", static_cast<double>(progress_.step)},
                 {"samples", static_cast<double>(progress_.samples)},
                 {"rate", learning_rate()},
                 {"skipped", static_cast<double>(skipped_)}};
  for (const Figure& figure : losses_.mean()) row.push_back(figure);
  return row;
}

void TrainingRun::log_figures(const Figures& row) const {
  std::string line = network_ + ":";
  for (const Figure& figure : row) line += " " + figure.name + " " + number_text(figure.value);
  log::info(line);
}

/// A curve that has other columns, of an earlier version, goes on with the new ones below it.
void TrainingRun::append_row(const Figures& row) {
  const std::string path = options_.curve.empty() ? options_.out + ".csv" : options_.curve;
  std::string columns, numbers, present;
  for (const Figure& figure : row) {
    columns += (columns.empty() ? "" : ",") + figure.name;
    numbers += (numbers.empty() ? "" : ",") + number_text(figure.value);
  }
  if (!curve_begun_) check_writable(path), std::getline(std::ifstream(path), present);
  std::ofstream out(path, std::ios::app);
  if (!curve_begun_ && present != columns) out << columns << "\n";
  out << numbers << "\n";
  US_CHECK(out.good(), path, ": cannot be written");
  curve_begun_ = true;
}

void TrainingRun::add_row() {
  if (losses_.empty()) return;  // nothing was learnt since the last row
  {
    const torch::NoGradGuard no_grad;
    dev_ = evaluate();
  }
  Figures row = figures();
  row.insert(row.end(), dev_.begin(), dev_.end());
  append_row(row);
  log_figures(row);
  losses_ = {};
  skipped_ = 0;
}

void TrainingRun::write_checkpoint() const {
  torch::serialize::OutputArchive archive;
  put(archive, "net", *net_);
  put(archive, "average", *average_);
  put(archive, "optimizer", *optimizer_);
  archive.write("progress", torch::tensor({static_cast<double>(progress_.step),
                                           static_cast<double>(progress_.samples), progress_.seconds},
                                          torch::kFloat64));
  put_own(archive);
  std::ostringstream bytes;
  archive.save_to(bytes);
  write_file(checkpoint(), bytes.str());
}

/// Between the weights that training on other data began and ended with lie some that are good on both
/// (Wortsman et al. 2022, Robust fine-tuning of zero-shot models).
void TrainingRun::write_weights() const {
  nn::WeightsHeader header = this->header();
  header.numbers["samples"] = static_cast<double>(progress_.samples);
  header.numbers["steps"] = static_cast<double>(progress_.step);
  header.numbers["seconds"] = progress_.seconds;
  for (const Figure& figure : dev_)
    if (std::isfinite(figure.value)) header.numbers[figure.name] = figure.value;  // JSON has no others
  const torch::NoGradGuard no_grad;
  auto parameters = average_->parameters();
  const auto average = copies_of(parameters);
  for (size_t i = 0; i < first_.size(); ++i)
    parameters[i].mul_(1 - options_.keep).add_(first_[i], options_.keep);
  nn::save_weights(options_.out, header, *average_);
  copy_into(average, parameters);
}

void TrainingRun::write() {
  write_checkpoint();
  add_row();
  write_weights();
}

int TrainingRun::run() {
  resume();
  const double before = progress_.seconds;
  double written = before, logged = before;
  const auto start = Clock::now();
  const auto cancelled = [this] { return options_.cancelled && options_.cancelled(); };
  while (done_share() < 1 && !cancelled()) {
    step();
    const double now = progress_.seconds =
        before + std::chrono::duration<double>(Clock::now() - start).count();
    const bool row_is_due = progress_.step == schedule_.first_row || now - written >= schedule_.row_seconds;
    if (row_is_due && skipped_in_a_row_ == 0) {
      write();
      written = logged = now;
    } else if (now - logged >= kLogSeconds) {
      log_figures(figures());
      logged = now;
    }
  }
  write();
  return done_share() < 1 ? 1 : 0;
}

}  // namespace understudy::training
