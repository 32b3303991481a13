// Baselines of performance style: the statistics of single channels, without anything that goes together.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/run/styled_clip.hpp"

namespace understudy::app {

/// Means and spreads of the rotation vectors of all joints but hands and feet, of clips.
class ChannelStatistics {
 public:
  struct Spread {
    Eigen::VectorXf mean, deviation;
  };
  /// Of all clips (.npz, AMASS-format) in a folder. Throws Error where there is none.
  explicit ChannelStatistics(const std::string& folder, const Networks& networks);
  /// The means over clips; of those that show `content`, where there are any.
  Spread of(const std::string& content = "") const;
  bool knows(const std::string& content) const { return by_content_.count(content) > 0; }

 private:
  std::map<std::string, std::vector<Spread>> by_content_;  // "": all
};

/// The clip's channels, less the one mean and over the one deviation, times the other deviation and more the
/// other mean: AdaIN where `from` is the clip's own.
StyledClip with_statistics(StyledClip clip, const ChannelStatistics::Spread& from,
                           const ChannelStatistics::Spread& to);
/// Of one clip.
ChannelStatistics::Spread statistics_of(const StyledClip& clip);

}  // namespace understudy::app
