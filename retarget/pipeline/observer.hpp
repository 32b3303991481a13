// The first half of the way of a frame: what is seen of one person in a stream, frame after frame.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/observation.hpp"
#include "retarget/pipeline/person_check.hpp"

namespace understudy {

/// Tells its extractor what was seen just before: the joints of the last two frames that are believed
/// (refusal()), unless more than a quarter of a second has passed since. The network learned from frames one
/// thirtieth of a second apart, and wrong pasts only as the exception.
///
/// Looks only back, memory is constant. One thread at a time.
class Observer {
 public:
  /// Without an extractor it takes given skeletons alone.
  explicit Observer(std::shared_ptr<SkeletonExtractor> extractor = nullptr);
  /// Forgets the past.
  void restart();

  /// A scan, dt seconds after the frame before. What cannot be used has a `problem`. Throws Error without an
  /// extractor.
  Observation observe(const Mesh& scan, float dt);
  /// A skeleton known beforehand, as if it had been extracted from this scan.
  Observation observe(const Extraction& given, const Mesh& scan, float dt);
  /// A skeleton that comes without a scan.
  Observation observe(const Extraction& given, float dt);
  /// A frame in which there is nothing to look at.
  Observation skip(std::string problem, float dt);

 private:
  void pass(float dt);

  std::shared_ptr<SkeletonExtractor> extractor_;
  RecentJoints recent_;
  float unseen_s_ = 0;  // since the last of them
  PersonCheck person_;
};

}  // namespace understudy
