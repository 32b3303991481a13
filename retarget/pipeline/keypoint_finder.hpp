// Keypoints that a network of one kind of body finds in its scans, as the pipeline sees it: abstract, so that
// no user of it needs LibTorch.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Kinds of bodies whose keypoints networks know.
constexpr std::array<const char*, 4> kBodyKinds = {"person", "quadruped", "hand", "arm"};

/// The keypoints of one scan, world, metres.
struct FoundKeypoints {
  Points places{0, 3};           ///< [K, 3]
  std::vector<float> intensity;  ///< [K] 0 .. 1: how much of the body it stands for (paper 3, alpha)
  std::vector<Mat3> turns;       ///< [K] against one pose common to all scans; empty: not told
  std::vector<int> owner;        ///< [V] whose each vertex of the scan is; empty: not told
};
/// Keypoints fainter than this are not drawn, not scored and carry no skin (paper 3, section 5).
constexpr float kLeastIntensity = 0.2f;

/// The same keypoints and the same tree in every sequence of a kind of body, found without labels (paper 3).
/// One thread at a time.
class KeypointFinder {
 public:
  virtual ~KeypointFinder() = default;
  /// Of each scan of one sequence, in the order of time; empty scans repeat the keypoints before them. Throws
  /// Error when no scan has points, and when the answer is not finite.
  virtual std::vector<FoundKeypoints> find(const std::vector<Mesh>& scans) = 0;
  /// [K] of the tree; -1: the root. A parent need not come before its children.
  virtual const std::vector<int>& parents() const = 0;
  /// One of kBodyKinds.
  virtual const std::string& kind() const = 0;
  /// "slots" or "paper".
  virtual std::string name() const = 0;
};

}  // namespace understudy
