#include "app/cli/keypoint_evaluation.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/networks/networks.hpp"

namespace understudy::app {
namespace {

constexpr float kFarAway = 1e6f;  // metres

}  // namespace

RigFinder KeypointEvaluation::finder(const EvalOptions& options, const std::string& kind) {
  Kind& judged = kinds_[kind];
  if (!judged.network)
    judged.network =
        nn::load_keypoint_finder(nn::weights_folder(network_options(options.how)), options.rig_method, kind);
  return [&judged](const std::vector<Mesh>& scans, double fps) {
    judged.keypoints.clear();
    for (const FoundKeypoints& found : judged.network->find(scans)) {
      Points bright = found.places;
      for (Eigen::Index k = 0; k < bright.rows(); ++k)
        if (found.intensity[static_cast<size_t>(k)] < kLeastIntensity)
          bright.row(k).setConstant(kFarAway);  // one that is too faint is near nothing
      judged.keypoints.push_back(bright);
    }
    return rig_finder(judged.network)(scans, fps);
  };
}

void KeypointEvaluation::add(const std::string& kind, const RigTruth& truth) {
  const auto found = kinds_.find(kind);
  if (found == kinds_.end()) return;
  Kind& judged = found->second;
  if (ssize(judged.keypoints) != truth.frames()) return;  // the second one of a pair has another truth
  for (size_t t = 0; t < judged.keypoints.size(); ++t) {
    judged.sc.push(judged.keypoints[t], truth.joints[t]);
    judged.bright += (judged.keypoints[t].col(0).array() < kFarAway).count();
    ++judged.frames;
  }
}

Json KeypointEvaluation::summary() const {
  Json rows;
  for (const auto& [kind, judged] : kinds_)
    if (judged.frames > 0)
      rows[kind] = {{"sc", judged.sc.value()},
                    {"keypoints", judged.network->parents().size()},
                    {"bright", judged.bright / static_cast<double>(judged.frames)},
                    {"frames", judged.frames}};
  return rows;
}

}  // namespace understudy::app
