// Motion words of two manners of moving: folders of clips, cut, paired by what is done (paper 4, section
// 3.2).
#pragma once

#include <torch/torch.h>

#include <string>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/style/motion_words.hpp"

namespace understudy::training {

/// The words of one domain.
struct WordDomain {
  std::vector<WordRows> words;
  std::vector<std::string> actions;  ///< of each word what its clip shows: "walk", "jump, turn"; may be empty
  std::vector<bool> has_next;        ///< whether the next word is the same clip's
  int clips = 0;
  WordRange range;
};

/// All clips (.npz, AMASS-format) in the folder and the folders in it, in the order of their names, at 30
/// frames/s, smoothed by a Gaussian of `smooth_frames`: what a capture's noise alone would tell is taken from
/// both domains alike. Flagged frames are left out. Throws Error naming the folder where there are fewer than
/// two clips.
WordDomain read_words(const std::string& folder, double smooth_frames);

/// Words of both domains that show the same: [B, kWordFrames, kWordNumbers] each, in -1 .. 1 of their
/// domains.
struct WordBatch {
  torch::Tensor from, to;
  torch::Tensor next;  ///< the words after those of `from`, where asked for
};

class WordPairs {
 public:
  /// Throws Error where the domains have no action in common.
  WordPairs(WordDomain from, WordDomain to);
  WordBatch batch(int count, bool with_next, Rng& rng) const;
  const WordRange& from_range() const { return from_.range; }
  const WordRange& to_range() const { return to_.range; }
  size_t words() const { return from_.words.size() + to_.words.size(); }

 private:
  struct Action {
    std::vector<size_t> from, to, from_with_next;
  };
  WordDomain from_, to_;
  std::vector<Action> actions_;  // in both domains
  std::vector<double> up_to_;    // words of `from` so far: an action is drawn as often as it has
};

}  // namespace understudy::training
