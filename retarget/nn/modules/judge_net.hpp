// The networks that judge style, three in one, and what they say of a clip.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <string>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"
#include "retarget/style/style_judge.hpp"

namespace understudy::nn {

/// Of the networks' form and what they see; weights of another version are refused.
constexpr int kJudgeVersion = 1;

/// What judges are of, and what they see.
struct JudgeForm {
  bool legs = false;
  bool sides_matter = false;  ///< what is done is another thing in a mirror: contents are never mirrored
  std::vector<int> channels;  ///< those used, of judged_channels()
  std::vector<std::string> styles, contents;
};

struct JudgePartOptions {
  int64_t channels = 1, classes = 2, width = 64;
  double dropout = 0.5;
};

/// Tells classes of words apart: two convolutions over time of 5 and 3, each halving it, the mean and the
/// most of what is left, one linear layer.
class JudgePartImpl : public torch::nn::Module {
 public:
  explicit JudgePartImpl(const JudgePartOptions& options);
  /// Words [B, T, channels] to the logarithms of the classes' probabilities, [B, classes].
  torch::Tensor forward(const torch::Tensor& words);
  /// Words less `mean` and over `spread`, [channels] each, are what the convolutions see; else words are.
  void set_scale(const torch::Tensor& mean, const torch::Tensor& spread);

 private:
  torch::Tensor mean_, spread_;
  torch::nn::Conv1d first{nullptr}, second{nullptr};
  torch::nn::Dropout dropout{nullptr};
  torch::nn::Linear last{nullptr};
};
TORCH_MODULE(JudgePart);

class JudgeNetImpl : public torch::nn::Module {
 public:
  explicit JudgeNetImpl(const JudgeForm& form);
  JudgePart look, coordination, content;
};
TORCH_MODULE(JudgeNet);

/// A clip, or a part of one, as the networks see it: [frames, form.channels] at kWordRate.
struct JudgedClip {
  RowMatrix channels, mirrored;  ///< as it is, and in a mirror
};
/// channels: all of judged_channels().
JudgedClip judged_clip(const RowMatrix& channels, const JudgeForm& form);

/// Logarithms of probabilities, the mean over a clip's words and those of its mirror image: [styles],
/// [styles], [contents].
struct JudgeVotes {
  torch::Tensor look, coordination, content;
};
/// The networks must be in evaluation mode.
JudgeVotes votes_of(JudgeNet& net, const JudgeForm& form, const JudgedClip& clip);

std::unique_ptr<StyleJudge> style_judge(JudgeNet net, const JudgeForm& form);

}  // namespace understudy::nn
