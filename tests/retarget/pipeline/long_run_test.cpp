// Ten thousand frames: what is true of the first is true of the last.
#include <gtest/gtest.h>
#include <malloc.h>

#include <map>
#include <string>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/metrics/joint_metrics.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;
constexpr size_t kFrames = 10000;

/// A clip again and again, true joints only, through the whole pipeline. Each round goes on where the last
/// one ended.
struct LongRun {
  Joints source = builtin_joints(), rest;
  ShapedBody target;
  Motion clip;
  size_t round;  // frames
  Vec3 step;     // of a round
  JointSequence seen, done;
  size_t bytes_early = 0, bytes_late = 0;

  explicit LongRun(const char* name) : clip(builtin_motion(name, source)), round(clip.poses.size()) {
    PersonOptions heavy;
    heavy.girth = 1.5f;
    heavy.stature = 1.55f;
    target = builtin_person(heavy);
    rest = target.joints;
    step = clip.poses.back().root - clip.poses.front().root;
    step.y() = 0;
    step *= static_cast<float>(round) / static_cast<float>(round - 1);
    Networks networks;
    networks.transfer = std::make_unique<CopyTransfer>();
    networks.deformer = std::make_unique<RigidDeformer>(target.weights);
    RetargetOptions options;
    options.vertices = false;
    Retargeter retargeter(std::move(networks), options);
    retargeter.set_target(prepare_target(Mesh{target.vertices, target.faces}, rest));
    seen.reserve(kFrames), done.reserve(kFrames);
    for (size_t t = 0; t < kFrames; ++t) {
      Pose pose = clip.poses[t % round];
      pose.root += static_cast<float>(t / round) * step;
      seen.push_back(forward_kinematics(source, pose).joints);
      done.push_back(retargeter.push(fixtures::seen(seen.back()), 1 / 30.0f).joints);
      if (t == 1000) bytes_early = mallinfo2().uordblks;
    }
    bytes_late = mallinfo2().uordblks;
  }
  /// A round's frames, moved back to where the first round was.
  JointSequence played(size_t k) const {
    JointSequence result(done.begin() + static_cast<long>(k * round),
                         done.begin() + static_cast<long>((k + 1) * round));
    const Eigen::RowVector3f start = result.front().row(Pelvis);
    for (Joints& joints : result) joints.rowwise() -= Eigen::RowVector3f(start.x(), 0, start.z());
    return result;
  }
  size_t last() const { return kFrames / round - 1; }
  double bounce(const JointSequence& joints) const {
    const JointSequence still(joints.size(), Joints::Zero());
    return acceleration_error(joints, still, 30);
  }
};

const LongRun& long_run(const std::string& name) {
  static std::map<std::string, LongRun> runs;
  return runs.try_emplace(name, name.c_str()).first->second;
}

class LongRuns : public testing::TestWithParam<const char*> {};

TEST_P(LongRuns, EndAsTheyBegan) {
  const LongRun& run = long_run(GetParam());
  const JointSequence early = run.played(5), late = run.played(run.last());
  EXPECT_LT(mean_joint_error(early, late), 1e-3);
  EXPECT_NEAR(run.bounce(early), run.bounce(late), 0.01 * run.bounce(early));
  float deepest_early = 1, deepest_late = 1;
  for (size_t t = 0; t < early.size(); ++t)
    for (const int j : {LeftFoot, RightFoot}) {
      deepest_early = std::min(deepest_early, early[t](j, 1));
      deepest_late = std::min(deepest_late, late[t](j, 1));
    }
  EXPECT_NEAR(deepest_early, deepest_late, 1e-3f);
  const auto wanted = bone_lengths(run.rest);
  for (const size_t t : {size_t{0}, kFrames / 2, kFrames - 1})
    EXPECT_LT((bone_lengths(run.done[t]) - wanted).abs().maxCoeff(), 2e-4f) << t;
}

TEST_P(LongRuns, GoAsFarAsTheSourceTimesTheLegs) {
  const LongRun& run = long_run(GetParam());
  const float scale = leg_length(run.rest) / leg_length(run.source);
  const auto way = [&](const JointSequence& joints) {
    return Vec3((joints[run.last() * run.round].row(Pelvis) - joints[5 * run.round].row(Pelvis)).transpose());
  };
  const Vec3 wanted = scale * way(run.seen), gone = way(run.done);
  EXPECT_NEAR(gone.x(), wanted.x(), 0.005f * wanted.norm() + 0.005f);
  EXPECT_NEAR(gone.z(), wanted.z(), 0.005f * wanted.norm() + 0.005f);
}

TEST_P(LongRuns, MemoryDoesNotGrow) {
  const LongRun& run = long_run(GetParam());
  EXPECT_LE(run.bytes_late, run.bytes_early + 16384);
}

INSTANTIATE_TEST_SUITE_P(, LongRuns, testing::Values("walk", "dance"));

}  // namespace
}  // namespace understudy
