#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/modules/judge_net.hpp"
#include "retarget/style/judged_channels.hpp"
#include "retarget/training/judge_data.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kJudgeBatch = 32, kVotes = 8;   // clips of a step; words of each, that vote
constexpr int64_t kUsualSamples = 64 * 2000;  // clips, about a core-minute

/// What is added to words, normal; of the channels' spread.
struct Noise {
  double each, offset, gain;  // of each number; of a channel in all words of a clip; of the clip, relative
};
// Chosen by how many clips of people that nothing was learned from are judged right. With an offset a judge
// hangs less on somebody's own posture.
constexpr Noise kLookNoise{0.1, 0.5, 0}, kCoordinationNoise{0.1, 0, 0}, kContentNoise{0.05, 0.6, 0.3};

Schedule judge_schedule() {
  Schedule schedule;
  schedule.rate = 1e-3;
  schedule.warm_up = 50;
  schedule.average_decay = 0.995;
  return schedule;
}

/// Right ones among the clips that were asked about.
class Share {
 public:
  void add(bool right) { ++asked_, right_ += right ? 1 : 0; }
  double value() const { return asked_ > 0 ? right_ / asked_ : std::numeric_limits<double>::quiet_NaN(); }

 private:
  double asked_ = 0, right_ = 0;
};

class JudgeTrainer final : public TrainingRun {
 public:
  explicit JudgeTrainer(const nn::StyleJudgeTrainOptions& options);

 private:
  Step learn() override;
  Figures evaluate() override;
  nn::WeightsHeader header() const override;
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  nn::StyleJudgeTrainOptions options_;
  Rng rng_;
  JudgeData data_;
  JudgeWords words_;
  nn::JudgeNet net_, average_;
};

JudgeTrainer::JudgeTrainer(const nn::StyleJudgeTrainOptions& options)
    : TrainingRun(options, options.kNetwork, judge_schedule()),
      options_(options),
      rng_(options.seed),
      data_(read_judge_data(options)),
      words_(data_),
      net_(data_.form),
      average_(data_.form) {
  US_CHECK(device().is_cpu(), "judges of style learn on the CPU");
  for (nn::JudgeNet& net : std::vector<nn::JudgeNet>{net_, average_})
    for (nn::JudgePart& part : std::vector<nn::JudgePart>{net->look, net->content})
      part->set_scale(words_.mean(), words_.spread());
  average_->eval();
  own(net_.ptr(), average_.ptr(),
      std::make_unique<torch::optim::AdamW>(net_->parameters(),
                                            torch::optim::AdamWOptions(1e-3).weight_decay(1e-2)));
  log::info(detail::join("style-judge: ", data_.clips.size(), " clips, ", data_.form.styles.size(),
                         " styles, ", data_.form.contents.size(), " contents, ", data_.form.channels.size(),
                         " channels"));
}

/// words [clips * kVotes, T, channels].
torch::Tensor noisy(const torch::Tensor& words, const torch::Tensor& spread, const Noise& noise) {
  const auto x = words.view({-1, kVotes, words.size(1), words.size(2)});
  const auto offset = torch::randn({x.size(0), 1, 1, x.size(3)}), gain = torch::randn({x.size(0), 1, 1, 1}),
             mean = x.mean(2, true);
  const auto sized = mean + (x - mean) * torch::exp(noise.gain * gain);
  return (sized + spread * (noise.each * torch::randn_like(x) + noise.offset * offset)).view_as(words);
}

/// What all words of a clip say together is learned, not what each says: one in which nothing happens may
/// leave it open. logs [clips * kVotes, classes].
torch::Tensor vote_loss(const torch::Tensor& logs, const torch::Tensor& truth,
                        const torch::Tensor& weights = {}) {
  const auto sum = logs.view({-1, kVotes, logs.size(1)}).sum(1);
  return torch::nn::functional::nll_loss(torch::log_softmax(sum, 1), truth,
                                         torch::nn::functional::NLLLossFuncOptions().weight(weights));
}

TrainingRun::Step JudgeTrainer::learn() {
  const int count = options_.batch > 0 ? options_.batch : kJudgeBatch;
  // What LibTorch draws hangs on the step alone: a training that is resumed draws the same.
  torch::manual_seed(rng_.next());
  const JudgeBatch batch = words_.batch(count, kVotes, rng_);
  const auto spread = words_.spread(), one = torch::ones_like(spread);
  LossSum loss;
  loss.add("look", vote_loss(net_->look(noisy(batch.look, spread, kLookNoise)), batch.styles));
  loss.add("coordination",
           vote_loss(net_->coordination(noisy(batch.coordination, one, kCoordinationNoise)), batch.styles));
  loss.add("content", vote_loss(net_->content(noisy(batch.content, spread, kContentNoise)), batch.contents,
                                words_.content_weights()));
  loss.total.backward();
  return {count, loss.parts};
}

/// Which share of the clips that are not learned from is judged right.
Figures JudgeTrainer::evaluate() {
  Share look, coordination, content;
  for (const JudgeClip& clip : data_.clips) {
    if (!clip.held) continue;
    nn::JudgeVotes sum{torch::zeros({1}), torch::zeros({1}), torch::zeros({1})};
    for (const nn::JudgedClip& run : clip.runs) {
      const nn::JudgeVotes votes = nn::votes_of(average_, data_.form, run);
      const auto weight = static_cast<double>(run.channels.rows());
      sum.look = sum.look + weight * votes.look;
      sum.coordination = sum.coordination + weight * votes.coordination;
      sum.content = sum.content + weight * votes.content;
    }
    look.add(sum.look.argmax().item<int64_t>() == clip.style);
    coordination.add(sum.coordination.argmax().item<int64_t>() == clip.style);
    content.add(sum.content.argmax().item<int64_t>() == clip.content);
  }
  return {{"look_right", look.value()},
          {"coordination_right", coordination.value()},
          {"content_right", content.value()}};
}

std::string lines_of(const std::vector<std::string>& names) {
  std::string lines;
  for (const std::string& name : names) lines += name + "\n";
  return lines;
}

nn::WeightsHeader JudgeTrainer::header() const {
  std::string channels(3 * judged_joints(data_.form.legs).size(), '0');
  for (const int c : data_.form.channels) channels[static_cast<size_t>(c)] = '1';
  nn::WeightsHeader header{
      "style-judge",
      nn::kJudgeVersion,
      {{"legs", data_.form.legs ? 1.0 : 0.0}, {"sides_matter", data_.form.sides_matter ? 1.0 : 0.0}}};
  header.texts = {{"styles", lines_of(data_.form.styles)},
                  {"contents", lines_of(data_.form.contents)},
                  {"channels", channels},
                  {"made_from", options_.made_from},
                  {"licence", options_.licence},
                  {"attribution", options_.attribution}};
  return header;
}

}  // namespace

int train(const nn::StyleJudgeTrainOptions& options) {
  return JudgeTrainer(with_end(options, kUsualSamples)).run();
}

}  // namespace understudy::training
