// Binding by shape: robots, big heads, skirts, and what is left alone.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "retarget/character/careful_deformer.hpp"
#include "retarget/character/geometric_binding.hpp"
#include "retarget/character/rest_pose.hpp"
#include "retarget/character/stance.hpp"
#include "retarget/character/voxel_body.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/root_path.hpp"
#include "retarget/skeleton/skinning.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy {
namespace {

constexpr float kLeg = 0.85f;

Joints standing_joints() {
  Joints joints = human_rest() * kLeg;
  joints.col(1).array() += 1.15f * kLeg;
  return joints;
}

void append(Mesh& mesh, const Mesh& more) {
  const auto before = static_cast<int>(mesh.vertices.rows());
  Points vertices(before + more.vertices.rows(), 3);
  vertices << mesh.vertices, more.vertices;
  Faces faces(mesh.faces.rows() + more.faces.rows(), 3);
  faces << mesh.faces, (more.faces.array() + before).matrix();
  mesh.vertices = vertices;
  mesh.faces = faces;
}

/// A closed tube about the way from a to b, rings of 12; radius of each ring by its share of the way.
template <class Radius>
Mesh tube(const Vec3& a, const Vec3& b, const Radius& radius, int rings, bool closed = true) {
  constexpr int kSides = 12;
  const Vec3 axis = (b - a).normalized();
  const Vec3 u = axis.unitOrthogonal(), w = axis.cross(u);
  Mesh mesh;
  mesh.vertices.resize(rings * kSides + 2, 3);
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < kSides; ++s) {
      const float t = static_cast<float>(r) / static_cast<float>(rings - 1),
                  angle = 2 * kPi * (0.5f + s) / kSides;
      mesh.vertices.row(r * kSides + s) =
          (a + t * (b - a) + radius(t) * (std::cos(angle) * u + std::sin(angle) * w)).transpose();
    }
  mesh.vertices.row(rings * kSides) = a.transpose();
  mesh.vertices.row(rings * kSides + 1) = b.transpose();
  std::vector<std::array<int, 3>> faces;
  for (int r = 0; r + 1 < rings; ++r)
    for (int s = 0; s < kSides; ++s) {
      const int p = r * kSides + s, q = r * kSides + (s + 1) % kSides;
      faces.push_back({p, q, p + kSides});
      faces.push_back({q, q + kSides, p + kSides});
    }
  for (int s = 0; s < kSides; ++s) {
    faces.push_back({rings * kSides, (s + 1) % kSides, s});
    if (closed)
      faces.push_back(
          {rings * kSides + 1, (rings - 1) * kSides + s, (rings - 1) * kSides + (s + 1) % kSides});
  }
  mesh.faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (size_t f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c)
      mesh.faces(static_cast<Eigen::Index>(f), c) = faces[f][static_cast<size_t>(c)];
  return mesh;
}

/// A piece along a bone that leaves a gap at both ends.
Mesh piece(const Joints& joints, int from, int to, float thick) {
  const Vec3 a = joints.row(from).transpose(), b = joints.row(to).transpose();
  return tube(
      a + 0.1f * (b - a), a + 0.9f * (b - a), [&](float) { return thick; }, 4);
}

/// Hard parts that do not touch.
Mesh robot(const Joints& j) {
  Mesh mesh;
  const auto at = [&](int joint) -> Vec3 { return j.row(joint).transpose(); };
  append(mesh, tube(
                   at(Pelvis), at(Spine3) + Vec3(0, 0.15f, 0), [](float) { return 0.15f; }, 6));
  append(mesh, tube(
                   at(Head), at(Head) + Vec3(0, 0.2f, 0), [](float) { return 0.1f; }, 4));
  for (const int right : {0, 1}) {
    append(mesh, piece(j, LeftHip + right, LeftKnee + right, 0.06f));
    append(mesh, piece(j, LeftKnee + right, LeftAnkle + right, 0.05f));
    append(mesh, piece(j, LeftShoulder + right, LeftElbow + right, 0.04f));
    append(mesh, piece(j, LeftElbow + right, LeftWrist + right, 0.04f));
  }
  return mesh;
}

Pose dancing() {
  Pose pose;
  pose.root = Vec3(0, 1, 0);
  for (size_t j = 1; j < kJointCount; ++j)
    pose.local[j] = Eigen::AngleAxisf(0.5f, Vec3(j % 3 == 0, j % 3 == 1, j % 3 == 2)).toRotationMatrix();
  return pose;
}

/// Largest factor by which an edge grows or shrinks.
float largest_stretch(const Mesh& rest, const Points& posed) {
  float most = 1;
  for (Eigen::Index f = 0; f < rest.faces.rows(); ++f)
    for (int c = 0; c < 3; ++c) {
      const int a = rest.faces(f, c), b = rest.faces(f, (c + 1) % 3);
      const float before = (rest.vertices.row(a) - rest.vertices.row(b)).norm();
      const float after = (posed.row(a) - posed.row(b)).norm();
      most = std::max(most, std::max(after / before, before / std::max(after, 1e-9f)));
    }
  return most;
}

Points posed_by(const Mesh& mesh, const RowMatrix& weights, const Joints& joints, const Pose& pose) {
  return linear_blend_skinning(mesh.vertices, weights, joints, forward_kinematics(joints, pose));
}

/// Head, neck and trunk in one surface, from the crown down; the head's radius decides.
Mesh bust(const Joints& j, float head) {
  const Vec3 crown = j.row(Head).transpose() + Vec3(0, 2 * head - 0.05f, 0),
             bottom = j.row(Pelvis).transpose();
  const float tall = (crown - bottom).norm();
  return tube(
      crown, bottom,
      [&](float t) {
        const float down = t * tall;
        if (down < 2 * head)
          return std::max(0.05f, std::sqrt(std::max(0.0f, head * head - (down - head) * (down - head))));
        return std::min(0.17f, 0.05f + 0.8f * std::max(0.0f, down - 2 * head - 0.04f));
      },
      90);
}

Mesh skirted(const Joints& j) {
  const Vec3 waist(0, j(Spine1, 1), 0), hem(0, j(LeftKnee, 1), 0);
  Mesh mesh = tube(
      waist, hem, [](float t) { return 0.14f + 0.16f * t; }, 24, false);
  for (const int right : {0, 1}) append(mesh, piece(j, LeftHip + right, LeftAnkle + right, 0.05f));
  return mesh;
}

/// Binds by the weights that it is given.
class FixedDeformer final : public Deformer {
 public:
  explicit FixedDeformer(RowMatrix weights) : weights_(std::move(weights)) {}
  void bind(const Points& rest, const Joints& joints) override { rest_ = rest, joints_ = joints; }
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override {
    auto other = std::make_shared<FixedDeformer>(*this);
    other->weights_ = std::move(weights);
    return other;
  }
  Points deform(const Pose& pose) const override {
    return linear_blend_skinning(rest_ + offsets(pose), weights_, joints_, forward_kinematics(joints_, pose));
  }
  Points offsets(const Pose&) const override { return Points::Constant(rest_.rows(), 3, 0.01f); }
  std::string name() const override { return "fixed"; }

 private:
  RowMatrix weights_;
  Points rest_;
  Joints joints_ = Joints::Zero();
};

}  // namespace

TEST(VoxelBody, WaysGoThroughTheSolidNotThroughTheAir) {
  Mesh u;  // two posts on a beam
  append(u, tube(
                Vec3(-0.3f, 0, 0), Vec3(-0.3f, 1, 0), [](float) { return 0.08f; }, 3));
  append(u, tube(
                Vec3(0.3f, 0, 0), Vec3(0.3f, 1, 0), [](float) { return 0.08f; }, 3));
  append(u, tube(
                Vec3(-0.35f, 0.05f, 0), Vec3(0.35f, 0.05f, 0), [](float) { return 0.08f; }, 3));
  for (const bool cloud : {false, true}) {
    Mesh mesh = u;
    if (cloud) {
      Rng rng(3);
      mesh.vertices = sample_points(u, 4000, rng);
      mesh.faces.resize(0, 3);
    }
    const VoxelBody body(mesh, 64);
    const Vec3 left(-0.3f, 0.95f, 0), right(0.3f, 0.95f, 0);
    const auto distances = body.distances_from({{left, left}});
    EXPECT_GT(body.at(distances, right), 1.8f) << "cloud " << cloud;
    EXPECT_LT(body.at(distances, right), 3.0f) << "cloud " << cloud;
    EXPECT_LT(body.at(distances, Vec3(-0.3f, 0.5f, 0)), 0.6f);
  }
}

TEST(VoxelBody, PartsThatDoNotTouchAreJoinedAtTheirNearest) {
  Mesh two;
  append(two, tube(
                  Vec3(0, 0, 0), Vec3(0, 0.4f, 0), [](float) { return 0.1f; }, 3));
  append(two, tube(
                  Vec3(0, 0.5f, 0), Vec3(0, 1, 0), [](float) { return 0.1f; }, 3));
  const VoxelBody body(two, 64);
  const auto distances = body.distances_from({{Vec3(0, 0.1f, 0), Vec3(0, 0.1f, 0)}});
  EXPECT_NEAR(body.at(distances, Vec3(0, 0.9f, 0)), 0.8f, 0.12f);
}

TEST(GeometricBinding, ARobotsPartsStayRigid) {
  const Joints joints = standing_joints();
  const Mesh mesh = robot(joints);
  RowMatrix weights = tests::shape_weights(mesh, joints);
  ASSERT_TRUE(weights.rowwise().sum().isApproxToConstant(1, 1e-4f));
  EXPECT_GT(largest_stretch(mesh, posed_by(mesh, weights, joints, dancing())), 1.01f);
  const auto rigid = keep_parts_rigid(mesh, kLeg, weights);
  EXPECT_EQ(std::count(rigid.begin(), rigid.end(), true), mesh.vertices.rows());
  EXPECT_LT(largest_stretch(mesh, posed_by(mesh, weights, joints, dancing())), 1.0005f);
  // Each follows the bone it lies along: the first left shin vertex the knee.
  Eigen::Index shin = 0, joint = 0;
  const Eigen::RowVector3f middle = 0.5f * (joints.row(LeftKnee) + joints.row(LeftAnkle));
  (mesh.vertices.rowwise() - middle).rowwise().squaredNorm().minCoeff(&shin);
  weights.row(shin).maxCoeff(&joint);
  EXPECT_EQ(joint, LeftKnee);
}

TEST(GeometricBinding, ALimbThatSpansJointsIsNotRigidAButtonIs) {
  const Joints joints = standing_joints();
  Mesh mesh = tube(
      joints.row(LeftShoulder).transpose(), joints.row(LeftWrist).transpose(), [](float) { return 0.04f; },
      20);
  append(mesh, bust(joints, 0.1f));
  const auto before = static_cast<size_t>(mesh.vertices.rows());
  append(mesh, tube(
                   Vec3(0, 1.2f, 0.17f), Vec3(0, 1.2f, 0.18f), [](float) { return 0.01f; }, 2));
  RowMatrix weights = tests::shape_weights(mesh, joints);
  const auto rigid = keep_parts_rigid(mesh, kLeg, weights);
  EXPECT_FALSE(rigid[0]);
  EXPECT_TRUE(rigid[before]);
}

TEST(GeometricBinding, ABigHeadIsRigidAUsualOneIsLeftAlone) {
  const Joints joints = standing_joints();
  const Mesh child = bust(joints, 0.26f);
  const Eigen::VectorXf share = big_head(child, joints);
  const float chin = joints(Head, 1) - 0.05f;
  for (Eigen::Index v = 0; v < share.size(); ++v) {
    if (child.vertices(v, 1) > chin + 0.06f) EXPECT_GT(share[v], 0.99f) << v;
    if (child.vertices(v, 1) < chin - 0.2f) EXPECT_LT(share[v], 0.01f) << v;
  }
  EXPECT_EQ(big_head(bust(joints, 0.11f), joints).maxCoeff(), 0);
}

TEST(GeometricBinding, TheNeckOfABigHeadIsSeenWhateverTheJointsSay) {
  Joints joints = standing_joints();
  const Mesh child = bust(joints, 0.26f);
  const float chin = joints(Head, 1) - 0.05f;
  for (const float too_high : {0.0f, 0.2f}) {
    joints(Neck, 1) += too_high;
    joints(Head, 1) += too_high;
    const auto neck = neck_under_big_head(child, joints);
    ASSERT_TRUE(neck);
    EXPECT_NEAR(neck->y(), chin - 0.03f, 0.04f);
  }
  EXPECT_FALSE(neck_under_big_head(bust(standing_joints(), 0.11f), standing_joints()));
}

/// A coat so puffy that the gaps between arms and trunk close.
Mesh puffy_coat(const Joints& j) {
  const auto at = [&](int joint) -> Vec3 { return j.row(joint).transpose(); };
  Mesh mesh = tube(
      at(Neck), at(Pelvis) - Vec3(0, 0.15f, 0), [](float t) { return 0.07f + 0.17f * std::sqrt(t); }, 30);
  for (const int right : {0, 1})
    append(mesh, tube(
                     at(LeftShoulder + right), at(LeftWrist + right), [](float) { return 0.1f; }, 30));
  return mesh;
}

TEST(GeometricBinding, APuffyCoatsArmsStayTheArmsAndDoNotTear) {
  Joints joints = standing_joints();  // arms hang down, 25 degrees from the trunk
  for (const int right : {0, 1}) {
    const float side = right == 1 ? -1.0f : 1.0f;
    const Vec3 down = Vec3(side * std::sin(0.44f), -std::cos(0.44f), 0);
    for (const int j : {LeftElbow + right, LeftWrist + right}) {
      const float length = (standing_joints().row(j) - standing_joints().row(j - 2)).norm();
      joints.row(j) = joints.row(j - 2) + length * down.transpose();
    }
  }
  const Mesh coat = puffy_coat(joints);
  const RowMatrix weights = tests::shape_weights(coat, joints);
  ASSERT_TRUE(weights.rowwise().sum().isApproxToConstant(1, 1e-4f));
  for (Eigen::Index v = 30 * 12 + 2; v < coat.vertices.rows(); ++v) {
    const bool left = coat.vertices(v, 0) > 0;
    const int other = left ? 1 : 0;
    for (const int j : {LeftCollar, LeftShoulder, LeftElbow, LeftWrist, LeftHip, LeftKnee})
      EXPECT_LT(weights(v, j + other), 0.01f) << v;
    // From the elbow on nothing belongs to the trunk that it touches.
    if (coat.vertices(v, 1) > joints(LeftElbow, 1)) continue;
    for (const int j : {Pelvis, Spine1, Spine2, Spine3}) EXPECT_LT(weights(v, j), 0.35f) << v;
  }
  const RestPose pose = to_t_pose(joints);
  // Cloth is pushed together over a raised shoulder; an edge torn off the trunk grows some twenty times.
  EXPECT_LT(largest_stretch(coat, in_t_pose(coat.vertices, weights, pose)), 8);
}

TEST(GeometricBinding, ASkirtFollowsPelvisAndThighsWithoutTearing) {
  const Joints joints = standing_joints();
  const Mesh mesh = skirted(joints);
  const auto skirt = find_skirt(mesh, joints);
  ASSERT_TRUE(skirt);
  EXPECT_NEAR(skirt->hem, joints(LeftKnee, 1), 0.06f);
  const RowMatrix weights = tests::shape_weights(mesh, joints);
  const Eigen::Index cloth = 24 * 12;
  for (Eigen::Index v = 0; v < cloth; ++v)
    EXPECT_LT(weights(v, LeftKnee) + weights(v, RightKnee) + weights(v, LeftAnkle), 0.02f) << v;
  const Mesh& cloth_only = mesh;  // its faces come first
  Pose stride;
  stride.local[LeftHip] = Eigen::AngleAxisf(-0.8f, Vec3::UnitX()).toRotationMatrix();
  stride.local[RightHip] = Eigen::AngleAxisf(0.4f, Vec3::UnitX()).toRotationMatrix();
  const Mesh alone{mesh.vertices.topRows(cloth), cloth_only.faces.topRows(2 * 12 * 23), {}};
  EXPECT_LT(largest_stretch(alone, posed_by(alone, weights.topRows(cloth), joints, stride)), 2.2f);
  Mesh trousers;
  for (const int right : {0, 1}) append(trousers, piece(joints, LeftHip + right, LeftAnkle + right, 0.08f));
  EXPECT_FALSE(find_skirt(trousers, joints));
}

/// A skirt's tube, and a ribbon that hangs on it by one end and winds beside it, of `count` faces. They are
/// listed from the far end on: what grows along the list grows by one face a round.
Mesh skirt_with_ribbon(const Joints& j, int count) {
  const Vec3 waist(0, j(Spine1, 1), 0), hem(0, j(LeftKnee, 1), 0);
  Mesh mesh = tube(
      waist, hem, [](float) { return 0.2f; }, 24, false);
  const int steps = count / 2;
  Mesh ribbon;
  ribbon.vertices.resize(2 * steps + 2, 3);
  ribbon.faces.resize(2 * steps, 3);
  for (int i = 0; i <= steps; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(steps), angle = 600 * kPi * share;
    const float y = waist.y() + (0.2f + 0.6f * share) * (hem.y() - waist.y());
    for (const int side : {0, 1})
      ribbon.vertices.row(2 * i + side) << 0.3f + 0.05f * std::cos(angle), y + 0.001f * side,
          0.05f * std::sin(angle);
  }
  for (int i = 0; i < steps; ++i) {
    ribbon.faces.row(2 * (steps - 1 - i)) << 2 * i, 2 * i + 1, 2 * i + 2;
    ribbon.faces.row(2 * (steps - 1 - i) + 1) << 2 * i + 1, 2 * i + 3, 2 * i + 2;
  }
  append(mesh, ribbon);
  mesh.faces(mesh.faces.rows() - 1, 2) = 8 * 12;  // of a ring below the hips
  return mesh;
}

/// In time that grew with the square of the faces this would not end.
TEST(GeometricBinding, ASkirtsClothIsFollowedAlongAMillionFaces) {
  const Joints joints = standing_joints();
  const Mesh mesh = skirt_with_ribbon(joints, 1000000);
  const auto skirt = find_skirt(mesh, joints);
  ASSERT_TRUE(skirt);
  EXPECT_GT(skirt->share.tail(2).minCoeff(), 0.5f);
}

TEST(CarefulDeformer, GoodWeightsStayAndStrayOnesAreReplaced) {
  const Joints joints = standing_joints();
  const Mesh mesh = bust(joints, 0.11f);
  const RowMatrix good = tests::shape_weights(mesh, joints);
  const SafeBinding kept = safe_binding(mesh, joints, good);
  EXPECT_EQ(kept.uncertainty.maxCoeff(), 0);
  EXPECT_TRUE(kept.weights == good);
  EXPECT_EQ(kept.note, "");
  RowMatrix stray = good;
  for (Eigen::Index v = 0; v < 120; ++v) stray.row(v) = Eigen::RowVectorXf::Unit(kJointCount, RightWrist);
  const SafeBinding mended = safe_binding(mesh, joints, stray);
  for (Eigen::Index v = 0; v < 84; ++v) {
    EXPECT_GT(mended.uncertainty[v], 0.95f) << v;
    EXPECT_LT(mended.weights(v, RightWrist), 0.05f) << v;
  }
  EXPECT_TRUE(mended.weights.bottomRows(200) == good.bottomRows(200));
  EXPECT_NE(mended.note.find("head"), std::string::npos) << mended.note;
}

TEST(CarefulDeformer, OffsetsDoNotBendHardParts) {
  const Joints joints = standing_joints();
  const Mesh mesh = robot(joints);
  CarefulDeformer deformer(mesh.faces, std::make_shared<FixedDeformer>(tests::shape_weights(mesh, joints)));
  deformer.bind(mesh.vertices, joints);
  EXPECT_EQ(deformer.offsets(dancing()).cwiseAbs().maxCoeff(), 0);
  EXPECT_LT(largest_stretch(mesh, deformer.deform(dancing())), 1.0005f);
  const auto painted =
      deformer.with_weights(Eigen::RowVectorXf::Unit(kJointCount, Head).replicate(mesh.vertices.rows(), 1));
  EXPECT_EQ(painted->weights()(0, Head), 1);
}

TEST(BodyHeading, IsTheDirectionOfSymmetryNearTheGuess) {
  const Joints joints = standing_joints();
  Mesh mesh = robot(joints);
  append(mesh, tube(
                   Vec3(0.2f, 0.03f, 0), Vec3(0.2f, 0.03f, 0.2f), [](float) { return 0.03f; }, 3));
  append(mesh, tube(
                   Vec3(-0.2f, 0.03f, 0), Vec3(-0.2f, 0.03f, 0.2f), [](float) { return 0.03f; }, 3));
  Rng rng(5);
  const Points points = sample_points(mesh, 700, rng) * rotation_about_y(0.7f).transpose();
  EXPECT_NEAR(symmetric_heading(points, 0.2f), 0.7f, 0.06f);
  EXPECT_NEAR(symmetric_heading(points, 0.7f), 0.7f, 0.06f);
}

TEST(RestPose, LegsAreSpreadAsAHumansOnlyWhereTheyAreNot) {
  const Joints joints = standing_joints();
  RestPose as_it_is = to_t_pose(joints, 4);
  spread_legs(as_it_is, 1.5f);
  EXPECT_TRUE(as_it_is.to_rest[LeftHip].isIdentity(1e-6f));
  Joints close = joints;
  for (const int j : {LeftKnee, LeftAnkle, LeftFoot}) close(j, 0) = joints(LeftHip, 0);
  for (const int j : {RightKnee, RightAnkle, RightFoot}) close(j, 0) = joints(RightHip, 0);
  RestPose pose = to_t_pose(close, 6);
  spread_legs(pose, 1.5f);
  EXPECT_NEAR(pose.rest(LeftAnkle, 0) - pose.rest(RightAnkle, 0),
              joints(LeftAnkle, 0) - joints(RightAnkle, 0), 0.01f);
}

TEST(RootPath, APelvisSeenTooHighDoesNotLiftTheFeet) {
  const Joints joints = standing_joints();
  Mesh mesh;
  for (const int right : {0, 1}) append(mesh, piece(joints, LeftHip + right, LeftAnkle + right, 0.06f));
  append(mesh, tube(
                   Vec3(0.18f, 0.05f, -0.05f), Vec3(0.18f, 0.05f, 0.2f), [](float) { return 0.05f; }, 6));
  append(mesh, tube(
                   Vec3(-0.18f, 0.05f, -0.05f), Vec3(-0.18f, 0.05f, 0.2f), [](float) { return 0.05f; }, 6));
  RootPath path;
  path.reset(mesh.vertices, joints);
  const auto support = SupportPoints::from(mesh.vertices, joints);
  Extraction source;
  source.joints = joints;
  source.sole_height = 0.0f;
  float sole = 0;
  for (int frame = 0; frame < 60; ++frame) {
    if (frame == 30) source.joints(Pelvis, 1) += 0.1f;
    Pose pose;
    pose.root = path.push(source, pose.local, 1 / 30.0f);
    const PosedSkeleton posed = forward_kinematics(joints, path.plant(pose, 1 / 30.0f));
    sole = support.lowest(posed) + posed.joints(Pelvis, 1);
    if (frame > 33) EXPECT_LT(std::abs(sole), 0.02f) << frame;
  }
}

}  // namespace understudy
