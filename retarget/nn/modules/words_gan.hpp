// The networks of paper 4, section 3.3: generators that translate motion words, and what tells real words
// from made ones.
#pragma once

#include <torch/torch.h>

#include <memory>

#include "retarget/style/motion_words.hpp"

namespace understudy::nn {

/// Of the generator's form; weights of another version are refused.
constexpr int kWordsVersion = 1;

struct WordsOptions {
  int64_t joints = kJointCount;  ///< that a word has
  int64_t width = 8;             ///< channels of a joint behind the first convolution; doubled twice
  int64_t blocks = 9;
  /// each joint has kernels of its own (paper); false: one kernel over all joints (the paper's "overall")
  bool joint_wise = true;
};

/// A convolution over time of each joint by itself: [B, J, T, in] to [B, J, T / stride, out]. The joints are
/// a batch of small dense products.
class JointConvImpl : public torch::nn::Module {
 public:
  JointConvImpl(int64_t joints, int64_t in, int64_t out, int64_t size, int64_t stride = 1, double gain = 1);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  int64_t size_, stride_;
  torch::Tensor weight, bias;  // [J, size * in, out], [J, 1, out]
};
TORCH_MODULE(JointConv);

/// Convolutions of 7, 3 and 3 over time (the latter two halve it), residual blocks of two convolutions of 3,
/// two that double time again, one of 7. Beside the paper: a way straight from input to output, so that it
/// begins as the identity; time is doubled by repeating frames before a convolution in place of a
/// deconvolution; no normalisation, which would take amplitudes away.
class WordGeneratorImpl : public torch::nn::Module {
 public:
  explicit WordGeneratorImpl(const WordsOptions& options = {});
  /// Words in -1 .. 1, [B, kWordFrames, 4 joints].
  torch::Tensor forward(const torch::Tensor& words);
  const WordsOptions& options() const { return options_; }

 private:
  WordsOptions options_;
  JointConv first{nullptr}, down1{nullptr}, down2{nullptr}, up1{nullptr}, up2{nullptr}, last{nullptr};
  torch::nn::ModuleList blocks;
};
TORCH_MODULE(WordGenerator);

/// Convolutions over time and all joints of 64, 128, 256 and 512 filters of size 4, the first three halve
/// time, and a score for each of what is left (paper, section 3.3): [B, kWordFrames, 4 joints] to [B,
/// scores].
class WordDiscriminatorImpl : public torch::nn::Module {
 public:
  explicit WordDiscriminatorImpl(int64_t joints = kJointCount);
  torch::Tensor forward(const torch::Tensor& words);

 private:
  torch::nn::Sequential layers{nullptr};
};
TORCH_MODULE(WordDiscriminator);

}  // namespace understudy::nn
