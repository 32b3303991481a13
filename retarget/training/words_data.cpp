#include "retarget/training/words_data.hpp"

#include <algorithm>
#include <map>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/training/style_clips.hpp"

namespace understudy::training {
namespace {

std::string action_of(const StyleClip& clip) {
  std::string action;
  for (const std::string& label : clip_labels(clip.path)) append_item(action, label);
  return action;
}

WordRows rows_of(const std::vector<Rotations>& run) {
  WordRows rows(static_cast<Eigen::Index>(run.size()), kWordNumbers);
  for (size_t t = 0; t < run.size(); ++t) rows.row(static_cast<Eigen::Index>(t)) = word_row(run[t]);
  return rows;
}

torch::Tensor stacked(const WordDomain& domain, const std::vector<size_t>& chosen) {
  std::vector<torch::Tensor> rows;
  rows.reserve(chosen.size());
  for (const size_t i : chosen) rows.push_back(nn::tensor_of(domain.range.to_unit(domain.words[i])));
  return torch::stack(rows);
}

}  // namespace

WordDomain read_words(const std::string& folder, double smooth_frames) {
  WordDomain domain;
  float least = 1e9f, most = -1e9f;
  domain.clips = each_style_clip(folder, smooth_frames, [&](const StyleClip& clip) {
    const std::string action = action_of(clip);
    for (const std::vector<Rotations>& run : clip.runs) {
      const std::vector<WordRows> words = cut_words(rows_of(run));
      for (size_t i = 0; i < words.size(); ++i) {
        least = std::min(least, words[i].minCoeff()), most = std::max(most, words[i].maxCoeff());
        domain.words.push_back(words[i]);
        domain.actions.push_back(action);
        domain.has_next.push_back(i + 1 < words.size());
      }
    }
  });
  US_CHECK(domain.clips > 1, folder, ": holds one clip; a manner of moving needs several");
  domain.range = {least, most};
  return domain;
}

WordPairs::WordPairs(WordDomain from, WordDomain to) : from_(std::move(from)), to_(std::move(to)) {
  std::map<std::string, Action> actions;
  for (size_t i = 0; i < from_.words.size(); ++i) {
    actions[from_.actions[i]].from.push_back(i);
    if (from_.has_next[i]) actions[from_.actions[i]].from_with_next.push_back(i);
  }
  for (size_t i = 0; i < to_.words.size(); ++i) actions[to_.actions[i]].to.push_back(i);
  double sum = 0;
  for (auto& [name, action] : actions) {
    if (action.from.empty() || action.to.empty()) continue;
    sum += static_cast<double>(action.from.size());
    up_to_.push_back(sum);
    actions_.push_back(std::move(action));
  }
  US_CHECK(!actions_.empty(), "the two domains have no action in common: words are paired by what they show");
}

WordBatch WordPairs::batch(int count, bool with_next, Rng& rng) const {
  std::vector<size_t> from, to, next;
  US_CHECK(!with_next || std::any_of(actions_.begin(), actions_.end(),
                                     [](const Action& one) { return !one.from_with_next.empty(); }),
           "no clip is longer than a word: there are no transitions");
  for (int i = 0; i < count; ++i) {
    const double drawn = up_to_.back() * static_cast<double>(rng.uniform());
    const auto at = std::upper_bound(up_to_.begin(), up_to_.end(), drawn) - up_to_.begin();
    const Action& action =
        actions_[static_cast<size_t>(std::min<std::ptrdiff_t>(at, std::ptrdiff_t(actions_.size()) - 1))];
    const auto any_of = [&](const std::vector<size_t>& list) {
      return list[static_cast<size_t>(rng.below(static_cast<int>(list.size())))];
    };
    const bool follows = with_next;
    if (with_next && action.from_with_next.empty()) {  // another one
      --i;
      continue;
    }
    from.push_back(any_of(follows ? action.from_with_next : action.from));
    next.push_back(from.back() + (follows ? 1 : 0));
    to.push_back(any_of(action.to));
  }
  WordBatch batch{stacked(from_, from), stacked(to_, to), {}};
  if (with_next) batch.next = stacked(from_, next);
  return batch;
}

}  // namespace understudy::training
