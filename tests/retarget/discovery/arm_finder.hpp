// A network's keypoints of the bending arm, as a stand-in sees them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "retarget/pipeline/keypoint_finder.hpp"
#include "tests/retarget/discovery/bending_arm.hpp"

namespace understudy {

/// Sees the middles of both halves of the arm and its tip, a third of a radius off. The upper arm, which is
/// thick from x = 0 to 0.5, stays; how far the rest has turned follows from where its points are.
class ArmFinder final : public KeypointFinder {
 public:
  explicit ArmFinder(bool tells_turns) : tells_turns_(tells_turns) {}
  std::vector<FoundKeypoints> find(const std::vector<Mesh>& scans) override {
    std::vector<FoundKeypoints> all;
    for (const Mesh& scan : scans) {
      Vec3 far = Vec3::Zero();  // the mean of what is a forearm's length from the shoulder and more
      int count = 0;
      for (const auto& p : scan.vertices.rowwise())
        if ((p.transpose() - kElbow).norm() > 0.3f && p.x() > 0.3f) far += p.transpose(), ++count;
      const Vec3 way = (far / static_cast<float>(count) - kElbow).normalized();
      const Mat3 turn = rotation_from_axis_angle({0, 0, std::atan2(way.y(), way.x())});
      FoundKeypoints found;
      found.places.resize(3, 3);
      found.places << 0.25f, 0.02f, 0, (kElbow + 0.15f * way + 0.02f * Vec3::UnitZ()).transpose(),
          (kElbow + 0.4f * way).transpose();
      found.intensity.assign(3, 1);
      if (tells_turns_) found.turns = {Mat3::Identity(), turn, turn};
      if (tells_turns_)
        for (const auto& p : scan.vertices.rowwise()) {
          const float along = (p.transpose() - kElbow).dot(way);
          found.owner.push_back(along < 0 ? 0 : along < 0.28f ? 1 : 2);
        }
      all.push_back(found);
    }
    return all;
  }
  const std::vector<int>& parents() const override { return parents_; }
  const std::string& kind() const override { return kind_; }
  std::string name() const override { return "told"; }

 private:
  bool tells_turns_;
  std::vector<int> parents_ = {-1, 0, 1};
  std::string kind_ = "arm";
};

}  // namespace understudy
