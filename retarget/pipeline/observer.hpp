// The first stages of a frame: what is seen of one person in a stream, frame after frame.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/observation.hpp"
#include "retarget/pipeline/surface_tracker.hpp"

namespace understudy {

/// How far bones are from a mean human's of the same size: the root mean square of the logarithms of the
/// lengths' ratios. People of any age, as they are extracted, have 0.03 to 0.2; of cats, dogs and horses 0.2
/// to 0.7 comes out.
float bone_implausibility(const Joints& joints);

/// Whether the bones that are seen are no person's, or unlike a person's and seen with little confidence.
bool is_implausible(const Extraction& seen);

/// Looks at what is extracted from a source, frame after frame.
class PersonCheck {
 public:
  /// A sentence, once, when the first frames have bones unlike a human's: an animal, or a person whom the
  /// extraction does not see, as some who crawl. Else empty. Skeletons that are given are not doubted.
  std::string push(const Extraction& seen);

 private:
  int frames_ = 0, implausible_ = 0;
  bool warned_ = false;
};

/// Gives its extractor what was seen just before: the joints of the last two frames that are believed
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
  /// What is seen in a scan before the stream begins. Where that scan is then the first to be observed, it is
  /// not looked at again. Throws Error without an extractor, and where it does.
  Extraction look(const Mesh& scan);
  /// A frame in which there is nothing to look at.
  Observation skip(std::string problem, float dt);

 private:
  void pass(float dt);
  Extraction extracted(const Mesh& scan);

  std::shared_ptr<SkeletonExtractor> extractor_;
  struct Look {
    Points points;
    Extraction seen;
  };
  std::optional<Look> looked_;  // before the first frame
  SurfaceTracker surface_;
  RecentJoints recent_;
  float unseen_s_ = 0;  // since the last of them
  PersonCheck person_;
};

}  // namespace understudy
