#include "retarget/marionette/keypoint_skin.hpp"

#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr float kFalloff = 8;  // of the square of a distance, where the box reaches from -1 to 1

/// Lines 7 to 9: of each keypoint the nearest above it that is not faint; -1: there is none.
std::vector<int> bright_parents(const FoundKeypoints& keypoints, const std::vector<int>& parents) {
  std::vector<int> bright = parents;
  for (int& parent : bright)
    for (size_t steps = 0; parent >= 0 && keypoints.intensity[static_cast<size_t>(parent)] < kLeastIntensity;
         ++steps) {
      US_CHECK(steps < parents.size(), "the keypoints' parents make no tree");
      parent = parents[static_cast<size_t>(parent)];
    }
  return bright;
}

}  // namespace

SkinWeights skin_of_keypoints(const Points& surface, const FoundKeypoints& keypoints,
                              const std::vector<int>& parents) {
  const Eigen::Index K = keypoints.places.rows();
  US_CHECK(static_cast<size_t>(K) == parents.size() && parents.size() == keypoints.intensity.size(), K,
           " keypoints have ", parents.size(), " parents and ", keypoints.intensity.size(), " intensities");
  US_CHECK(surface.rows() > 0, "a surface without points has no skin");
  for (const int parent : parents) US_CHECK(parent >= -1 && parent < K, "a keypoint has no parent ", parent);
  const std::vector<int> above = bright_parents(keypoints, parents);
  std::vector<int> bones;
  Points middles(K, 3);
  for (int k = 0; k < K; ++k) {
    const int parent = above[static_cast<size_t>(k)];
    middles.row(k) = (keypoints.places.row(k) + keypoints.places.row(parent < 0 ? k : parent)) / 2;
    if (keypoints.intensity[static_cast<size_t>(k)] >= kLeastIntensity) bones.push_back(k);
  }
  US_CHECK(!bones.empty(), "all keypoints are fainter than ", kLeastIntensity);

  const float half = (surface.colwise().maxCoeff() - surface.colwise().minCoeff()).maxCoeff() / 2;
  RowMatrix weights = RowMatrix::Zero(surface.rows(), K);
  for (Eigen::Index v = 0; v < surface.rows(); ++v) {
    const auto far = [&](const Points& places, int k) {
      return (surface.row(v) - places.row(k)).squaredNorm();
    };
    int child = bones.front();
    for (const int k : bones)
      if (far(middles, k) < far(middles, child)) child = k;
    const int parent = above[static_cast<size_t>(child)];
    // Of the two Gaussians the child's share; by their ratio, so that far vertices divide by no zero.
    const float less = parent < 0 ? 0 : far(keypoints.places, child) - far(keypoints.places, parent);
    const float share = 1 / (1 + std::exp(kFalloff * less / std::max(half * half, 1e-12f)));
    weights(v, child) = parent < 0 ? 1 : share;
    if (parent >= 0) weights(v, parent) = 1 - share;
  }
  return SkinWeights::from(weights);
}

}  // namespace understudy
