#include "retarget/nn/modules/judge_net.hpp"

#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/style/judged_channels.hpp"
#include "retarget/style/motion_words.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t kStyleWidth = 64, kContentWidth = 128;  // there are more contents than styles

torch::nn::Conv1d halving(int64_t in, int64_t out, int64_t size) {
  return torch::nn::Conv1d(torch::nn::Conv1dOptions(in, out, size).stride(2));
}

JudgePart part_of(const JudgeForm& form, const std::vector<std::string>& classes, int64_t width) {
  JudgePartOptions options;
  options.channels = static_cast<int64_t>(form.channels.size());
  options.classes = static_cast<int64_t>(classes.size());
  options.width = width;
  return JudgePart(options);
}

/// The columns that the form uses.
RowMatrix used_channels(const RowMatrix& channels, const JudgeForm& form) {
  RowMatrix used(channels.rows(), static_cast<Eigen::Index>(form.channels.size()));
  for (Eigen::Index c = 0; c < used.cols(); ++c)
    used.col(c) = channels.col(form.channels[static_cast<size_t>(c)]);
  return used;
}

/// [words, kWordFrames, columns].
torch::Tensor words_of(const RowMatrix& rows) {
  std::vector<torch::Tensor> words;
  for (const WordRows& word : cut_words(rows)) words.push_back(tensor_of(word));
  return torch::stack(words);
}

JudgeVotes votes_one_way(JudgeNet& net, const RowMatrix& channels) {
  const auto words = words_of(channels), together = words_of(coordination_of(channels));
  return {net->look(words).mean(0), net->coordination(together).mean(0), net->content(words).mean(0)};
}

}  // namespace

JudgePartImpl::JudgePartImpl(const JudgePartOptions& options) {
  mean_ = register_buffer("mean", torch::zeros({options.channels}));
  spread_ = register_buffer("spread", torch::ones({options.channels}));
  first = register_module("first", halving(options.channels, options.width, 5));
  second = register_module("second", halving(options.width, options.width, 3));
  dropout = register_module("dropout", torch::nn::Dropout(options.dropout));
  last = register_module("last", torch::nn::Linear(2 * options.width, options.classes));
}

torch::Tensor JudgePartImpl::forward(const torch::Tensor& words) {
  const auto x = ((words - mean_) / spread_).transpose(1, 2);  // [B, C, T]
  const auto y = torch::relu(second(torch::relu(first(x))));   // [B, width, T']
  const auto pooled = torch::cat({y.mean(2), y.amax(2)}, 1);   // [B, 2 width]
  return torch::log_softmax(last(dropout(pooled)), 1);
}

void JudgePartImpl::set_scale(const torch::Tensor& mean, const torch::Tensor& spread) {
  const torch::NoGradGuard no_grad;
  mean_.copy_(mean);
  spread_.copy_(spread);
}

JudgeNetImpl::JudgeNetImpl(const JudgeForm& form)
    : look(register_module("look", part_of(form, form.styles, kStyleWidth))),
      coordination(register_module("coordination", part_of(form, form.styles, kStyleWidth))),
      content(register_module("content", part_of(form, form.contents, kContentWidth))) {}

JudgedClip judged_clip(const RowMatrix& channels, const JudgeForm& form) {
  return {used_channels(channels, form), used_channels(mirrored_channels(channels, form.legs), form)};
}

JudgeVotes votes_of(JudgeNet& net, const JudgeForm& form, const JudgedClip& clip) {
  const torch::NoGradGuard no_grad;
  JudgeVotes votes = votes_one_way(net, clip.channels);
  const JudgeVotes mirrored = votes_one_way(net, clip.mirrored);
  votes.look = (votes.look + mirrored.look) / 2;
  votes.coordination = (votes.coordination + mirrored.coordination) / 2;
  if (!form.sides_matter) votes.content = (votes.content + mirrored.content) / 2;
  return votes;
}

}  // namespace understudy::nn
