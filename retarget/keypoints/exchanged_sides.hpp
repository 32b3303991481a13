// Detectors exchange left and right: of arms, of legs, of the face's sides.
#pragma once

#include <array>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// Watches one person. A group of points is put back when its other sides are much nearer to where they are
/// expected; where the two are equally near (one limb before the other), it stays as it was before. After a
/// second, or after as long as sides had been as they were expected, the file is believed: then what we took
/// for right was wrong.
class ExchangedSides {
 public:
  /// Arms with their hands; legs with the feet; eyes and ears.
  static constexpr int kGroups = 3;
  struct Mended {
    FlatPose pose;
    bool any = false;                      ///< something was put back
    std::array<bool, kGroups> believed{};  ///< from here on the file is right: what was expected is not
  };
  /// expected: where the points should be, missing where nobody knows. size: of the person, pixels.
  Mended mend(const FlatPose& seen, const FlatPose& expected, float size, float dt);
  /// Where nothing is expected: of arms, legs and head the one is put back that lies the other way round than
  /// both others, clearly.
  Mended mend_first(const FlatPose& seen, float size) const;
  void reset() { *this = ExchangedSides(); }
  /// The points of a group.
  static bool is_in_group(int point, int group);

 private:
  std::array<bool, kGroups> exchanged_{};
  std::array<float, kGroups> for_s_{}, before_s_{};  // that it is exchanged, that it was not before
};

}  // namespace understudy
