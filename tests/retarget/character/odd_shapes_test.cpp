// What strangers bring: shapes that lie, that are no person, with broken surfaces, tiny and huge.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "retarget/character/character_export.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/character/stance.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::tests {
namespace {

using test::contains;
using test::error_of;
using test::TempFolder;

/// A box between two corners, added to the mesh.
void add_box(Mesh& mesh, const Vec3& low, const Vec3& high) {
  const auto base = static_cast<int>(mesh.vertices.rows());
  mesh.vertices.conservativeResize(base + 8, 3);
  for (int i = 0; i < 8; ++i)
    mesh.vertices.row(base + i) << (i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
        (i & 4 ? high : low).z();
  const int corners[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                             {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (const auto& c : corners) {
    const Eigen::Index f = mesh.faces.rows();
    mesh.faces.conservativeResize(f + 2, 3);
    mesh.faces.row(f) << base + c[0], base + c[1], base + c[2];
    mesh.faces.row(f + 1) << base + c[0], base + c[2], base + c[3];
  }
}

/// Body, four legs, head and tail; the nose towards +z.
Mesh cat(float leg = 0.18f, float body = 0.4f) {
  Mesh mesh;
  add_box(mesh, {-0.07f, leg, -body / 2}, {0.07f, leg + 0.14f, body / 2});
  for (const float x : {-0.06f, 0.03f})
    for (const float z : {-body / 2, body / 2 - 0.03f}) add_box(mesh, {x, 0, z}, {x + 0.03f, leg, z + 0.03f});
  add_box(mesh, {-0.05f, leg + 0.1f, body / 2}, {0.05f, leg + 0.2f, body / 2 + 0.1f});
  add_box(mesh, {-0.01f, leg + 0.12f, -body / 2 - 0.25f}, {0.01f, leg + 0.14f, -body / 2});
  return mesh;
}

Mesh ball() {
  Mesh mesh;
  mesh.vertices.resize(400, 3);
  for (int i = 0; i < 400; ++i) {
    const float y = 1 - 2 * (static_cast<float>(i) + 0.5f) / 400, r = std::sqrt(1 - y * y),
                a = 2.4f * static_cast<float>(i);
    mesh.vertices.row(i) << r * std::cos(a), y, r * std::sin(a);
  }
  return mesh;
}

Character bare(const MadeCharacter& like = {}) {
  MadeCharacter options = like;
  options.rigged = false;
  return make_character(options);
}

Mat3 about_x(float degrees) {
  return Eigen::AngleAxisf(degrees * kPi / 180, Vec3::UnitX()).toRotationMatrix();
}

/// As it would be in a file with another axis up.
Character turned(Character character, const Mat3& R) {
  for (auto& part : character.parts) {
    part.vertices = (part.vertices * R.transpose()).eval();
    if (part.normals.rows() > 0) part.normals = (part.normals * R.transpose()).eval();
  }
  return character;
}

bool noted(const PreparedCharacter& c, const std::string& text) {
  for (const auto& note : c.notes)
    if (contains(note, text)) return true;
  return false;
}

float height_of(const PreparedCharacter& c) {
  const auto y = c.target.mesh.vertices.col(1);
  return y.maxCoeff() - y.minCoeff();
}

TEST(OddShapes, WhoLiesDownIsTurnedUprightWithANote) {
  KnownExtractor known(made_joints({}));
  const Mat3 on_the_back = about_x(-90), on_the_belly = about_x(90);
  for (const Mat3& R : {on_the_back, on_the_belly}) {
    const PreparedCharacter c = prepare_character(turned(bare(), R), &known, nullptr);
    EXPECT_NEAR(height_of(c), 1.7f, 0.2f);
    EXPECT_TRUE(noted(c, "lies down with y up"));
    const Mat3 whole = c.to_world.R * R;  // the head is up again
    EXPECT_GT(whole(1, 1), 0.99f);
  }
}

TEST(OddShapes, WhoIsToldToLieIsRefused) {
  KnownExtractor known(made_joints({}));
  CharacterOptions options;
  options.turn_if_lying = false;
  const Character lying = turned(bare(), about_x(-90));
  EXPECT_TRUE(
      contains(error_of([&] { prepare_character(lying, &known, nullptr, options); }), "it lies down: "));
}

TEST(OddShapes, ALyingRigIsTurnedByItsSpine) {
  Character lying = make_character();
  lying.nodes[0].local.rotation = Eigen::Quaternionf(about_x(-90)) * lying.nodes[0].local.rotation;
  const PreparedCharacter c = prepare_character(std::move(lying), nullptr, nullptr);
  EXPECT_NEAR(height_of(c), 1.7f, 0.2f);
}

/// Sees who stands on the feet as they are, and who stands on the head with the head below.
class HonestExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh& scan) override {
    Joints joints = made_joints({});
    // Heads are narrower than legs and feet are apart: the upper half of who stands is wider, by the arms.
    const float middle = 0.5f * (scan.vertices.col(1).maxCoeff() + scan.vertices.col(1).minCoeff());
    Eigen::Index widest = 0;
    scan.vertices.leftCols<1>()
        .cwiseAbs()
        .cwiseMax(scan.vertices.rightCols<1>().cwiseAbs())
        .maxCoeff(&widest);
    Extraction out;
    if (scan.vertices(widest, 1) < middle) {
      joints.col(1) = (1.7f - joints.col(1).array()).matrix();
      joints.col(0) *= -1;
    }
    out.joints = joints;
    return out;
  }
  std::string name() const override { return "honest"; }
};

TEST(OddShapes, WhoIsHeadDownIsTurnedOverWithANote) {
  HonestExtractor honest;
  const Mat3 over = Eigen::AngleAxisf(kPi, Vec3::UnitZ()).toRotationMatrix();
  CharacterOptions options;
  options.turn_deg = 0;
  const PreparedCharacter c = prepare_character(turned(bare(), over), &honest, nullptr, options);
  EXPECT_TRUE(noted(c, "is upside down"));
  EXPECT_NEAR(c.surface.mesh.vertices.col(1).minCoeff(), 0, 0.03f);
  const PreparedCharacter upright = prepare_character(bare(), &honest, nullptr, options);
  EXPECT_FALSE(noted(upright, "upside down"));
  EXPECT_LT((c.target.mesh.vertices - upright.target.mesh.vertices).rowwise().norm().maxCoeff(), 0.02f);
  options.turn_if_lying = false;  // told to stand so
  EXPECT_TRUE(contains(error_of([&] { prepare_character(turned(bare(), over), &honest, nullptr, options); }),
                       "is upside down with y up"));
}

TEST(OddShapes, ARigThatIsHeadDownIsTurnedByItsSpine) {
  Character down = make_character();
  down.nodes[0].local.rotation = Eigen::Quaternionf(about_x(180)) * down.nodes[0].local.rotation;
  const PreparedCharacter c = prepare_character(down, nullptr, nullptr);
  EXPECT_TRUE(noted(c, "it is upside down with y up, so -y is taken as up"));
  EXPECT_GT(c.target.joints(Head, 1), c.target.joints(Pelvis, 1));
  CharacterOptions options;
  options.turn_if_lying = false;
  EXPECT_TRUE(contains(error_of([&] { prepare_character(down, nullptr, nullptr, options); }),
                       "is upside down with y up, -y up (--target-up) turns it over"));
}

TEST(OddShapes, ACatIsRefusedInASentence) {
  KnownExtractor known(made_joints({}));
  for (const float leg : {0.12f, 0.18f, 0.25f}) {
    const Character character = character_of_mesh(cat(leg), "tom");
    const std::string complaint = error_of([&] { prepare_character(character, &known, nullptr); });
    EXPECT_TRUE(contains(complaint, "tom: does not look like a person: it is ")) << complaint;
    EXPECT_EQ(complaint.find('\n'), complaint.npos);
  }
  Mesh table;
  add_box(table, {-0.7f, 0.7f, -0.4f}, {0.7f, 0.75f, 0.4f});
  for (const float x : {-0.7f, 0.65f})
    for (const float z : {-0.4f, 0.35f}) add_box(table, {x, 0, z}, {x + 0.05f, 0.7f, z + 0.05f});
  EXPECT_FALSE(refusal(stance_of(table)).empty());
}

/// The cat on bones: a spine, neck and head, on each side a hind leg and a foreleg; named as a person's or by
/// numbers.
Character rigged_cat(bool as_a_person) {
  const std::vector<int> joints = {Pelvis,     Spine1,     Spine3,    Neck,         Head,      LeftHip,
                                   LeftKnee,   LeftAnkle,  LeftFoot,  LeftShoulder, LeftElbow, LeftWrist,
                                   -1,         RightHip,   RightKnee, RightAnkle,   RightFoot, RightShoulder,
                                   RightElbow, RightWrist, -1};
  Character tom = character_of_mesh(cat(), "tom");
  tom.nodes.clear();
  tom.nodes.push_back({});  // the mesh
  CharacterSkin skin;
  const auto add = [&](int parent, const Vec3& at) {
    CharacterNode node;
    const int joint = joints.at(tom.nodes.size() - 1);
    node.name = as_a_person && joint >= 0 ? made_name(Naming::Mixamo, joint)
                                          : "Bone." + std::to_string(tom.nodes.size());
    node.parent = parent;
    Vec3 above = Vec3::Zero();
    for (int p = parent; p >= 0; p = tom.nodes[static_cast<size_t>(p)].parent)
      above += tom.nodes[static_cast<size_t>(p)].local.translation;
    node.local.translation = at - above;
    skin.joints.push_back(static_cast<int>(tom.nodes.size()));
    Mat4 inverse = Mat4::Identity();
    inverse.topRightCorner<3, 1>() = -at;
    skin.inverse_bind.push_back(inverse);
    tom.nodes.push_back(node);
    return skin.joints.back();
  };
  const int hips = add(-1, {0, 0.25f, -0.18f});
  const int spine = add(hips, {0, 0.25f, 0}), chest = add(spine, {0, 0.25f, 0.18f});
  add(add(chest, {0, 0.3f, 0.22f}), {0, 0.33f, 0.28f});
  for (const float x : {0.045f, -0.045f})
    for (const bool front : {false, true}) {
      const float z = front ? 0.185f : -0.185f;
      const int upper = add(front ? chest : hips, {x, 0.2f, z}), lower = add(upper, {x, 0.1f, z + 0.01f});
      add(add(lower, {x, 0.02f, z}), {x, 0.0f, z + 0.04f});
    }
  CharacterPart& part = tom.parts[0];
  part.skin = 0;
  part.joints.setZero(part.vertices.rows(), 4);
  part.weights.setZero(part.vertices.rows(), 4);
  for (Eigen::Index v = 0; v < part.vertices.rows(); ++v) {
    float nearest = 1e9f;
    for (size_t j = 0; j < skin.joints.size(); ++j) {
      const Vec3 at = -skin.inverse_bind[j].topRightCorner<3, 1>();
      const float d = (part.vertices.row(v).transpose() - at).norm();
      if (d < nearest) nearest = d, part.joints(v, 0) = static_cast<int>(j);
    }
    part.weights(v, 0) = 1;
  }
  tom.skins = {skin};
  return tom;
}

TEST(OddShapes, ACatOnARigIsRefusedAndWarnedOfWhereItsBonesAreNamedAsAPersons) {
  const std::string complaint = error_of([] { load_character(rigged_cat(false)); });
  EXPECT_TRUE(contains(complaint, "tom: does not look like a person: it is ")) << complaint;
  const PreparedCharacter c = prepare_character(rigged_cat(true), nullptr, nullptr);
  ASSERT_TRUE(c.rigged);
  ASSERT_FALSE(c.target.warnings.empty());
  EXPECT_TRUE(contains(c.target.warnings.back(), "may not be a person: it is ")) << c.target.warnings.back();
}

/// Sees nobody anywhere.
class BlindExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh&) override {
    Extraction out;
    out.joints = made_joints({});
    out.confidence.setZero();
    return out;
  }
  std::string name() const override { return "blind"; }
};

/// Its head is up: neither as long nor its feet as far apart, for its height, as a cat's.
Mesh horse() {
  Mesh mesh;
  add_box(mesh, {-0.25f, 0.95f, -0.65f}, {0.25f, 1.5f, 0.6f});
  for (const float x : {-0.2f, 0.08f})
    for (const float z : {-0.65f, 0.5f}) add_box(mesh, {x, 0, z}, {x + 0.12f, 1, z + 0.12f});
  add_box(mesh, {-0.1f, 1.4f, 0.5f}, {0.1f, 2.1f, 0.8f});
  add_box(mesh, {-0.1f, 1.85f, 0.7f}, {0.1f, 2.1f, 1.2f});
  return mesh;
}

TEST(OddShapes, WhatIsNoPersonIsUsedOnlyWhereToldSo) {
  Character hand = bare();
  for (CharacterPart& part : hand.parts) part.vertices *= 0.13f;  // 22 cm
  const std::pair<Character, std::string> strangers[] = {
      {character_of_mesh(horse(), "horse"), "no person recognised in it, and its feet are "},
      {hand, "no person recognised in it, and its size is no person's in any unit"},
      {character_of_mesh(cat(), "cat"), "does not look like a person: it is "}};
  BlindExtractor blind;
  KnownExtractor known(made_joints({}));
  for (const auto& [stranger, why] : strangers) {
    CharacterOptions options;
    options.not_a_person = NotAPerson::Refuse;
    EXPECT_THROW(prepare_character(stranger, &blind, nullptr, options), NotAPersonError) << why;
    const std::string complaint =
        error_of([&, &who = stranger] { prepare_character(who, &blind, nullptr, options); });
    EXPECT_TRUE(contains(complaint, why)) << complaint;
    options.not_a_person = NotAPerson::Use;
    EXPECT_NO_THROW(prepare_character(stranger, &blind, nullptr, options)) << why;
  }
  CharacterOptions strict;
  strict.not_a_person = NotAPerson::Refuse;
  EXPECT_NO_THROW(prepare_character(hand, &known, nullptr, strict)) << "a person who is small is recognised";
  EXPECT_NO_THROW(prepare_character(bare(), &blind, nullptr, strict))
      << "nothing but the network speaks against it";
}

TEST(OddShapes, WhatMayBeNoPersonIsWarnedOf) {
  EXPECT_TRUE(refusal(stance_of(ball())).empty());
  EXPECT_FALSE(implausibility(stance_of(ball())).empty());
  KnownExtractor known(made_joints({}));
  const PreparedCharacter c = prepare_character(character_of_mesh(ball(), "ball"), &known, nullptr);
  bool told = false;
  for (const auto& warning : c.target.warnings) told = told || contains(warning, "may not be a person");
  EXPECT_TRUE(told);
}

TEST(OddShapes, PersonsAreNeitherRefusedNorDoubted) {
  for (const float arms : {0.0f, 50.0f, 80.0f})
    for (const float legs : {0.0f, 25.0f})
      for (const float heading : {0.0f, 70.0f}) {
        MadeCharacter options;
        options.arms_down_deg = arms;
        options.legs_apart_deg = legs;
        options.heading_deg = heading;
        const Character person = bare(options);
        const Stance stance = stance_of({posed_vertices(person, person.world()), {}, {}});
        EXPECT_EQ(implausibility(stance), "") << arms << ' ' << legs << ' ' << heading;
        EXPECT_FALSE(lies_down(stance));
      }
  const Character robot = make_robot();
  EXPECT_EQ(implausibility(stance_of({posed_vertices(robot, robot.world()), {}, {}})), "");
}

/// From a bare shape to a written file that can be read, by way of T-pose and geometric weights.
void expect_usable(const Character& character) {
  KnownExtractor known(made_joints({}));
  const PreparedCharacter c = prepare_character(character, &known, nullptr);
  ASSERT_TRUE(c.target.mesh.vertices.allFinite());
  ASSERT_TRUE(c.pose_weights.allFinite());
  ASSERT_EQ(c.pose_weights.rows() > 0, c.pose.largest_deg > 0);
  if (c.pose_weights.rows() > 0)
    EXPECT_LT((c.pose_weights.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-4f);
  BulgingDeformer screen;
  screen.bind(c.target.mesh.vertices, c.target.joints);
  const TempFolder folder;
  CharacterExportOptions options;
  options.their_rig = false;
  const ExportCost cost = export_character(
      folder.path("a.glb"), {{c, screen, {{"walk", 30, made_motion(3, c.target.joints)}}, options}});
  EXPECT_LT(cost.mean_mm, 30.0);  // four influences a vertex, the screen has more
  EXPECT_EQ(read_character(folder.path("a.glb")).vertex_count(), character.vertex_count());
}

Character shape_with(const std::function<void(CharacterPart&)>& change) {
  Character character = bare();
  change(character.parts[0]);
  return character;
}

void add_face(CharacterPart& part, int a, int b, int c) {
  const Eigen::Index f = part.faces.rows();
  part.faces.conservativeResize(f + 1, 3);
  part.faces.row(f) << a, b, c;
}

TEST(OddShapes, EdgesOfThreeFacesAreNoProblem) {
  expect_usable(shape_with([](CharacterPart& part) {
    for (int k = 20; k < 30; ++k) add_face(part, part.faces(0, 0), part.faces(0, 1), k);
  }));
}

TEST(OddShapes, OpenSurfacesAreNoProblem) {
  expect_usable(shape_with([](CharacterPart& part) {
    const Faces half = part.faces.topRows(part.faces.rows() / 2);
    part.faces = half;  // vertices of no face are left
  }));
}

TEST(OddShapes, DegenerateAndDoubledFacesAreNoProblem) {
  expect_usable(shape_with([](CharacterPart& part) {
    add_face(part, 3, 3, 3);
    add_face(part, 3, 4, 3);
    for (int k = 0; k < 5; ++k) add_face(part, part.faces(0, 0), part.faces(0, 1), part.faces(0, 2));
    add_face(part, part.faces(0, 2), part.faces(0, 1), part.faces(0, 0));  // inside out
  }));
}

TEST(OddShapes, ASoupOfTrianglesIsOneSurface) {
  const Character whole = bare();
  Character soup = whole;
  for (auto& part : soup.parts) {  // each face has corners of its own
    const CharacterPart from = part;
    const Eigen::Index corners = from.faces.size();
    part.vertices.resize(corners, 3);
    part.normals.resize(0, 3);
    part.uvs.clear();
    part.colors.resize(0, 0);
    for (Eigen::Index i = 0; i < corners; ++i) {
      part.vertices.row(i) = from.vertices.row(from.faces.data()[i]);
      part.faces.data()[i] = static_cast<int>(i);
    }
  }
  EXPECT_LT(merged_surface(soup, posed_vertices(soup, soup.world())).mesh.vertices.rows(),
            whole.vertex_count() + 1);
  expect_usable(soup);
}

/// Each triangle cut into four until there are so many vertices.
Character cut_finer(Character character, Eigen::Index vertices) {
  while (character.vertex_count() < vertices)
    for (auto& part : character.parts) {
      const CharacterPart from = part;
      const Eigen::Index n = from.vertices.rows(), f = from.faces.rows();
      part.vertices.resize(n + 3 * f, 3);
      part.vertices.topRows(n) = from.vertices;
      part.faces.resize(4 * f, 3);
      part.normals.resize(0, 3);
      part.uvs.clear();
      part.colors.resize(0, 0);
      for (Eigen::Index i = 0; i < f; ++i) {
        int m[3];
        for (int k = 0; k < 3; ++k) {
          m[k] = static_cast<int>(n + 3 * i + k);
          part.vertices.row(m[k]) =
              0.5f * (from.vertices.row(from.faces(i, k)) + from.vertices.row(from.faces(i, (k + 1) % 3)));
        }
        part.faces.row(4 * i) << from.faces(i, 0), m[0], m[2];
        part.faces.row(4 * i + 1) << m[0], from.faces(i, 1), m[1];
        part.faces.row(4 * i + 2) << m[2], m[1], from.faces(i, 2);
        part.faces.row(4 * i + 3) << m[0], m[1], m[2];
      }
    }
  return character;
}

TEST(OddShapes, FiveHundredThousandVerticesAreNoProblem) {
  const Character huge = cut_finer(bare(), 500000);
  const TempFolder folder;
  write_gltf_character(folder.path("huge.glb"), huge);
  KnownExtractor known(made_joints({}));
  const PreparedCharacter c = prepare_character(read_character(folder.path("huge.glb")), &known, nullptr);
  EXPECT_GE(c.character.vertex_count(), 500000);
  EXPECT_TRUE(c.target.mesh.vertices.allFinite());
  EXPECT_TRUE(c.pose_weights.allFinite());
}

TEST(OddShapes, AHundredVerticesAreEnough) {
  const Character whole = bare();
  Mesh cloud;
  const Points all = posed_vertices(whole, whole.world());
  cloud.vertices.resize(100, 3);
  for (Eigen::Index i = 0; i < 100; ++i) cloud.vertices.row(i) = all.row(i * all.rows() / 100);
  expect_usable(character_of_mesh(cloud, "few"));
}

TEST(OddShapes, ANearlyEmptyShapeIsRefused) {
  KnownExtractor known(made_joints({}));
  Mesh two;
  two.vertices = Points::Zero(2, 3);
  const Character character = character_of_mesh(two, "two");
  EXPECT_TRUE(
      contains(error_of([&] { prepare_character(character, &known, nullptr); }), "two: has no height"));
}

}  // namespace
}  // namespace understudy::tests
