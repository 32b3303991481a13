// Whether the skeletons seen in a source may be a person's at all.
#pragma once

#include <string>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// How far bones are from a mean human's of the same size: the root mean square of the logarithms of the
/// lengths' ratios. People of any age, as they are extracted, have 0.03 to 0.2; of cats, dogs and horses 0.2
/// to 0.7 comes out.
float bone_implausibility(const Joints& joints);

/// Looks at what is extracted from a source, frame after frame.
class PersonCheck {
 public:
  /// A sentence, once, when the first frames have bones that are no person's: an animal, or a person whom the
  /// extraction does not see, as some who crawl. Else empty. Skeletons that are given are not doubted.
  std::string push(const Extraction& seen);

 private:
  int frames_ = 0, implausible_ = 0;
  bool told_ = false;
};

}  // namespace understudy
