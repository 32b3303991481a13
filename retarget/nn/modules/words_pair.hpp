// Both generators of paper 4 as one network, and its use.
#pragma once

#include <memory>
#include <string>

#include "retarget/nn/modules/words_gan.hpp"

namespace understudy::nn {

/// There and back.
class WordsPairImpl : public torch::nn::Module {
 public:
  explicit WordsPairImpl(const WordsOptions& options = {})
      : there(register_module("there", WordGenerator(options))),
        back(register_module("back", WordGenerator(options))) {}
  WordGenerator there, back;
};
TORCH_MODULE(WordsPair);

/// What a words network was trained on.
struct WordsForm {
  WordsOptions net;
  std::array<bool, kJointCount> joints{};  ///< as many as net.joints
  WordRange from, to;                      ///< of its domains
};

/// [B, T, 4 joints] of the form's joints alone.
torch::Tensor known_joints(const torch::Tensor& rows, const std::array<bool, kJointCount>& joints);

/// The network as a translator from its first domain to its second.
std::unique_ptr<WordTranslator> word_translator(WordsPair net, const WordsForm& form);

}  // namespace understudy::nn
