// How a performance style does on cases of the suite style: what judges say of it, and figures of the motion.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/evaluation.hpp"
#include "app/run/case_folder.hpp"
#include "app/run/style_baselines.hpp"
#include "retarget/style/style_judge.hpp"

namespace understudy::app {

/// Shares are 0 or 100 in one case. Of a source that is styled, x, and as it is, a:
///   style_share, coordination_share: x is the wanted style to the judge of look, of coordination
///   content_kept: x does to the judge what the case says is done
///   noise_control: points by which more of the sources are the wanted style to the judge of look when a real
///     clip's residual, what its smoothing takes away, is added to them
///   dtw_deg: aligned_angle_deg of x and a. cycle_deg: the same of a and there and back again (EvalOptions::
///     style_back). cycle_share: that over dtw_deg
///   jerk_ratio, stance_slide_ratio: of x at the source's tempo over a's; cycle_ratio, flight_ratio: of x
///     over a's; and what style_figures() has
/// Of real clips of the wanted style the shares as real_style_share, real_coordination_share, real_content.
class StyleEvaluation {
 public:
  /// Throws Error where the judge or a style cannot be loaded.
  explicit StyleEvaluation(const EvalOptions& options);
  ~StyleEvaluation();
  void evaluate(const Case& c, CaseResult& result);
  /// {"figures": {KEY: {"mean", "low", "high"}}, the 95 % interval by subject (by case where nobody is
  /// named); "medians": {KEY: {"source", "styled", "real", "real_low", "real_high"}} over subjects'
  /// medians}; null before the first case.
  Json summary() const;

 private:
  struct Record {
    std::string subject;
    Metrics figures;
  };
  enum Kind { Source, Styled, Real };
  StyledClip read(const Case& c) const;
  StyledClip styled(const Case& c, const StyledClip& clip);
  void judge_source(const Case& c, const StyledClip& source, const StyledClip& styled, Metrics& figures);
  void judge_real(const Case& c, const StyledClip& clip, Metrics& figures);
  StyledClip noised(const StyledClip& clip);
  const ChannelStatistics& statistics(const std::string& manner);

  const EvalOptions& options_;
  Networks networks_;
  std::shared_ptr<MotionStyle> back_;
  std::unique_ptr<StyleJudge> judge_;
  std::vector<std::string> real_;  // folders of real cases
  size_t noises_ = 0;
  std::map<std::string, ChannelStatistics> statistics_;
  std::map<Kind, std::vector<Record>> records_;
};

}  // namespace understudy::app
