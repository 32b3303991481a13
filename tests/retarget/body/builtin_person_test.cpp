#include "retarget/body/builtin_person.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

PersonOptions options(float stature, float girth, float sex, float age) {
  PersonOptions o;
  o.stature = stature, o.girth = girth, o.sex = sex, o.age = age;
  return o;
}

const std::map<std::string, ShapedBody>& people() {
  static const std::map<std::string, ShapedBody> made = {
      {"man", builtin_person(options(1.80f, 1.0f, 0, 30))},
      {"woman", builtin_person(options(1.66f, 1.0f, 1, 30))},
      {"heavy", builtin_person(options(1.75f, 1.5f, 0, 50))},
      {"child", builtin_person(options(1.10f, 1.0f, 1, 6))},
      {"old", builtin_person(options(1.60f, 1.1f, 1, 82))}};
  return made;
}

double volume(const ShapedBody& body) {
  double six = 0;
  for (int f = 0; f < body.faces.rows(); ++f) {
    const Vec3 a = body.vertices.row(body.faces(f, 0)), b = body.vertices.row(body.faces(f, 1)),
               c = body.vertices.row(body.faces(f, 2));
    six += a.dot(b.cross(c));
  }
  return six / 6;
}

/// The solid angle of the surface seen from a point, over 4 pi: 1 inside, 0 outside (van Oosterom and
/// Strackee).
double winding_number(const ShapedBody& body, const Vec3& p) {
  double angle = 0;
  for (int f = 0; f < body.faces.rows(); ++f) {
    std::array<Eigen::Vector3d, 3> q;
    for (int c = 0; c < 3; ++c) q[c] = (body.vertices.row(body.faces(f, c)).transpose() - p).cast<double>();
    const double a = q[0].norm(), b = q[1].norm(), c = q[2].norm();
    angle += 2 * std::atan2(q[0].dot(q[1].cross(q[2])),
                            a * b * c + q[0].dot(q[1]) * c + q[1].dot(q[2]) * a + q[2].dot(q[0]) * b);
  }
  return angle / (4 * 3.14159265358979);
}

TEST(BuiltinPerson, SurfaceIsOneClosedManifold) {
  for (const auto& [name, body] : people()) {
    std::map<std::pair<int, int>, int> directed;
    for (int f = 0; f < body.faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) ++directed[{body.faces(f, c), body.faces(f, (c + 1) % 3)}];
    for (const auto& [edge, count] : directed) {
      ASSERT_EQ(count, 1) << name << ": edge " << edge.first << " " << edge.second;
      ASSERT_EQ(directed.count({edge.second, edge.first}), 1u)
          << name << ": open edge " << edge.first << " " << edge.second;
    }
    // One piece without handles: V - E + F = 2.
    EXPECT_EQ(body.vertices.rows() - static_cast<int64_t>(directed.size() / 2) + body.faces.rows(), 2)
        << name;
  }
}

TEST(BuiltinPerson, HasEightToFifteenThousandVertices) {
  for (const auto& [name, body] : people()) {
    EXPECT_GE(body.vertices.rows(), 8000) << name;
    EXPECT_LE(body.vertices.rows(), 15000) << name;
    EXPECT_TRUE(body.vertices.allFinite()) << name;
  }
}

TEST(BuiltinPerson, FacesOutwardAndWeighsWhatPeopleWeigh) {
  // Litres by stature: a body of 985 kg/m3 with a body mass index of 16 to 27, the heavy one up to 45.
  for (const auto& [name, body] : people()) {
    const float stature = body.vertices.col(1).maxCoeff() - body.vertices.col(1).minCoeff();
    const double index = volume(body) * 985 / (stature * stature);
    EXPECT_GT(index, name == "heavy" ? 26 : 13) << name;
    EXPECT_LT(index, name == "heavy" ? 45 : 28) << name;
  }
}

TEST(BuiltinPerson, TrianglesAreWellShapedAndNotTurnedOver) {
  for (const auto& [name, body] : people()) {
    const Points normals = vertex_normals(body.vertices, body.faces);
    int slivers = 0, turned = 0;
    for (int f = 0; f < body.faces.rows(); ++f) {
      std::array<Vec3, 3> q;
      for (int c = 0; c < 3; ++c) q[c] = body.vertices.row(body.faces(f, c));
      const Vec3 n = (q[1] - q[0]).cross(q[2] - q[0]);
      const float longest = std::max({(q[1] - q[0]).norm(), (q[2] - q[1]).norm(), (q[0] - q[2]).norm()});
      slivers += n.norm() < 0.1f * longest * longest;
      for (int c = 0; c < 3; ++c)
        turned += n.dot(normals.row(body.faces(f, c)).transpose()) < -0.2f * n.norm();
    }
    EXPECT_LT(slivers, 0.01 * static_cast<double>(body.faces.rows())) << name;
    EXPECT_LT(turned, 0.002 * static_cast<double>(body.faces.rows())) << name;
  }
}

TEST(BuiltinPerson, IsAsTallAsAskedWithArmsAboutAsWide) {
  EXPECT_NEAR(people().at("man").vertices.col(1).maxCoeff() - people().at("man").vertices.col(1).minCoeff(),
              1.80f, 0.006f);
  EXPECT_NEAR(
      people().at("child").vertices.col(1).maxCoeff() - people().at("child").vertices.col(1).minCoeff(),
      1.10f, 0.006f);
  const float span = 2 * people().at("man").vertices.col(0).maxCoeff();
  EXPECT_NEAR(span / 1.80f, 1.0f, 0.05f);
}

TEST(BuiltinPerson, EveryJointIsInsideTheSurface) {
  for (const auto& [name, body] : people()) {
    EXPECT_EQ(body.joints.row(Pelvis).norm(), 0.0f) << name;
    for (int j = 0; j < kJointCount; ++j)
      EXPECT_NEAR(winding_number(body, body.joints.row(j)), 1.0, 0.01) << name << " " << kJointNames[j];
  }
}

TEST(BuiltinPerson, IsItsOwnMirrorImage) {
  for (const auto& [name, body] : people()) {
    std::map<std::tuple<float, float, float>, int> place;
    for (int v = 0; v < body.vertices.rows(); ++v)
      place[{body.vertices(v, 0), body.vertices(v, 1), body.vertices(v, 2)}] = v;
    for (int v = 0; v < body.vertices.rows(); ++v) {
      const auto found = place.find({-body.vertices(v, 0), body.vertices(v, 1), body.vertices(v, 2)});
      ASSERT_NE(found, place.end()) << name << " vertex " << v;
      for (int j = 0; j < kJointCount; ++j)
        ASSERT_NEAR(body.weights(v, j), body.weights(found->second, kMirror[j]), 1e-5f) << name;
    }
  }
}

TEST(BuiltinPerson, WeightsSumToOneAndSitOnTheirParts) {
  for (const auto& [name, body] : people()) {
    const auto& w = body.weights;
    EXPECT_GE(w.minCoeff(), 0) << name;
    EXPECT_LT((w.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-5f) << name;
    const auto& j = body.joints;
    for (int v = 0; v < body.vertices.rows(); ++v) {
      const float x = body.vertices(v, 0), y = body.vertices(v, 1);
      const auto of = [&](std::initializer_list<int> joints) {
        float sum = 0;
        for (int k : joints) sum += w(v, k);
        return sum;
      };
      const float middle_arm = 0.5f * (j(LeftElbow, 0) + j(LeftWrist, 0));
      if (x > middle_arm + 0.05f) ASSERT_GT(of({LeftElbow, LeftWrist}), 0.95f) << name;
      if (x > j(LeftWrist, 0) + 0.06f) ASSERT_GT(w(v, LeftWrist), 0.98f) << name;
      if (y > j(Head, 1) + 0.10f) ASSERT_GT(w(v, Head), 0.95f) << name;
      if (y < 0.5f * (j(LeftHip, 1) + j(LeftKnee, 1))) {  // no leg takes the other's skin
        ASSERT_LT(x > 0 ? of({RightHip, RightKnee, RightAnkle, RightFoot})
                        : of({LeftHip, LeftKnee, LeftAnkle, LeftFoot}),
                  1e-3f)
            << name;
        ASSERT_LT(of({LeftShoulder, LeftElbow, LeftWrist, RightShoulder, RightElbow, RightWrist, Spine3}),
                  1e-4f)
            << name;
      }
      if (y > j(Spine1, 1) && y < j(Spine2, 1) + 0.05f)
        ASSERT_LT(of({LeftShoulder, LeftElbow, RightShoulder, RightElbow}), 0.02f) << name;
    }
  }
}

TEST(BuiltinPerson, NoLoneVertexFollowsAnotherBone) {
  // Weights change gently along the surface: no edge jumps by more than 0.5 in any joint.
  for (const auto& [name, body] : people())
    for (int f = 0; f < body.faces.rows(); ++f)
      ASSERT_LT(
          (body.weights.row(body.faces(f, 0)) - body.weights.row(body.faces(f, 1))).cwiseAbs().maxCoeff(),
          0.5f)
          << name;
}

TEST(BuiltinPerson, ChildrenHaveLargeHeadsAndShortLegs) {
  const auto head = [](const ShapedBody& b) {
    return (b.vertices.col(1).maxCoeff() - b.joints(Neck, 1)) /
           (b.vertices.col(1).maxCoeff() - b.vertices.col(1).minCoeff());
  };
  const auto legs = [](const ShapedBody& b) {
    return leg_length(b.joints) / (b.vertices.col(1).maxCoeff() - b.vertices.col(1).minCoeff());
  };
  EXPECT_GT(head(people().at("child")), 1.15f * head(people().at("man")));
  EXPECT_LT(legs(people().at("child")), 0.95f * legs(people().at("man")));
}

TEST(BuiltinPerson, GirthAndSexShowWhereTheyShould) {
  const auto width = [](const ShapedBody& b, float y) {
    float w = 0;
    for (int v = 0; v < b.vertices.rows(); ++v)
      if (std::abs(b.vertices(v, 1) - y) < 0.015f) w = std::max(w, b.vertices(v, 0));
    return w;
  };
  const auto &man = people().at("man"), &heavy = people().at("heavy"), &woman = people().at("woman");
  EXPECT_GT(width(heavy, heavy.joints(Spine2, 1)), 1.3f * width(man, man.joints(Spine2, 1)));
  const auto waist_to_hips = [&](const ShapedBody& b) {
    return width(b, b.joints(Spine3, 1)) / width(b, b.joints(LeftHip, 1));
  };
  EXPECT_LT(waist_to_hips(woman), 0.9f * waist_to_hips(man));
  EXPECT_GT(man.joints(LeftShoulder, 0) / man.joints(LeftHip, 0),
            woman.joints(LeftShoulder, 0) / woman.joints(LeftHip, 0));
}

TEST(BuiltinPerson, FaceAndFeetPointForward) {
  const ShapedBody& man = people().at("man");
  Eigen::Index tip = 0;
  Points head = man.vertices;
  for (int v = 0; v < head.rows(); ++v)
    if (head(v, 1) < man.joints(Neck, 1) + 0.03f) head(v, 2) = -1;
  head.col(2).maxCoeff(&tip);
  EXPECT_LT(std::abs(head(tip, 0)), 0.01f);  // the nose, in the middle
  EXPECT_GT(head(tip, 2), man.joints(Head, 2) + 0.08f);
  EXPECT_GT(man.joints(LeftFoot, 2), man.joints(LeftAnkle, 2) + 0.08f);
}

TEST(BuiltinPerson, SameOptionsGiveTheSameBytes) {
  const ShapedBody again = builtin_person(options(1.66f, 1.0f, 1, 30));
  EXPECT_TRUE(again.vertices == people().at("woman").vertices);
  EXPECT_TRUE(again.faces == people().at("woman").faces);
  EXPECT_TRUE(again.weights == people().at("woman").weights);
  EXPECT_TRUE(again.joints == builtin_joints(options(1.66f, 1.0f, 1, 30)));
}

TEST(BuiltinPerson, RefusesOptionsOutOfRange) {
  EXPECT_THROW(builtin_person(options(3.0f, 1, 0, 30)), Error);
  EXPECT_THROW(builtin_person(options(1.7f, 1, 2, 30)), Error);
  EXPECT_THROW(builtin_joints(options(1.7f, 1, 0, std::nanf(""))), Error);
}

}  // namespace
}  // namespace understudy
