#include "retarget/formats/import.hpp"

#include <algorithm>
#include <limits>

#include "retarget/math/rotation.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

using namespace test;

void add_box(std::vector<Vec3>& points, const Vec3& low, const Vec3& high, int count, Rng& rng) {
  for (int i = 0; i < count; ++i) {
    Vec3 p(rng.uniform(low.x(), high.x()), rng.uniform(low.y(), high.y()), rng.uniform(low.z(), high.z()));
    const int axis = rng.below(3);
    p[axis] = rng.chance(0.5f) ? low[axis] : high[axis];
    points.push_back(p);
  }
}

Points to_points(const std::vector<Vec3>& list) {
  Points out(static_cast<Eigen::Index>(list.size()), 3);
  for (size_t i = 0; i < list.size(); ++i) out.row(static_cast<Eigen::Index>(i)) = list[i].transpose();
  return out;
}

// A person of boxes, 1.7 m, y up, soles at 0; in T-pose a little wider than tall.
std::vector<Vec3> person(bool t_pose) {
  Rng rng(3);
  std::vector<Vec3> p;
  for (const float x : {-0.1f, 0.1f}) {
    add_box(p, {x - 0.07f, 0, -0.08f}, {x + 0.07f, 0.8f, 0.08f}, 900, rng);
    add_box(p, {x - 0.05f, 0, -0.08f}, {x + 0.05f, 0.07f, 0.17f}, 120, rng);
  }
  add_box(p, {-0.2f, 0.8f, -0.12f}, {0.2f, 1.42f, 0.12f}, 1500, rng);
  add_box(p, {-0.09f, 1.45f, -0.1f}, {0.09f, 1.7f, 0.1f}, 350, rng);
  for (const float side : {-1.0f, 1.0f}) {
    const Vec3 low = t_pose ? Vec3(std::min(side * 0.2f, side * 0.88f), 1.3f, -0.04f)
                            : Vec3(side * 0.25f - 0.04f, 0.72f, -0.04f);
    const Vec3 size = t_pose ? Vec3(0.68f, 0.09f, 0.08f) : Vec3(0.08f, 0.68f, 0.08f);
    add_box(p, low, low + size, 500, rng);
  }
  return p;
}

// From the program's axes to a file's with that axis up: what an import has to undo.
Mat3 file_axes(const std::string& up) {
  Mat3 R;
  if (up == "z") R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == "x") R << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  if (up == "y") R.setIdentity();
  if (up == "-y") R << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  if (up == "-z") R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (up == "-x") R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return R;
}

Mesh as_file(const std::vector<Vec3>& points, const std::string& up, float scale,
             const Vec3& shift = Vec3::Zero()) {
  Mesh mesh;
  mesh.vertices = to_points(points) * (file_axes(up) * scale).transpose();
  mesh.vertices.rowwise() += (shift * scale).transpose();
  return mesh;
}

TEST(Import, FindsUnitsAndUpAxisAndUndoesThem) {
  const std::vector<std::pair<const char*, float>> kUnits = {
      {"m", 1}, {"dm", 10}, {"cm", 100}, {"mm", 1000}, {"in", 39.37f}};
  for (const bool t_pose : {false, true})
    for (const std::string up : {"y", "z"})
      for (const auto& [units, scale] : kUnits) {
        const auto body = person(t_pose);
        const Mesh file = as_file(body, up, scale);
        const ImportDecision decision = decide_import(file, {});
        SCOPED_TRACE(decision.sentence);
        EXPECT_EQ(decision.units, units);
        EXPECT_EQ(decision.up, up);
        EXPECT_LT((decision.apply(file.vertices) - to_points(body)).cwiseAbs().maxCoeff(), 1e-3f);
      }
}

TEST(Import, FindsAStandingPersonInAFileWithXUp) {
  const ImportDecision decision = decide_import(as_file(person(false), "x", 1), {});
  EXPECT_EQ(decision.up, "x");
}

TEST(Import, ForcedAxesTurnEveryWayUpright) {
  const auto body = person(true);
  for (const std::string up : {"x", "y", "z", "-x", "-y", "-z"}) {
    ImportOptions forced;
    forced.up = up;
    const Mesh file = as_file(body, up, 1);
    const Points back = decide_import(file, forced).apply(file.vertices);
    EXPECT_LT((back - to_points(body)).cwiseAbs().maxCoeff(), 1e-4f) << up;
  }
}

TEST(Import, PutsTheFloorAtZeroInSpiteOfOutliers) {
  auto body = person(false);
  for (int i = 0; i < 8; ++i) body.push_back({0.5f, -1.0f - 0.3f * static_cast<float>(i), 0.2f});
  const Mesh file = as_file(body, "z", 1000, {0.3f, 0, 0.4f});
  const ImportDecision decision = decide_import(file, {});
  EXPECT_EQ(decision.units, "mm") << decision.sentence;
  EXPECT_NEAR(decision.floor, 0.4f, 0.02f);
  EXPECT_NEAR(decision.height, 1.7f, 0.03f);
}

TEST(Import, AFloorInTheScanShowsWhereDownIs) {
  for (const std::string up : {"y", "z", "-y"}) {
    auto body = person(true);
    Rng rng(9);
    for (int i = 0; i < 1500; ++i)
      body.push_back({rng.uniform(-1, 1), rng.uniform(-0.005f, 0.005f), rng.uniform(-1, 1)});
    const ImportDecision decision = decide_import(as_file(body, up, 1, file_axes(up) * Vec3(0, 0.5f, 0)), {});
    EXPECT_EQ(decision.up, up);
    EXPECT_NEAR(decision.floor, 0.5f, 0.01f) << decision.sentence;
    EXPECT_TRUE(contains(decision.sentence, "from the floor"));
  }
}

TEST(Import, SaysWhatItDecided) {
  const Mesh file = as_file(person(false), "z", 1000, {0, 0, 0.03f});
  const std::string sentence = decide_import(file, {}).sentence;
  EXPECT_EQ(sentence.rfind("units: millimetres (from the height 1", 0), 0u) << sentence;
  EXPECT_TRUE(contains(sentence, "), up: z, floor at 0.03 m")) << sentence;
}

TEST(Import, WhatIsForcedIsNotGuessed) {
  ImportOptions forced;
  forced.units = "cm";
  forced.up = "z";
  forced.floor = 0.25f;
  forced.turn_deg = 90;
  const Mesh file = as_file(person(false), "z", 1);
  const ImportDecision decision = decide_import(file, forced);
  EXPECT_EQ(decision.scale, 0.01f);
  EXPECT_EQ(decision.floor, 0.25f);
  const Points forward = decision.apply(Points(Eigen::RowVector3f(0, -100, 0)));  // -y faces +z after z up
  EXPECT_TRUE(forward.row(0).isApprox(Eigen::RowVector3f(1, -0.25f, 0), 1e-5f)) << forward;
}

TEST(Import, RefusesUnknownOptionsAndNothing) {
  const Mesh file = as_file(person(false), "y", 1);
  ImportOptions units, up;
  units.units = "furlong";
  up.up = "w";
  EXPECT_EQ(error_of([&] { decide_import(file, units); }),
            "the unit 'furlong' is not one of m, dm, cm, mm, in");
  EXPECT_NE(error_of([&] { decide_import(file, up); }), "");
  Mesh nothing;
  nothing.vertices = Points::Constant(5, 3, std::numeric_limits<float>::quiet_NaN());
  EXPECT_NE(error_of([&] { decide_import(nothing, {}); }), "");
}

TEST(Import, SurvivesNanPointsAndTinyScans) {
  auto body = person(false);
  body.push_back(Vec3::Constant(std::numeric_limits<float>::quiet_NaN()));
  body.push_back(Vec3::Constant(std::numeric_limits<float>::infinity()));
  EXPECT_EQ(decide_import(as_file(body, "y", 1), {}).units, "m");
  Warnings warnings;
  Mesh one;
  one.vertices = Points::Zero(1, 3);
  EXPECT_EQ(decide_import(one, {}).scale, 1);
  EXPECT_TRUE(warnings.contain("fits no person"));
}

TEST(Import, MakesACharacterOfArbitrarySizeAsTallAsPeopleAre) {
  Warnings warnings;
  for (const float scale :
       {1e-4f, 0.095f, 2.0f, 2.65f, 209.0f, 275.0f, 1e6f}) {  // 4.5 m and 355 units among them
    const Mesh file = as_file(person(true), "y", scale);
    const ImportDecision decision = decide_import(file, {});
    EXPECT_EQ(decision.units, "fit");
    EXPECT_NEAR(decision.apply(file.vertices).col(1).maxCoeff(), 1.7f, 0.05f);
  }
  EXPECT_TRUE(warnings.contain("fits no person in any unit"));
}

TEST(Import, AGivenHeightIsTheHeightWhateverTheUnits) {
  ImportOptions tall;
  tall.height = 1.2f;
  for (const float scale : {0.001f, 1.0f, 100.0f, 209.0f}) {
    const Mesh file = as_file(person(true), "y", scale);
    const ImportDecision decision = decide_import(file, tall);
    EXPECT_NEAR(decision.apply(file.vertices).col(1).maxCoeff(), 1.2f, 0.03f) << scale;
    EXPECT_TRUE(contains(decision.sentence, "height: 1.2 m (given)")) << decision.sentence;
  }
  tall.height = 0.01f;
  EXPECT_EQ(error_of([&] { decide_import(as_file(person(true), "y", 1), tall); }),
            "a height is 0.05 to 100 m, not 0.01");
}

TEST(Import, TakesSomebodyWhoLiesAsMetresWhateverTheHeight) {
  Warnings warnings;
  ImportOptions lying;
  lying.up = "z";  // on the back: 0.3 m high
  const ImportDecision decision = decide_import(as_file(person(false), "y", 1), lying);
  EXPECT_TRUE(warnings.contain("taken as metres"));
  EXPECT_EQ(decision.units, "m");
}

TEST(Import, KnowsTheWayBack) {
  Mesh file = as_file(person(true), "z", 100, {30, -20, 700});
  ImportOptions turned;
  turned.turn_deg = 33;
  const ImportDecision decision = decide_import(file, turned);
  ASSERT_EQ(decision.units, "cm");
  const Points world = decision.apply(file.vertices);
  const Eigen::Matrix4d back = decision.to_file();
  for (Eigen::Index v = 0; v < world.rows(); ++v) {
    const Eigen::Vector4d there = back * world.row(v).transpose().cast<double>().homogeneous();
    EXPECT_LT((there.head<3>() - file.vertices.row(v).transpose().cast<double>()).norm(), 0.01);
  }
}

// The person above a height, as a camera sees somebody behind a desk.
std::vector<Vec3> above(float height) {
  std::vector<Vec3> points = person(false);
  points.erase(std::remove_if(points.begin(), points.end(), [&](const Vec3& p) { return p.y() < height; }),
               points.end());
  return points;
}

// What an extractor gives that knows the widths of this person's trunk, 0.24 m, and shoulders, 0.58 m: 1.7 m
// tall.
std::optional<UnseenFeet> know_the_person(const Mesh& upright) {
  const Vec3 size =
      (upright.vertices.colwise().maxCoeff() - upright.vertices.colwise().minCoeff()).transpose();
  const float person = size.z() / 0.24f;
  const bool lies = std::abs(size.x() / person - 0.58f) > 0.02f;
  return UnseenFeet{1.7f * person, upright.vertices.col(1).maxCoeff() - 1.7f * person, lies ? 0.0f : 1.0f};
}

TEST(Import, TheSizeOfSomebodyWithoutFeetComesFromWhatIsSeen) {
  const std::vector<std::pair<const char*, float>> units = {
      {"m", 1}, {"dm", 10}, {"in", 1 / 0.0254f}, {"cm", 100}, {"mm", 1000}};
  for (const float cut : {0.45f, 0.85f, 1.2f})  // knees, hips, chest
    for (const auto& [unit, scale] : units)
      for (const char* up : {"y", "z"}) {
        const Mesh file = as_file(above(cut), up, scale, {0, 0, 0});
        const ImportDecision decision = decide_import(file, {}, know_the_person);
        EXPECT_EQ(decision.units, unit) << cut << decision.sentence;
        EXPECT_EQ(decision.up, up);
        const Points world = decision.apply(file.vertices);
        EXPECT_NEAR(world.col(1).maxCoeff(), 1.7f, 0.02f)
            << cut << unit;  // the head where it is on the floor
        EXPECT_NEAR(world.col(1).minCoeff(), cut, 0.03f);
        EXPECT_TRUE(contains(decision.sentence, "by what is seen")) << decision.sentence;
      }
}

TEST(Import, WhatIsSeenDecidesNothingOfAWholePerson) {
  const Mesh file = as_file(person(false), "z", 100, {30, -20, 700});
  int asked = 0;
  const ImportDecision plain = decide_import(file, {}),
                       checked = decide_import(file, {}, [&](const Mesh&upright) {
                         EXPECT_NEAR(upright.vertices.col(1).maxCoeff(), 1.7f, 0.03f);
                         ++asked;
                         return std::nullopt;
                       });
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(checked.sentence, plain.sentence);
  EXPECT_EQ(checked.scale, plain.scale);
  EXPECT_EQ(checked.floor, plain.floor);
  EXPECT_EQ(checked.axes, plain.axes);
}

TEST(Import, NobodyIsLookedAtWhereUnitsAndFloorAreGiven) {
  ImportOptions given;
  given.units = "m";
  given.floor = 0.0f;
  decide_import(as_file(above(0.85f), "y", 1), given, [](const Mesh&) -> std::optional<UnseenFeet> {
    ADD_FAILURE() << "asked";
    return std::nullopt;
  });
}

TEST(Import, WithoutFeetAFloorThatIsSeenOrGivenStays) {
  std::vector<Vec3> points = above(0.85f);
  Rng rng(5);
  for (int i = 0; i < 4000; ++i)
    points.push_back({rng.uniform(-1, 1), 0.002f * rng.normal(), rng.uniform(-1, 1)});
  const auto wrong = [](const Mesh&) -> std::optional<UnseenFeet> { return UnseenFeet{1.7f, -0.4f}; };
  EXPECT_NEAR(decide_import(as_file(points, "y", 1), {}, wrong).floor, 0, 0.02f);
  ImportOptions given;
  given.floor = 0.3f;
  EXPECT_EQ(decide_import(as_file(above(0.85f), "y", 1), given, wrong).floor, 0.3f);
}

TEST(Import, TheSameIsDecidedAgainWithoutALook) {
  for (const float scale : {1.0f, 100.0f, 209.0f}) {  // the last fits no person in any unit
    const Mesh file = as_file(above(1.2f), "z", scale, {3, -2, 7});
    ImportOptions turned;
    turned.turn_deg = 180;
    Warnings warnings;
    const ImportDecision first = decide_import(file, turned, know_the_person);
    const ImportDecision second = decide_import(file, first.again.value());
    EXPECT_NEAR(second.scale / first.scale, 1, 1e-5f);
    EXPECT_EQ(second.floor, first.floor);
    EXPECT_EQ(second.axes, first.axes);
    EXPECT_NEAR(first.apply(file.vertices).col(1).maxCoeff(), 1.7f, 0.02f);
  }
}

TEST(Import, KeepsTheFilesZeroWhenTheLowestPointsAreNearIt) {
  EXPECT_EQ(decide_import(as_file(person(false), "y", 1, {0, 0.015f, 0}), {}).floor, 0);
}

TEST(Import, PeopleBesideEachOtherStandThoughTheyAreWiderThanTall) {
  for (const bool z_up : {false, true}) {
    std::vector<Vec3> both = person(false);
    for (const Vec3& p : person(false)) both.push_back(p + Vec3(1.6f, 0, 0));
    Mesh cloud{to_points(both)};
    if (z_up) {
      const Eigen::VectorXf y = cloud.vertices.col(1);
      cloud.vertices.col(1) = -cloud.vertices.col(2);
      cloud.vertices.col(2) = y;
    }
    const ImportDecision decision = decide_import(cloud, {});
    EXPECT_EQ(decision.up, z_up ? "z" : "y");
    EXPECT_EQ(decision.units, "m");
    EXPECT_NEAR(decision.height, 1.7f, 0.03f);
  }
}

// 6 m square, the ground first, then walls of 2.6 m.
std::vector<Vec3> bare_room(int walls) {
  Rng rng(5);
  std::vector<Vec3> points;
  const auto off = [&] { return 0.005f * rng.normal(); };
  for (int i = 0; i < 6000; ++i) points.push_back({rng.uniform(-3, 3), off(), rng.uniform(-3, 3)});
  for (int k = 0; k < walls; ++k)
    for (int i = 0; i < 4000; ++i) {
      const float along = rng.uniform(-3, 3), up = rng.uniform(0, 2.6f),
                  side = (k < 2 ? -3.0f : 3.0f) + off();
      points.push_back(k % 2 == 0 ? Vec3(along, up, side) : Vec3(side, up, along));
    }
  return points;
}

std::vector<Vec3> moved(std::vector<Vec3> points, const Vec3& by) {
  for (Vec3& p : points) p += by;
  return points;
}

std::vector<Vec3> operator+(std::vector<Vec3> a, const std::vector<Vec3>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(Import, ARoomIsAsItsPeopleStandInIt) {
  const std::vector<std::pair<const char*, float>> units = {
      {"m", 1}, {"cm", 100}, {"mm", 1000}, {"in", 1 / 0.0254f}};
  for (const int walls : {0, 1, 4})
    for (const int people : {1, 3})
      for (const std::string up : {"y", "z", "x", "-y"})
        for (const auto& [unit, scale] : units) {
          std::vector<Vec3> room = bare_room(walls);
          for (int k = 0; k < people; ++k)
            room = room + moved(person(k == 1), {1.6f * static_cast<float>(k) - 1, 0, -0.7f});
          const Mesh file = as_file(room, up, scale, file_axes(up) * Vec3(0, 0.4f, 0));
          const auto decision = decide_scan_import(file, {});
          ASSERT_TRUE(decision);
          SCOPED_TRACE(decision->sentence + " of " + std::to_string(walls) + " walls");
          EXPECT_EQ(decision->units, unit);
          EXPECT_EQ(decision->up, up);
          EXPECT_NEAR(decision->floor, 0.4f, 0.02f);
          EXPECT_NEAR(decision->height, 1.7f, 0.04f);
        }
}

TEST(Import, OnlyAGroundOrWallsDecideNothing) {
  for (const int walls : {0, 2, 4}) {
    const Mesh file = as_file(bare_room(walls), "z", 100);
    EXPECT_FALSE(decide_scan_import(file, {})) << walls;
    ImportOptions given;
    given.units = "cm";
    EXPECT_FALSE(decide_scan_import(file, given)) << walls;
    given.up = "z";
    const auto decision = decide_scan_import(file, given);
    ASSERT_TRUE(decision) << walls;
    EXPECT_EQ(decision->scale, 0.01f);
  }
}

TEST(Import, AWallBehindSomebodyIsNoGround) {
  std::vector<Vec3> wall = bare_room(1);
  wall.erase(wall.begin(), wall.begin() + 6000);  // the ground
  for (const std::string up : {"y", "z"}) {
    const Mesh file = as_file(wall + moved(person(false), {0, 0, -1.5f}), up, 1000);
    const auto decision = decide_scan_import(file, {});
    ASSERT_TRUE(decision);
    EXPECT_EQ(decision->up, up) << decision->sentence;
    EXPECT_EQ(decision->units, "mm");
    EXPECT_NEAR(decision->height, 1.7f, 0.04f);
    EXPECT_NEAR(decision->floor, 0, 0.02f);
  }
}

TEST(Import, OfARoomWhatIsGivenIsNotGuessed) {
  const Mesh file = as_file(bare_room(2) + person(false), "z", 1000);
  ImportOptions given;
  given.units = "cm";
  given.up = "z";
  given.floor = 0.5f;
  const auto decision = decide_scan_import(file, given);
  ASSERT_TRUE(decision);
  EXPECT_EQ(decision->scale, 0.01f);
  EXPECT_EQ(decision->floor, 0.5f);
  ImportOptions tall;
  tall.height = 1.2f;
  EXPECT_NEAR(decide_scan_import(file, tall)->scale, 1.2f / 1700, 2e-5f);
}

TEST(Import, APersonAloneIsDecidedAlikeWithoutARoom) {
  for (const bool t_pose : {false, true})
    for (const std::string up : {"y", "z"})
      for (const float scale : {1.0f, 100.0f, 1000.0f, 209.0f}) {
        Warnings warnings;
        const Mesh file = as_file(person(t_pose), up, scale, {0.3f, 0.1f, 0.2f});
        const ImportDecision plain = decide_import(file, {});
        const auto decision = decide_scan_import(file, {});
        ASSERT_TRUE(decision);
        EXPECT_EQ(decision->sentence, plain.sentence);
        EXPECT_EQ(decision->to_file(), plain.to_file());
      }
}

TEST(Import, OnStairsUpIsWhereTheyLead) {
  for (const std::string up : {"y", "z"}) {
    Rng rng(2);
    std::vector<Vec3> stairs;
    for (int step = 0; step < 8; ++step)
      for (int i = 0; i < 900; ++i) {
        const float x = rng.uniform(-0.7f, 0.7f), at = rng.uniform(0, 0.48f), k = static_cast<float>(step);
        stairs.push_back(at < 0.3f ? Vec3(x, 0.18f * k, 0.3f * k + at)
                                   : Vec3(x, 0.18f * k + at - 0.3f, 0.3f * k + 0.3f));
      }
    const Mesh file = as_file(stairs + moved(person(false), {0, 0.54f, 1.05f}), up, 1000);
    const auto decision = decide_scan_import(file, {});
    ASSERT_TRUE(decision);
    EXPECT_EQ(decision->units, "mm") << decision->sentence;
    EXPECT_EQ(decision->up, up) << decision->sentence;
  }
}

TEST(Import, PointsInOnePlaneDecideNothingHoweverItLies) {
  Rng rng(2);
  Mesh plane;
  plane.vertices.resize(5000, 3);
  for (auto row : plane.vertices.rowwise()) {
    const float a = rng.uniform(-1, 1), b = rng.uniform(-1, 1);
    row << a, 0.7f * a + b, 0.3f * b;
  }
  EXPECT_FALSE(decide_scan_import(plane, {}));
}

TEST(Import, FiveMillionPointsAreDecidedFrom) {
  const std::vector<Vec3> room = bare_room(2) + person(false);
  Mesh dense;
  dense.vertices.resize(5000000, 3);
  Rng rng(2);
  for (auto row : dense.vertices.rowwise()) {
    const Vec3& p = room[rng.below(static_cast<int>(room.size()))];
    row << p.x() + rng.uniform(-0.02f, 0.02f), p.y(), p.z();
  }
  const auto decision = decide_scan_import(dense, {});
  ASSERT_TRUE(decision);
  EXPECT_EQ(decision->units + decision->up, "my") << decision->sentence;
  EXPECT_NEAR(decision->height, 1.7f, 0.04f);
}

}  // namespace
}  // namespace understudy
