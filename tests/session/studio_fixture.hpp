// A studio with stand-ins for the networks, and files for it: no LibTorch, no window.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <set>

#include "app/session/studio.hpp"

namespace understudy::app {

namespace fs = std::filesystem;

/// A vertex follows the nearest joint.
class NearestDeformer : public Deformer {
 public:
  void bind(const Points& rest, const Joints& joints) override;
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override;
  Points deform(const Pose& pose) const override;
  Points offsets(const Pose& pose) const override;
  std::string name() const override { return "nearest"; }

 private:
  Points rest_;
  Joints joints_ = Joints::Zero();
  RowMatrix weights_;
};

/// The smooth curve, but higher where nothing was known.
class LiftedSpace final : public MotionSpace {
 public:
  static constexpr float kLift_m = 0.1f, kAlternativeLift_m = 0.02f;

  Completion complete(const KnownMotion& question) override;
  std::string name() const override { return "lifted"; }
  int variations() const override { return kMostVariations; }
};

/// The same poses to the last bit.
bool same_poses(const Motion& a, const Motion& b);

/// Each test works in a folder of its own, with a dance of kFrames scans and a target in it.
class StudioTest : public ::testing::Test {
 protected:
  static constexpr int kFrames = 24;

  void SetUp() override;
  void TearDown() override;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Stand-ins for the networks; the extractor counts in extractions_ how many frames it saw.
  StudioServices services();

  /// A folder with the dance's scans as files, but for some frames.
  std::string folder_without(const std::set<int>& missing, const std::string& name = "gaps");

  /// The dance, performed by the target.
  void open_both(Studio& studio);
  /// A walk of several steps, five seconds of it, performed by the target.
  void open_walk(Studio& studio);

  fs::path folder_, before_;
  std::shared_ptr<std::atomic<int>> extractions_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace understudy::app
