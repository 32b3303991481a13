// Sparse captures of a person who is known: what the fit makes of them.
#include "retarget/motion_space/person_fitter.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/marker_places.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/sparse_looks.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

constexpr int kFrames = 31;  // a second of walking

/// The built-in person, 12 % taller, with longer arms, who walks.
struct Walker {
  Walker() {
    Eigen::VectorXf shape = Eigen::VectorXf::Zero(builtin_person_model()->parameters());
    shape[0] = 0.12f, shape[7] = 0.05f;
    body = builtin_person_model()->body(shape, {});
    motion = builtin_motion("walk", body.joints);
    motion.poses.erase(motion.poses.begin(), motion.poses.begin() + 20);
    motion.poses.resize(kFrames);
  }
  PosedSkeleton truth(int t) const { return forward_kinematics(body.joints, motion.poses[t]); }
  Points points(int t, int count) const {
    Rng rng(static_cast<uint64_t>(t) + 5);
    return sample_points(Mesh{posed_vertices(body, motion.poses[t]), body.faces}, count, rng);
  }
  /// Every so many-th frame.
  SparseCapture capture(int points_each, int every, bool with_markers = false) const {
    SparseCapture result;
    const std::vector<int> marked = marker_vertices(body.vertices, body.joints);
    for (int t = 0; t < kFrames; t += every) {
      SparseFrame& frame = result.frames.emplace_back();
      frame.seconds = 7 + t / 30.0;
      if (points_each > 0) frame.points = points(t, points_each);
      const Points posed = posed_vertices(body, motion.poses[t]);
      for (int m = 0; with_markers && m < kMarkerCount; ++m)
        frame.markers.push_back({kMarkerPlaces[m].name, posed.row(marked[m]).transpose()});
    }
    return result;
  }
  /// Mean error of joints over all frames, metres.
  double error(const CompletedCapture& made) const {
    double sum = 0;
    for (int t = 0; t < kFrames; ++t)
      sum +=
          static_cast<double>((forward_kinematics(made.rest, made.motion.poses[t]).joints - truth(t).joints)
                                  .rowwise()
                                  .norm()
                                  .mean());
    return sum / kFrames;
  }

  ShapedBody body;
  Motion motion;
};

const Walker& walker() {
  static const Walker one;
  return one;
}

/// Sees the walker in the frame whose middle is nearest, some centimetres off. `turned`: in a turned world.
class RoughExtractor final : public SkeletonExtractor {
 public:
  explicit RoughExtractor(Mat3 world = Mat3::Identity()) : world_(std::move(world)) {}
  Extraction extract(const Mesh& scan) override {
    const Vec3 middle = world_.transpose() * scan.vertices.colwise().mean().transpose();
    int nearest = 0;
    float least = 1e9f;
    for (int t = 0; t < kFrames; ++t) {
      const float off = (walker().truth(t).joints.colwise().mean() - middle.transpose()).norm();
      if (off < least) least = off, nearest = t;
    }
    const PosedSkeleton truth = walker().truth(nearest);
    Extraction seen;
    Rng rng(static_cast<uint64_t>(nearest));
    seen.global.emplace();
    for (int j = 0; j < kJointCount; ++j) {
      const Vec3 off(0.03f * rng.normal(), 0.03f * rng.normal(), 0.03f * rng.normal());
      const Vec3 turn(0.1f * rng.normal(), 0.1f * rng.normal(), 0.1f * rng.normal());
      seen.joints.row(j) = (world_ * (truth.joints.row(j).transpose() + off)).transpose();
      (*seen.global)[j] = world_ * rotation_from_axis_angle(turn) * truth.global[j];
      seen.confidence[j] = confidence_for(0.05f);
    }
    return seen;
  }
  std::string name() const override { return "rough"; }

 private:
  Mat3 world_;
};

CompletedCapture completed(const SparseCapture& capture, const Mat3& world = Mat3::Identity()) {
  return PersonFitter(std::make_shared<RoughExtractor>(world)).complete(capture, {});
}

TEST(PersonFitter, PutsTheBodyWhereManyPointsAre) {
  const CompletedCapture made = completed(walker().capture(400, 6));
  EXPECT_LT(walker().error(made), 0.02);
  EXPECT_NEAR(leg_length(made.rest), leg_length(walker().body.joints), 0.02);
}

TEST(PersonFitter, LearnsFromAllFramesWhatFewPointsOfOneDoNotTell) {
  const CompletedCapture made = completed(walker().capture(60, 3));
  EXPECT_LT(walker().error(made), 0.03);
  EXPECT_EQ(ssize(made.motion.poses), kFrames);
}

TEST(PersonFitter, MakesAsManyFramesAsAreWanted) {
  SparseCapture capture = walker().capture(200, 10);
  capture.fps = 60;
  const CompletedCapture made = completed(capture);
  ASSERT_EQ(ssize(made.motion.poses), 61);
  EXPECT_EQ(made.motion.fps, 60);
  EXPECT_EQ(std::count(made.is_made.begin(), made.is_made.end(), false), 4);
  EXPECT_FALSE(made.is_made[0]);
  EXPECT_FALSE(made.is_made[20]);
}

TEST(PersonFitter, DoubtsWhatLiesFarFromAnyScanMore) {
  const CompletedCapture made = completed(walker().capture(200, 10));
  EXPECT_GT(made.doubt_m[5], made.doubt_m[0]);
  for (const float doubt : made.doubt_m) EXPECT_GT(doubt, 0);
}

TEST(PersonFitter, FollowsMarkersWithoutAnyPoint) {
  const CompletedCapture made =
      PersonFitter(nullptr).complete(walker().capture(0, 5, /*with_markers=*/true), {});
  EXPECT_LT(walker().error(made), 0.06);
}

TEST(PersonFitter, IsBetterWithMarkersAmongFewPoints) {
  const CompletedCapture without = completed(walker().capture(40, 10)),
                         with = completed(walker().capture(40, 10, /*with_markers=*/true));
  EXPECT_LT(walker().error(with), walker().error(without));
}

TEST(PersonFitter, GivesTheSameTwice) {
  const SparseCapture capture = walker().capture(80, 15);
  const CompletedCapture once = completed(capture), again = completed(capture);
  for (size_t t = 0; t < once.motion.poses.size(); ++t) {
    EXPECT_EQ(once.motion.poses[t].root, again.motion.poses[t].root);
    EXPECT_EQ(once.motion.poses[t].local, again.motion.poses[t].local);
  }
  EXPECT_EQ(once.vertices, again.vertices);
}

TEST(PersonFitter, TurnsWithTheCapture) {
  const SparseCapture straight = walker().capture(200, 10);
  const Mat3 turn = rotation_about_y(1.1f);
  SparseCapture turned = straight;
  for (SparseFrame& frame : turned.frames) frame.points = frame.points * turn.transpose();
  const CompletedCapture a = completed(straight), b = completed(turned, turn);
  for (size_t t = 0; t < a.motion.poses.size(); t += 7) {
    const Joints joints = forward_kinematics(a.rest, a.motion.poses[t]).joints * turn.transpose();
    EXPECT_LT((joints - forward_kinematics(b.rest, b.motion.poses[t]).joints).rowwise().norm().maxCoeff(),
              0.002f);
  }
}

TEST(PersonFitter, TellsProgressAndStopsWhenItIsTold) {
  float last = -1;
  PersonFitter fitter(std::make_shared<RoughExtractor>());
  const SparseCapture capture = walker().capture(80, 10);
  fitter.complete(capture, [&](float share) {
    EXPECT_GE(share, last);
    last = share;
  });
  EXPECT_EQ(last, 1);
  EXPECT_THROW(fitter.complete(capture, [](float share) { US_CHECK(share < 0.3f, "stopped"); }), Error);
}

std::string refusal_of(const SparseCapture& capture) {
  return failure_of([&] { completed(capture); });
}

TEST(PersonFitter, RefusesTimesThatAreNone) {
  SparseCapture capture = walker().capture(80, 10);
  capture.frames[1].seconds = capture.frames[0].seconds;
  EXPECT_EQ(refusal_of(capture), "frame 1 of 4: is not after the frame before it");
  capture.frames[1].seconds = capture.frames[0].seconds - 1;
  EXPECT_EQ(refusal_of(capture), "frame 1 of 4: is not after the frame before it");
  capture.frames[1].seconds = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal_of(capture), "frame 1 of 4: its time is not finite");
  capture.frames[1].seconds = capture.frames[0].seconds + 3600;
  EXPECT_EQ(refusal_of(capture), "frame 1 of 4: is an hour or more after the frame before it");
}

TEST(PersonFitter, RefusesWhatTellsTooLittle) {
  SparseCapture capture = walker().capture(80, 10);
  capture.frames[2].points = walker().points(0, 9);
  EXPECT_EQ(refusal_of(capture), "frame 2 of 4: has 9 points and no markers; ten points are the fewest");
  capture.frames[2].markers = {{"left_knee", Vec3::Zero()}, {"left_hip", Vec3::Zero()}};
  EXPECT_EQ(refusal_of(capture), "frame 2 of 4: has 2 markers and 9 points; three markers are the fewest");
  capture.frames.resize(1);
  EXPECT_EQ(refusal_of(capture), "one frame alone cannot be completed: a motion is between two at least");
}

TEST(PersonFitter, RefusesMarkersOfNoPlace) {
  SparseCapture capture = walker().capture(80, 10);
  capture.frames[0].markers = {{"tail", Vec3::Zero()}};
  EXPECT_EQ(refusal_of(capture), "frame 0 of 4: there is no marker 'tail'");
}

TEST(SparseLooks, FilledPointsLieBetweenPoints) {
  const Points few = walker().points(0, 60), filled = filled_between(few, 1024, 0);
  ASSERT_EQ(filled.rows(), 1024);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(filled.col(axis).minCoeff(), few.col(axis).minCoeff() - 1e-5f);
    EXPECT_LE(filled.col(axis).maxCoeff(), few.col(axis).maxCoeff() + 1e-5f);
  }
}

TEST(PersonModel, SwellsAlikeOnBothSidesAndKeepsItsJoints) {
  const PersonModel& model = *builtin_person_model();
  Eigen::VectorXf shape = Eigen::VectorXf::Zero(model.parameters());
  shape[model.parameters() - 1] = 1;  // girth
  const ShapedBody heavy = model.body(shape, {});
  EXPECT_EQ(heavy.joints, model.whole.joints);
  const float wide = heavy.vertices.col(2).maxCoeff() - heavy.vertices.col(2).minCoeff(),
              usual = model.whole.vertices.col(2).maxCoeff() - model.whole.vertices.col(2).minCoeff();
  EXPECT_GT(wide, usual + 0.02f);
}

TEST(BandedBlocks, SolveWhatTheyMultiply) {
  constexpr int kCount = 5, kSize = 3;
  BandedBlocks blocks(kCount, kSize);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(kCount * kSize, kCount * kSize);
  for (int t = 0; t < kCount; ++t) {
    blocks.own[t] << 9, 1, 0, 1, 8, 2, 0, 2, 7;
    whole.block<kSize, kSize>(t * kSize, t * kSize) = blocks.own[t];
    for (int i = 0; i < kSize; ++i) {
      blocks.next[t][i] = -1 - 0.1 * i, blocks.second[t][i] = 0.5;
      const int at = t * kSize + i;
      if (t + 1 < kCount) whole(at + kSize, at) = whole(at, at + kSize) = -1 - 0.1 * i;
      if (t + 2 < kCount) whole(at + 2 * kSize, at) = whole(at, at + 2 * kSize) = 0.5;
    }
  }
  const Eigen::MatrixXd x = Eigen::MatrixXd::Random(kCount * kSize, 2);
  Eigen::MatrixXd right = whole * x;
  ASSERT_TRUE(blocks.factor());
  blocks.solve(right);
  EXPECT_LT((right - x).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace understudy
