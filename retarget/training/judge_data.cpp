#include "retarget/training/judge_data.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/style/judged_channels.hpp"
#include "retarget/style/motion_words.hpp"
#include "retarget/training/style_clips.hpp"

namespace understudy::training {
namespace fs = std::filesystem;
namespace {

constexpr int kHeldShare = 10;        // one clip of so many
constexpr float kLeastScale = 0.01f;  // radians, of a channel
constexpr float kLeastPart = 0.7f;    // of a clip, whose coordination is looked at
constexpr float kSlowest = 0.8f, kFastest = 1.25f;

std::vector<std::string> style_folders(const std::string& data) {
  std::error_code failed;
  US_CHECK(fs::is_directory(data, failed), data, ": there is no such folder");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(data))
    if (entry.is_directory() && entry.path().filename().string()[0] != '.')
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  US_CHECK(names.size() > 1, data, ": holds ", names.size() == 1 ? "one folder" : "no folder",
           "; a judge needs the clips of each of two styles or more in a folder of its own");
  return names;
}

std::string content_of(const std::string& path, bool description) {
  if (description) return lower_case(clip_description(path));
  const std::vector<std::string> labels = clip_labels(path);
  return labels.empty() ? std::string() : lower_case(labels.front());
}

/// All channels of the clips; contents are numbered as they come.
struct RawClip {
  std::vector<RowMatrix> runs;
  int64_t style;
  std::string content;
  bool held;
};

std::vector<RawClip> read_raw(const nn::StyleJudgeTrainOptions& options,
                              const std::vector<std::string>& styles) {
  std::vector<RawClip> clips;
  const fs::path data = options.data;
  for (size_t s = 0; s < styles.size(); ++s)
    each_style_clip((data / styles[s]).string(), kJudgedSmooth, [&](const StyleClip& clip) {
      const std::string inside = fs::path(clip.path).lexically_relative(data).generic_string();
      RawClip& raw = clips.emplace_back();
      raw.style = static_cast<int64_t>(s);
      raw.content = content_of(clip.path, options.contents == "descriptions");
      raw.held = fnv1a(inside) % kHeldShare == 0;
      for (const auto& run : clip.runs) raw.runs.push_back(judged_channels(run, options.legs));
    });
  return clips;
}

std::vector<int> moving_channels_of(const std::vector<RawClip>& clips, const std::string& data, bool legs) {
  std::vector<RowMatrix> learned;
  for (const RawClip& clip : clips)
    if (!clip.held) learned.insert(learned.end(), clip.runs.begin(), clip.runs.end());
  US_CHECK(!learned.empty(), data, ": holds too few clips to learn from");
  std::vector<int> moving = moving_channels(learned, legs);
  US_CHECK(!moving.empty(), data, ": nobody moves in its clips");
  return moving;
}

/// Of a word of the run, that may end after it as the last one of a clip does.
RowMatrix some_word(const RowMatrix& rows, float stretch, Rng& rng) {
  const int starts = std::max(1, static_cast<int>(rows.rows()) - kWordFrames + kWordStride);
  return resampled(rows, static_cast<float>(rng.below(starts)), stretch * (kWordFrames - 1), kWordFrames);
}

RowMatrix some_coordination(const RowMatrix& rows, Rng& rng) {
  const auto frames = static_cast<float>(rows.rows());
  const int part = std::max(1, static_cast<int>(frames * rng.uniform(kLeastPart, 1)));
  const RowMatrix cut = rows.middleRows(rng.below(static_cast<int>(rows.rows()) - part + 1), part);
  return coordination_of(cut).middleRows(rng.below(kCoordinationFrames - kWordFrames + 1), kWordFrames);
}

}  // namespace

JudgeData read_judge_data(const nn::StyleJudgeTrainOptions& options) {
  JudgeData data;
  data.form.legs = options.legs;
  data.form.sides_matter = options.contents == "descriptions";  // "raise your left hand"
  data.form.styles = style_folders(options.data);
  const std::vector<RawClip> clips = read_raw(options, data.form.styles);
  data.form.channels = moving_channels_of(clips, options.data, options.legs);
  std::map<std::string, int64_t> contents;
  for (const RawClip& clip : clips) contents[clip.content] = 0;
  for (auto& [name, number] : contents) {
    number = static_cast<int64_t>(data.form.contents.size());
    data.form.contents.push_back(name);
  }
  for (const RawClip& raw : clips) {
    JudgeClip& clip = data.clips.emplace_back();
    clip.style = raw.style, clip.content = contents[raw.content], clip.held = raw.held;
    for (const RowMatrix& run : raw.runs) clip.runs.push_back(nn::judged_clip(run, data.form));
  }
  return data;
}

JudgeWords::JudgeWords(const JudgeData& data)
    : styles_(data.form.styles.size()), sides_matter_(data.form.sides_matter) {
  std::vector<torch::Tensor> rows;
  std::vector<float> counts(data.form.contents.size());
  for (const JudgeClip& clip : data.clips) {
    if (clip.held) continue;
    for (const nn::JudgedClip& run : clip.runs) {
      styles_[static_cast<size_t>(clip.style)].push_back({&run, clip.content});
      rows.push_back(nn::tensor_of(run.channels));
      rows.push_back(nn::tensor_of(run.mirrored));
      ++counts[static_cast<size_t>(clip.content)];
    }
  }
  for (size_t s = 0; s < styles_.size(); ++s)
    US_CHECK(!styles_[s].empty(), "there are too few clips of the style '", data.form.styles[s],
             "' to learn from");
  const auto all = torch::cat(rows);
  mean_ = all.mean(0);
  spread_ = all.std(0).clamp_min(kLeastScale);
  const auto found = torch::tensor(counts), weights = found.clamp_min(1).rsqrt();
  content_weights_ = weights * (found.sum() / (found * weights).sum());
}

JudgeBatch JudgeWords::batch(int clips, int words, Rng& rng) const {
  std::vector<torch::Tensor> look, coordination, content;
  std::vector<int64_t> styles, contents;
  for (int i = 0; i < clips; ++i) {
    const int style = rng.below(static_cast<int>(styles_.size()));
    const std::vector<Learned>& runs = styles_[static_cast<size_t>(style)];
    const Learned& one = runs[static_cast<size_t>(rng.below(static_cast<int>(runs.size())))];
    const RowMatrix& rows = rng.chance(0.5f) ? one.run->mirrored : one.run->channels;
    const RowMatrix& sided = sides_matter_ ? one.run->channels : rows;
    for (int k = 0; k < words; ++k) {
      look.push_back(nn::tensor_of(some_word(rows, 1, rng)));
      coordination.push_back(nn::tensor_of(some_coordination(rows, rng)));
      content.push_back(nn::tensor_of(some_word(sided, rng.uniform(kSlowest, kFastest), rng)));
    }
    styles.push_back(style);
    contents.push_back(one.content);
  }
  return {torch::stack(look), torch::stack(coordination), torch::stack(content),
          torch::tensor(styles, torch::kLong), torch::tensor(contents, torch::kLong)};
}

}  // namespace understudy::training
