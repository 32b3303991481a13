#include "app/cli/style_evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "app/run/case_source.hpp"
#include "app/run/styled_clip.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/math/time_filter.hpp"
#include "retarget/metrics/motion_alignment.hpp"
#include "retarget/style/style_frames.hpp"

namespace understudy::app {
namespace {

constexpr double kNoiseSeconds = 0.05;  // the Gaussian whose residual is called noise
constexpr int kResamples = 1000;
constexpr const char* kMedians[] = {"body_sway_deg", "head_turn", "pelvis_speed", "rise_s", "jerk"};

double share(bool yes) {
  return yes ? 100 : 0;
}

void add_known(Metrics& figures, const std::string& key, double value) {
  if (std::isfinite(value)) figures.emplace_back(key, value);
}

/// The clip in another style.
StyledClip restyled(const StyledClip& clip, MotionStyle& style) {
  StyledClip result = clip;
  result.poses.clear();
  StyleFrames frames;
  const auto take = [&](const std::optional<Extraction>& made) {
    if (!made) return false;
    result.poses.push_back(frames.push(*made, static_cast<float>(1 / clip.fps)).pose);
    return true;
  };
  style.reset();
  for (size_t t = 0; t < clip.poses.size(); ++t) {
    style.push(exact_extraction(forward_kinematics(clip.rest, clip.poses[t])),
               t == 0 ? 0.0f : static_cast<float>(1 / clip.fps));
    while (take(style.pop())) {
    }
  }
  style.finish();
  while (take(style.pop())) {
  }
  return result;
}

/// What smoothing takes away from each joint in each frame.
std::vector<Rotations> residual_of(const StyledClip& clip) {
  const auto half =
      half_gaussian(static_cast<float>(kNoiseSeconds) / kSmoothestSeconds, static_cast<float>(clip.fps));
  std::vector<Rotations> residual(clip.poses.size());
  for (int j = 0; j < kJointCount; ++j) {
    std::vector<Mat3> turns;
    for (const Pose& pose : clip.poses) turns.push_back(pose.local[j]);
    const std::vector<Mat3> smooth = filtered_rotations(turns, half);
    for (size_t t = 0; t < turns.size(); ++t) residual[t][j] = smooth[t].transpose() * turns[t];
  }
  return residual;
}

/// {"mean", "low", "high"}: subjects are drawn with replacement.
Json interval(const std::map<std::string, std::vector<double>>& by_subject) {
  std::vector<const std::vector<double>*> subjects;
  subjects.reserve(by_subject.size());
  for (const auto& [name, values] : by_subject) subjects.push_back(&values);
  const auto mean_of = [](const std::vector<const std::vector<double>*>& chosen) {
    double sum = 0, count = 0;
    for (const auto* values : chosen)
      for (const double value : *values) sum += value, ++count;
    return sum / count;
  };
  std::mt19937 random(1);
  std::vector<double> means;
  for (int i = 0; i < kResamples; ++i) {
    std::vector<const std::vector<double>*> drawn;
    for (size_t k = 0; k < subjects.size(); ++k) drawn.push_back(subjects[random() % subjects.size()]);
    means.push_back(mean_of(drawn));
  }
  std::sort(means.begin(), means.end());
  return {{"mean", mean_of(subjects)},
          {"low", means[kResamples / 40]},
          {"high", means[kResamples - 1 - kResamples / 40]}};
}

Json known(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

}  // namespace

StyleEvaluation::StyleEvaluation(const EvalOptions& options) : options_(options) {
  NetworkParts parts;
  parts.extractor = parts.style = true;
  networks_ = nn::load_networks(network_options(options.how), parts);
  if (!options.style_back.empty()) {
    MethodOptions back = options.how;
    back.method.style.choose(options.style_back);
    NetworkParts style;
    style.style = true;
    back_ = nn::load_networks(network_options(back), style).style;
  }
  if (!options.judge.empty()) judge_ = nn::load_style_judge(options.judge);
  for (const std::string& folder : case_folders(options.cases)) {
    const Case c = read_case(folder);
    if (c.style && c.style->real()) real_.push_back(folder);
  }
}

StyleEvaluation::~StyleEvaluation() = default;

StyledClip StyleEvaluation::read(const Case& c) const {
  Networks plain = networks_;
  plain.style = nullptr;
  SourceOptions source = case_source(c);
  source.quiet = true;
  return styled_clip(source, plain, retarget_options(options_.how));
}

const ChannelStatistics& StyleEvaluation::statistics(const std::string& manner) {
  const auto found = statistics_.find(manner);
  if (found != statistics_.end()) return found->second;
  US_CHECK(!options_.data.empty(), "--baseline ", options_.baseline,
           " needs --data: the folder with the clips of both manners");
  return statistics_.emplace(manner, ChannelStatistics(options_.data + "/" + manner, networks_))
      .first->second;
}

/// In the style, or as the baseline does it, at the source's tempo.
StyledClip StyleEvaluation::styled(const Case& c, const StyledClip& clip) {
  if (options_.baseline == "adain")
    return with_statistics(clip, statistics_of(clip), statistics(c.style->wanted).of());
  if (options_.baseline == "action") {
    std::string content = c.style->contents.empty() ? "" : c.style->contents.front();
    if (!statistics(c.style->is).knows(content) || !statistics(c.style->wanted).knows(content)) content = "";
    return with_statistics(clip, statistics(c.style->is).of(content),
                           statistics(c.style->wanted).of(content));
  }
  US_CHECK(options_.baseline.empty(), c.name, ": --baseline ", options_.baseline,
           " is not of cases of the suite style");
  return networks_.style ? restyled(clip, *networks_.style) : clip;
}

/// The clip with the residual of a real one.
StyledClip StyleEvaluation::noised(const StyledClip& clip) {
  const std::vector<Rotations> residual = residual_of(read(read_case(real_[noises_++ % real_.size()])));
  StyledClip result = clip;
  for (size_t t = 0; t < result.poses.size(); ++t)
    for (int j = 0; j < kJointCount; ++j)
      result.poses[t].local[j] = clip.poses[t].local[j] * residual[t % residual.size()][j];
  return result;
}

void StyleEvaluation::judge_source(const Case& c, const StyledClip& source, const StyledClip& styled,
                                   Metrics& figures) {
  if (!judge_) return;
  const std::string& wanted = c.style->wanted;
  const Verdict verdict = judge_->judge(styled.local(), styled.fps);
  figures.emplace_back("style_share", share(verdict.look == wanted));
  figures.emplace_back("coordination_share", share(verdict.coordination == wanted));
  const auto& contents = c.style->contents;
  if (!contents.empty() && !judge_->contents().empty())
    figures.emplace_back("content_kept", share(std::find(contents.begin(), contents.end(), verdict.content) !=
                                               contents.end()));
  const double before = share(judge_->judge(source.local(), source.fps).look == wanted);
  if (!real_.empty())
    figures.emplace_back("noise_control",
                         share(judge_->judge(noised(source).local(), source.fps).look == wanted) - before);
}

void StyleEvaluation::judge_real(const Case& c, const StyledClip& clip, Metrics& figures) {
  if (!judge_) return;
  const Verdict verdict = judge_->judge(clip.local(), clip.fps);
  figures.emplace_back("real_style_share", share(verdict.look == c.style->wanted));
  figures.emplace_back("real_coordination_share", share(verdict.coordination == c.style->wanted));
  const auto& contents = c.style->contents;
  if (!contents.empty() && !judge_->contents().empty())
    figures.emplace_back("real_content", share(std::find(contents.begin(), contents.end(), verdict.content) !=
                                               contents.end()));
}

void StyleEvaluation::evaluate(const Case& c, CaseResult& result) {
  US_CHECK(options_.oracle.empty() && options_.restart_every == 0 && !options_.file_shapes, c.name,
           ": of the suite style: --oracle, --restart-every and --file do not apply");
  const StyledClip source = read(c);
  const std::string subject = c.style->subject.empty() ? c.name : c.style->subject;
  result.frames = static_cast<int64_t>(source.poses.size());
  const Metrics was = figures_of(source);
  if (c.style->real()) {
    judge_real(c, source, result.metrics);
    records_[Real].push_back({subject, was});
    records_[Real].back().figures.insert(records_[Real].back().figures.end(), result.metrics.begin(),
                                         result.metrics.end());
    return;
  }
  const auto began = std::chrono::steady_clock::now();
  StyledClip made = styled(c, source);
  FrameTimes times;
  times.transfer = times.total =
      ms_since(began) / static_cast<double>(std::max<size_t>(1, made.poses.size()));
  for (size_t t = 0; t < made.poses.size(); ++t) result.latency.add(times);
  const Metrics before_tempo = figures_of(made);
  Metrics& figures = result.metrics;
  if (back_) {
    const double there = aligned_angle_deg(source.local(), made.local(), source.fps);
    add_known(figures, "cycle_deg",
              aligned_angle_deg(source.local(), restyled(made, *back_).local(), source.fps));
    add_known(figures, "cycle_share", value_of(figures, "cycle_deg") / there);
  }
  give_tempo(options_.tempo, options_.legs_m, made);
  judge_source(c, source, made, figures);
  add_known(figures, "dtw_deg", aligned_angle_deg(source.local(), made.local(), source.fps));
  const Metrics is = figures_of(made);
  add_known(figures, "jerk_ratio", value_of(before_tempo, "jerk") / value_of(was, "jerk"));
  add_known(figures, "stance_slide_ratio",
            value_of(before_tempo, "stance_slide") / value_of(was, "stance_slide"));
  add_known(figures, "cycle_ratio", value_of(is, "cycle_s") / value_of(was, "cycle_s"));
  add_known(figures, "flight_ratio", value_of(is, "flight_g") / value_of(was, "flight_g"));
  figures.insert(figures.end(), is.begin(), is.end());
  records_[Source].push_back({subject, was});
  records_[Styled].push_back({subject, figures});
}

Json StyleEvaluation::summary() const {
  if (records_.empty()) return {};
  Json json;
  std::map<std::string, std::map<std::string, std::vector<double>>> by_key;
  for (const Kind kind : {Styled, Real})
    if (const auto found = records_.find(kind); found != records_.end())
      for (const Record& record : found->second)
        for (const auto& [key, value] : record.figures)
          if (kind == Styled || key.rfind("real_", 0) == 0) by_key[key][record.subject].push_back(value);
  for (const auto& [key, by_subject] : by_key) json["figures"][key] = interval(by_subject);
  for (const char* key : kMedians) {
    std::map<Kind, std::vector<double>> medians;  // of subjects
    for (const auto& [kind, records] : records_) {
      std::map<std::string, std::vector<double>> values;
      for (const Record& record : records)
        if (const double value = value_of(record.figures, key); std::isfinite(value))
          values[record.subject].push_back(value);
      for (const auto& [subject, all] : values) medians[kind].push_back(median_of(all));
    }
    Json& row = json["medians"][key];
    row = {{"source", known(median_of(medians[Source]))},
           {"styled", known(median_of(medians[Styled]))},
           {"real", known(median_of(medians[Real]))}};
    const std::vector<double>& real = medians[Real];
    if (real.empty()) continue;
    row["real_low"] = *std::min_element(real.begin(), real.end());
    row["real_high"] = *std::max_element(real.begin(), real.end());
  }
  return json;
}

}  // namespace understudy::app
