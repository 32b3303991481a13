// What judges of style learn from: a folder of clips for each style, as numbers that move.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/networks/train_options.hpp"
#include "retarget/nn/modules/judge_net.hpp"

namespace understudy::training {

struct JudgeClip {
  std::vector<nn::JudgedClip> runs;  ///< without a flagged frame
  int64_t style = 0, content = 0;
  bool held = false;  ///< not learned from
};

struct JudgeData {
  nn::JudgeForm form;
  std::vector<JudgeClip> clips;
};

/// All clips in the folders of `data`; a tenth, by their paths in it, is held. Throws Error naming a folder
/// that is no data, or has no clip.
JudgeData read_judge_data(const nn::StyleJudgeTrainOptions& options);

/// Words as each judge sees them, [clips * words of each, kWordFrames, channels], and what the clips are,
/// [clips].
struct JudgeBatch {
  torch::Tensor look, coordination, content, styles, contents;
};

/// Draws words: each style as often as any other, each of its runs too. The data must outlive it.
class JudgeWords {
 public:
  /// Throws Error where a style has no clip that is learned from.
  explicit JudgeWords(const JudgeData& data);
  JudgeBatch batch(int clips, int words, Rng& rng) const;
  /// Of what the judges of look and content see, [channels] each.
  torch::Tensor mean() const { return mean_; }
  torch::Tensor spread() const { return spread_; }
  /// Of each content in the loss, [contents]: one over the root of how often there is one, their mean over
  /// what is learned from is 1.
  torch::Tensor content_weights() const { return content_weights_; }

 private:
  struct Learned {
    const nn::JudgedClip* run;
    int64_t content;
  };
  std::vector<std::vector<Learned>> styles_;
  bool sides_matter_;
  torch::Tensor mean_, spread_, content_weights_;
};

}  // namespace understudy::training
