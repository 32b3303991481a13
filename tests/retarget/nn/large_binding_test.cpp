// Targets of many vertices: what is interpolated between asked points against what is asked everywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/character/careful_deformer.hpp"
#include "retarget/networks/network_deformer.hpp"

namespace understudy {
namespace {

constexpr const char* kWeights = US_SOURCE_DIR "/assets/weights/deformation.weights";

/// Every face cut into four.
Mesh subdivided(const Mesh& mesh) {
  Mesh finer;
  const auto count = mesh.vertices.rows();
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    return middles.try_emplace(std::minmax(a, b), static_cast<int>(count) + static_cast<int>(middles.size()))
        .first->second;
  };
  finer.faces.resize(4 * mesh.faces.rows(), 3);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const int a = mesh.faces(f, 0), b = mesh.faces(f, 1), c = mesh.faces(f, 2);
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.faces.middleRows(4 * f, 4) << a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca;
  }
  finer.vertices.resize(count + static_cast<Eigen::Index>(middles.size()), 3);
  finer.vertices.topRows(count) = mesh.vertices;
  for (const auto& [ends, at] : middles)
    finer.vertices.row(at) = 0.5f * (mesh.vertices.row(ends.first) + mesh.vertices.row(ends.second));
  return finer;
}

/// A ball of 3,000 vertices that touches nothing.
Mesh ball(const Vec3& middle, float radius) {
  Mesh mesh;
  mesh.vertices.resize(6, 3);
  mesh.vertices << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  mesh.faces.resize(8, 3);
  mesh.faces << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
  for (int i = 0; i < 5; ++i) mesh = subdivided(mesh);
  mesh.vertices = radius * mesh.vertices.rowwise().normalized();
  mesh.vertices.rowwise() += middle.transpose();
  return mesh;
}

/// Puts `part` behind the vertices of `mesh`; where.
std::pair<Eigen::Index, Eigen::Index> append(Mesh& mesh, const Mesh& part) {
  const auto first = mesh.vertices.rows(), faces = mesh.faces.rows();
  mesh.vertices.conservativeResize(first + part.vertices.rows(), 3);
  mesh.vertices.bottomRows(part.vertices.rows()) = part.vertices;
  mesh.faces.conservativeResize(faces + part.faces.rows(), 3);
  mesh.faces.bottomRows(part.faces.rows()) = part.faces.array() + static_cast<int>(first);
  return {first, part.vertices.rows()};
}

/// A person of 46,000 vertices with two parts of its own, bound both ways.
class LargeBinding : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const ShapedBody person = builtin_person();
    joints_ = person.joints;
    mesh_ = subdivided({person.vertices, person.faces, {}});
    button_ = append(mesh_, ball(joints_.row(Spine3).transpose() + Vec3(0, 0, 0.25f), 0.015f));
    eye_ = append(mesh_, ball(joints_.row(Head).transpose() + Vec3(0, 0.1f, 0.2f), 0.03f));
    between_ = bound(40000);
    everywhere_ = bound(std::numeric_limits<int>::max());
  }
  static void TearDownTestSuite() { between_ = everywhere_ = nullptr; }
  static std::shared_ptr<Deformer> bound(int most_asked) {
    auto deformer = std::make_shared<CarefulDeformer>(
        mesh_.faces,
        std::shared_ptr<Deformer>(nn::load_network_deformer(kWeights, /*offsets=*/true, most_asked)));
    deformer->bind(mesh_.vertices, joints_);
    return deformer;
  }
  /// Some moments of a dance and of a walk.
  static std::vector<Pose> poses() {
    std::vector<Pose> out;
    for (const char* name : {"dance", "walk"}) {
      const Motion motion = builtin_motion(name, joints_);
      for (size_t t = 5; t < motion.poses.size(); t += 40) out.push_back(motion.poses[t]);
    }
    return out;
  }
  /// Whether all vertices of a part have the same weights.
  static bool has_one_transform(const Deformer& deformer, std::pair<Eigen::Index, Eigen::Index> part) {
    const auto own = deformer.weights().middleRows(part.first, part.second);
    return (own.rowwise() - own.row(0)).cwiseAbs().maxCoeff() < 1e-6f;
  }
  /// The largest change of a distance from a part's first vertex, metres.
  static float bending(const Deformer& deformer, std::pair<Eigen::Index, Eigen::Index> part) {
    const auto ways = [&](const Points& points) -> Eigen::VectorXf {
      const auto own = points.middleRows(part.first, part.second);
      return (own.rowwise() - own.row(0)).rowwise().norm();
    };
    float most = 0;
    for (const Pose& pose : poses())
      most = std::max(most, (ways(deformer.deform(pose)) - ways(mesh_.vertices)).cwiseAbs().maxCoeff());
    return most;
  }

  static Mesh mesh_;
  static Joints joints_;
  static std::pair<Eigen::Index, Eigen::Index> button_, eye_;
  static std::shared_ptr<Deformer> between_, everywhere_;
};
Mesh LargeBinding::mesh_;
Joints LargeBinding::joints_;
std::pair<Eigen::Index, Eigen::Index> LargeBinding::button_, LargeBinding::eye_;
std::shared_ptr<Deformer> LargeBinding::between_, LargeBinding::everywhere_;

TEST_F(LargeBinding, HasTheWeightsOfAskingEverywhere) {
  ASSERT_GT(mesh_.vertices.rows(), 45000);
  const Eigen::MatrixXf off = (between_->weights() - everywhere_->weights()).cwiseAbs();
  EXPECT_GT(off.maxCoeff(), 0) << "nothing was interpolated";
  EXPECT_LT(off.rowwise().maxCoeff().mean(), 1e-3f);
  EXPECT_LT(off.maxCoeff(), 0.05f);
  EXPECT_LT((between_->weights().rowwise().sum().array() - 1).abs().maxCoeff(), 1e-5f);
}

TEST_F(LargeBinding, PosesAsAskingEverywhereDoes) {
  float largest = 0, sum = 0;
  for (const Pose& pose : poses()) {
    const Eigen::VectorXf off = (between_->deform(pose) - everywhere_->deform(pose)).rowwise().norm();
    largest = std::max(largest, off.maxCoeff());
    sum += off.mean();
  }
  EXPECT_LT(1000 * sum / static_cast<float>(poses().size()), 0.02f) << "mm";
  EXPECT_LT(1000 * largest, 4) << "mm";
}

TEST_F(LargeBinding, SaysOffsetsAsAskingEverywhereDoes) {
  for (const Pose& pose : poses()) {
    const Points offsets = everywhere_->offsets(pose);
    const Eigen::VectorXf off = (between_->offsets(pose) - offsets).rowwise().norm();
    const float largest = offsets.rowwise().norm().maxCoeff();
    EXPECT_GT(1000 * largest, 2) << "mm";
    EXPECT_LT(1000 * off.mean(), 0.02f) << "mm";
    EXPECT_LT(off.maxCoeff(), 0.15f * largest);  // in the creases behind knees
  }
}

TEST_F(LargeBinding, SeparatePartsStayRigid) {
  for (const auto& deformer : {between_, everywhere_}) {
    EXPECT_TRUE(has_one_transform(*deformer, button_));
    EXPECT_TRUE(has_one_transform(*deformer, eye_));
    EXPECT_LT(1000 * bending(*deformer, button_), 0.6f) << "mm";  // between two bones
    EXPECT_LT(1000 * bending(*deformer, eye_), 0.01f) << "mm";
  }
}

TEST_F(LargeBinding, OtherWeightsKeepTheOffsets) {
  const auto painted = between_->with_weights(between_->weights());
  const Pose pose = poses().front();
  EXPECT_LT((painted->deform(pose) - between_->deform(pose)).cwiseAbs().maxCoeff(), 1e-5f);
}

}  // namespace
}  // namespace understudy
