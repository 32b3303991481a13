#include "retarget/training/words_data.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/time_filter.hpp"
#include "retarget/nn/modules/tensor_of.hpp"

namespace understudy::training {
namespace fs = std::filesystem;
namespace {

constexpr int kFewestFrames = 10;  // of a run; what is missing of a word repeats the last one

std::vector<std::string> all_clips(const std::string& folder) {
  std::error_code failed;
  US_CHECK(fs::is_directory(folder, failed), folder, ": there is no such folder of clips");
  std::vector<std::string> files;
  for (const auto& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::follow_directory_symlink))
    if (file_suffix(entry.path().string()) == ".npz") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// AMASS's own clips have z up.
void turn_upright(Motion& motion) {
  const Vec3 up = motion.poses.front().local[Pelvis].col(1);
  if (std::abs(up.z()) <= std::abs(up.y())) return;
  const Mat3 turn = rotation_from_axis_angle(Vec3(-kPi / 2, 0, 0));
  for (Pose& pose : motion.poses) pose.local[Pelvis] = turn * pose.local[Pelvis];
}

/// The poses of a run at kWordRate, as rows.
WordRows rows_of(const Clip& clip, const ClipRun& run, double smooth_frames) {
  const double step = static_cast<double>(clip.motion.fps) / static_cast<double>(kWordRate);
  std::vector<std::vector<Mat3>> turns(kJointCount);
  for (double at = 0; at <= run.count - 1 + 1e-6; at += step) {
    const auto frame = static_cast<size_t>(run.first + std::min(run.count - 1, static_cast<int>(at + 0.5)));
    for (int j = 0; j < kJointCount; ++j)
      turns[static_cast<size_t>(j)].push_back(clip.motion.poses[frame].local[j]);
  }
  const auto strength =
      static_cast<float>(smooth_frames / static_cast<double>(kWordRate * kSmoothestSeconds));
  for (auto& one : turns) one = filtered_rotations(one, half_gaussian(std::min(1.0f, strength), kWordRate));
  WordRows rows(static_cast<Eigen::Index>(turns[0].size()), kWordNumbers);
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    Rotations local;
    for (int j = 0; j < kJointCount; ++j) local[j] = turns[static_cast<size_t>(j)][static_cast<size_t>(t)];
    rows.row(t) = word_row(local);
  }
  return rows;
}

std::string action_of(const std::string& path) {
  std::string action;
  for (const std::string& label : clip_labels(path)) append_item(action, label);
  return action;
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
  for (const std::string& path : all_clips(folder)) {
    std::vector<Clip> clip = {read_clip(path)};
    if (clip[0].motion.poses.empty()) continue;
    turn_upright(clip[0].motion);
    const std::string action = action_of(path);
    bool any = false;
    for (const ClipRun& run : good_runs(clip, kFewestFrames, 1 << 30)) {
      const std::vector<WordRows> words = cut_words(rows_of(clip[0], run, smooth_frames));
      for (size_t i = 0; i < words.size(); ++i) {
        least = std::min(least, words[i].minCoeff()), most = std::max(most, words[i].maxCoeff());
        domain.words.push_back(words[i]);
        domain.actions.push_back(action);
        domain.has_next.push_back(i + 1 < words.size());
      }
      any = true;
    }
    domain.clips += any ? 1 : 0;
  }
  US_CHECK(domain.clips > 0, folder, ": holds no clip (.npz, AMASS-format) with a good frame");
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
