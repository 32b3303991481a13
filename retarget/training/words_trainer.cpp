#include <algorithm>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/modules/words_pair.hpp"
#include "retarget/style/fit_manner.hpp"
#include "retarget/training/losses/motion_losses.hpp"
#include "retarget/training/losses/word_losses.hpp"
#include "retarget/training/training_run.hpp"
#include "retarget/training/words_data.hpp"

namespace understudy::training {
namespace {

constexpr int kWordBatch = 32, kShownWords = 128;  // words of a step; of a row of the curve

/// Paper, section 3.5: Adam at 2e-4. The rate falls along a cosine, as all trainings' here, in place of 1 %
/// an epoch from epoch 100 on.
Schedule words_schedule() {
  Schedule schedule;
  schedule.rate = 2e-4;
  schedule.most_gradient = 10;
  schedule.average_decay = 0.995;
  return schedule;
}

nn::WordsForm form_of(const nn::StyleTrainOptions& options, const WordPairs& pairs) {
  nn::WordsForm form;
  form.joints.fill(true);
  if (options.joints != "all") {  // what a depth camera sees badly stays the source's
    form.joints.fill(false);
    for (const int j : fitted_joints(options.joints)) form.joints[static_cast<size_t>(j)] = true;
  }
  form.net.joints = std::count(form.joints.begin(), form.joints.end(), true);
  form.net.joint_wise = options.convolution == "joint";
  form.from = pairs.from_range();
  form.to = pairs.to_range();
  return form;
}

WordPairs read_pairs(const nn::StyleTrainOptions& options) {
  namespace fs = std::filesystem;
  US_CHECK(!options.from.empty() && !options.to.empty(),
           "--from and --to are required: the folders in DATA of the two manners of moving");
  const fs::path from = fs::path(options.data) / options.from, to = fs::path(options.data) / options.to;
  std::error_code failed;
  US_CHECK(!fs::equivalent(from, to, failed), to.string(), ": is the other domain again");
  return {read_words(from.string(), options.smooth), read_words(to.string(), options.smooth)};
}

class WordsTrainer final : public TrainingRun {
 public:
  explicit WordsTrainer(const nn::StyleTrainOptions& options);

 private:
  struct Made {
    torch::Tensor there, back;
  };
  LossSum generators(const WordBatch& batch, Made& made);
  Figures discriminators(const WordBatch& batch, const Made& made);
  torch::Tensor known(const torch::Tensor& rows) const { return nn::known_joints(rows, form_.joints); }

  Step learn() override;
  Figures evaluate() override;
  nn::WeightsHeader header() const override;
  void put_own(torch::serialize::OutputArchive& archive) const override;
  void take_own(torch::serialize::InputArchive& archive) override;

  nn::StyleTrainOptions options_;
  int count_ = kWordBatch;
  Rng rng_;
  WordPairs pairs_;
  nn::WordsForm form_;
  nn::WordsPair net_, average_;
  nn::WordDiscriminator tells_to_, tells_from_;
  std::unique_ptr<torch::optim::Adam> telling_;
};

torch::optim::AdamOptions adam() {
  return torch::optim::AdamOptions(2e-4).betas({0.5, 0.999});
}

WordsTrainer::WordsTrainer(const nn::StyleTrainOptions& options)
    : TrainingRun(options, options.kNetwork, words_schedule()),
      options_(options),
      rng_(options.seed),
      pairs_(read_pairs(options)),
      form_(form_of(options, pairs_)),
      net_(form_.net),
      average_(form_.net),
      tells_to_(form_.net.joints),
      tells_from_(form_.net.joints) {
  US_CHECK(device().is_cpu(), "words are learned on the CPU");
  if (options.batch > 0) count_ = options.batch;
  own(net_.ptr(), average_.ptr(), std::make_unique<torch::optim::Adam>(net_->parameters(), adam()));
  std::vector<torch::Tensor> parameters = tells_to_->parameters();
  for (const torch::Tensor& parameter : tells_from_->parameters()) parameters.push_back(parameter);
  telling_ = std::make_unique<torch::optim::Adam>(parameters, adam());
  log::info(detail::join("style: ", pairs_.words(), " words"));
}

LossSum WordsTrainer::generators(const WordBatch& batch, Made& made) {
  const auto from = known(batch.from), to = known(batch.to);
  made = {net_->there(from), net_->back(to)};
  LossSum loss;
  loss.add("fooling", adversarial_loss(tells_to_(made.there)) + adversarial_loss(tells_from_(made.back)));
  loss.add("cycle",
           word_cycle_loss(net_->back(made.there), from) + word_cycle_loss(net_->there(made.back), to),
           options_.cycle);
  if (options_.coherence > 0)
    loss.add("coherence",
             options_.velocities ? word_velocity_loss(made.there, from) + word_velocity_loss(made.back, to)
                                 : word_coherence_loss(made.there) + word_coherence_loss(made.back),
             options_.coherence);
  if (options_.transition > 0)
    loss.add("transition", word_transition_loss(made.there, net_->there(known(batch.next))),
             options_.transition);
  return loss;
}

Figures WordsTrainer::discriminators(const WordBatch& batch, const Made& made) {
  const auto real_to = tells_to_(known(batch.to)), made_to = tells_to_(made.there.detach()),
             real_from = tells_from_(known(batch.from)), made_from = tells_from_(made.back.detach());
  telling_->zero_grad();
  (discriminator_loss(real_to, made_to) + discriminator_loss(real_from, made_from)).backward();
  for (auto& group : telling_->param_groups()) group.options().set_lr(learning_rate());
  telling_->step();
  return {{"discriminator_accuracy", discriminator_accuracy(real_to, made_to)}};
}

TrainingRun::Step WordsTrainer::learn() {
  const WordBatch batch = pairs_.batch(count_, options_.transition > 0, rng_);
  Made made;
  LossSum loss = generators(batch, made);
  loss.total.backward();
  if (all_finite(loss.parts))
    for (const Figure& figure : discriminators(batch, made)) loss.parts.push_back(figure);
  return {count_, loss.parts};
}

/// Of words that are always the same: how far they come back from, and how far they are taken.
Figures WordsTrainer::evaluate() {
  const torch::NoGradGuard no_grad;
  Rng rng(1);
  const WordBatch batch = pairs_.batch(kShownWords, false, rng);
  const auto from = known(batch.from), there = average_->there(from);
  return {{"again", word_cycle_loss(average_->back(there), from).item<double>()},
          {"changed", (there - from).abs().mean().item<double>()},
          {"liveliness", (word_coherence_loss(there) / word_coherence_loss(from)).item<double>()}};
}

nn::WeightsHeader WordsTrainer::header() const {
  double joints = 0;
  for (int j = 0; j < kJointCount; ++j)
    if (form_.joints[static_cast<size_t>(j)]) joints += static_cast<double>(1 << j);
  nn::WeightsHeader header{"style-words",
                           nn::kWordsVersion,
                           {{"joints", joints},
                            {"width", static_cast<double>(form_.net.width)},
                            {"blocks", static_cast<double>(form_.net.blocks)},
                            {"joint_wise", form_.net.joint_wise ? 1.0 : 0.0},
                            {"from_least", static_cast<double>(form_.from.least)},
                            {"from_most", static_cast<double>(form_.from.most)},
                            {"to_least", static_cast<double>(form_.to.least)},
                            {"to_most", static_cast<double>(form_.to.most)}}};
  header.texts = {{"label", options_.to},
                  {"made_from", options_.made_from},
                  {"licence", options_.licence},
                  {"attribution", options_.attribution}};
  return header;
}

void WordsTrainer::put_own(torch::serialize::OutputArchive& archive) const {
  put(archive, "tells_to", *tells_to_);
  put(archive, "tells_from", *tells_from_);
  put(archive, "telling", *telling_);
  put_random(archive, rng_.state());
}

void WordsTrainer::take_own(torch::serialize::InputArchive& archive) {
  take(archive, "tells_to", *tells_to_);
  take(archive, "tells_from", *tells_from_);
  take(archive, "telling", *telling_);
  rng_ = Rng(take_random(archive));
}

}  // namespace

int train(const nn::StyleTrainOptions& options) {
  return WordsTrainer(options).run();
}

}  // namespace understudy::training
