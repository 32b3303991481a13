#include "retarget/character/joined_characters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "retarget/character/character_export.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::tests {
namespace {

using test::TempFolder;

constexpr double kRate = 25;

/// A character on its own rig, and what it performs somewhere in the scene.
struct Dancer {
  Dancer(Character file, const CharacterOptions& options, const Vec3& from, int frames)
      : character(prepare_character(std::move(file), nullptr, nullptr, options)),
        screen(character, nullptr),
        clip{"dance", kRate, made_motion(frames, character.target.joints)} {
    for (Pose& pose : clip.poses) pose.root += from;
  }
  CharacterPerformance performing(const std::string& name, const CharacterExportOptions& options = {}) const {
    return {character, screen, {clip}, options, name};
  }
  /// [V, 3] of the parts' vertices, metres in the scene.
  Points on_screen(size_t frame) const {
    return screen.deform(clip.poses[frame])(character.surface.map, Eigen::all);
  }
  Eigen::Index vertices() const { return character.character.vertex_count(); }

  PreparedCharacter character;
  RigDeformer screen;
  CharacterClip clip;
};

Character turned_to_z_up(Character character) {
  CharacterNode root;
  root.name = "Z up";
  root.local.rotation = Eigen::AngleAxisf(kPi / 2, Vec3::UnitX());
  add_root(character, root);
  return character;
}

/// In centimetres, in A-pose, facing aside.
Dancer in_centimetres(int frames = 30) {
  MadeCharacter made;
  made.unit = 0.01f, made.arms_down_deg = 45, made.heading_deg = 90;
  return {make_character(made), {}, Vec3(1.5f, 0, -2), frames};
}

/// In metres with z up.
Dancer z_up(int frames = 30) {
  MadeCharacter made;
  made.naming = Naming::Rigify;
  CharacterOptions options;
  options.up = "z";
  return {turned_to_z_up(make_character(made)), options, Vec3(-1, 0, 0.7f), frames};
}

Character written(const TempFolder& folder, const std::vector<CharacterPerformance>& performances,
                  ExportCost* cost = nullptr) {
  const ExportCost found = export_character(folder.path("all.glb"), performances);
  if (cost != nullptr) *cost = found;
  return read_character(folder.path("all.glb"));
}

float largest_mm(const Points& a, const Points& b) {
  return 1000 * (a - b).rowwise().norm().maxCoeff();
}

int node_called(const Character& file, const std::string& name) {
  for (size_t n = 0; n < file.nodes.size(); ++n)
    if (file.nodes[n].name == name) return static_cast<int>(n);
  return -1;
}

TEST(SeveralPerformers, MoveInOneFileAsTheyDoOnScreenWhateverTheirUnitsAndAxes) {
  const TempFolder folder;
  const Dancer ann = in_centimetres(), bob = z_up();
  ASSERT_NEAR(ann.character.to_world.scale, 0.01f, 1e-4f);
  ASSERT_FALSE(bob.character.to_world.R.isApprox(Mat3::Identity(), 0.1f));
  ExportCost cost;
  const Character file = written(folder, {ann.performing("Ann"), bob.performing("Bob")}, &cost);
  ASSERT_EQ(file.animations.size(), 1u);
  EXPECT_EQ(file.animations[0].name, "dance");
  ASSERT_EQ(file.vertex_count(), ann.vertices() + bob.vertices());
  for (const size_t frame : {0u, 7u, 16u, 29u}) {
    const Points all = vertices_at(file, 0, ann.clip.seconds(frame));
    EXPECT_LT(largest_mm(all.topRows(ann.vertices()), ann.on_screen(frame)), 0.1f) << frame;
    EXPECT_LT(largest_mm(all.bottomRows(bob.vertices()), bob.on_screen(frame)), 0.1f) << frame;
  }
  EXPECT_LT(cost.largest_mm, 0.1);
  EXPECT_EQ(cost.frames, 60);
}

TEST(SeveralPerformers, EachHangsOnANodeWithTheirNameWhereTheyStart) {
  const TempFolder folder;
  const Dancer ann = in_centimetres(2), bob = z_up(2);
  const Character file = written(folder, {ann.performing("Ann"), bob.performing("Bob")});
  for (const auto& [name, dancer] : {std::pair{"Ann", &ann}, {"Bob", &bob}}) {
    const int top = node_called(file, name);
    ASSERT_GE(top, 0) << name;
    const Joints& rest = dancer->character.target.joints;
    const Vec3 way = dancer->clip.poses[0].root - Vec3(rest.row(Pelvis).transpose());
    EXPECT_LT((file.nodes[static_cast<size_t>(top)].local.translation - Vec3(way.x(), 0, way.z())).norm(),
              1e-5f);
    EXPECT_EQ(file.nodes[static_cast<size_t>(top)].parent, -1);
    for (const CharacterTrack& track : file.animations[0].tracks)
      EXPECT_TRUE(file.is_at_or_below(track.node, node_called(file, "Ann")) ||
                  file.is_at_or_below(track.node, node_called(file, "Bob")));
  }
  for (const CharacterPart& part : file.parts)
    EXPECT_EQ(file.nodes[static_cast<size_t>(part.node)].parent, -1) << "a skinned mesh is at the top";
  for (const CharacterSkin& skin : file.skins)
    for (const int joint : skin.joints)
      EXPECT_EQ(file.is_at_or_below(joint, node_called(file, "Ann")),
                file.is_at_or_below(skin.joints[0], node_called(file, "Ann")));
  // Not played they stand in their bind poses, each on their spot.
  const Points still = vertices_at(file, -1, 0);
  const Vec3 apart = file.nodes[static_cast<size_t>(node_called(file, "Ann"))].local.translation -
                     file.nodes[static_cast<size_t>(node_called(file, "Bob"))].local.translation;
  const Vec3 seen =
      (still.topRows(ann.vertices()).colwise().mean() - still.bottomRows(bob.vertices()).colwise().mean())
          .transpose();
  EXPECT_LT((seen - apart).cwiseProduct(Vec3(1, 0, 1)).norm(), 0.1f);
}

TEST(SeveralPerformers, OneAloneIsWrittenAsEverWithoutANodeAbove) {
  const TempFolder folder;
  const Dancer ann = in_centimetres(3);
  export_character(folder.path("named.glb"), {ann.performing("Ann")});
  export_character(folder.path("plain.glb"), {ann.performing("")});
  EXPECT_EQ(read_file(folder.path("named.glb")), read_file(folder.path("plain.glb")));
  EXPECT_EQ(node_called(read_character(folder.path("named.glb")), "Ann"), -1);
}

TEST(SeveralPerformers, TheStatedErrorIsThatOfThemAll) {
  const TempFolder folder;
  const Dancer ann = in_centimetres(10), bob = z_up(10);
  BulgingDeformer bulging(0.05f);  // the file has no shapes, so it cannot have the offsets
  bulging.bind(bob.character.target.mesh.vertices, bob.character.target.joints);
  CharacterExportOptions options;
  options.their_rig = false;
  const CharacterPerformance off{bob.character, bulging, {bob.clip}, options, "Bob"};
  ExportCost alone, first, last;
  written(folder, {off}, &alone);
  written(folder, {off, ann.performing("Ann")}, &first);
  written(folder, {ann.performing("Ann"), off}, &last);
  ASSERT_GT(alone.largest_mm, 1);
  EXPECT_NEAR(first.largest_mm, alone.largest_mm, 0.05);
  EXPECT_NEAR(last.largest_mm, alone.largest_mm, 0.05);
  const auto share =
      static_cast<double>(bob.vertices()) / static_cast<double>(ann.vertices() + bob.vertices());
  EXPECT_NEAR(first.mean_mm, share * alone.mean_mm, 0.05);
  EXPECT_NEAR(last.mean_mm, share * alone.mean_mm, 0.05);
}

TEST(SeveralPerformers, TheTPoseAndMotionsInPlaceAreWhereEachStarts) {
  const TempFolder folder;
  const Dancer ann = in_centimetres(20), bob = z_up(20);
  CharacterExportOptions options;
  options.in_place = options.t_pose_clip = true;
  ExportCost cost;
  const Character file =
      written(folder, {ann.performing("Ann", options), bob.performing("Bob", options)}, &cost);
  ASSERT_EQ(file.animations.size(), 2u);
  EXPECT_EQ(file.animations[0].name, "T-pose");
  EXPECT_EQ(file.animations[1].name, "dance");
  EXPECT_LT(cost.largest_mm, 0.1);
  for (const auto& [animation, frame] : {std::pair{0, 0u}, {1, 0u}, {1, 19u}}) {
    const Points all = vertices_at(file, animation, ann.clip.seconds(frame));
    const Vec3 a = all.topRows(ann.vertices()).colwise().mean().transpose(),
               b = all.bottomRows(bob.vertices()).colwise().mean().transpose();
    EXPECT_NEAR(a.x(), ann.clip.poses[0].root.x(), 0.2f) << animation << " " << frame;
    EXPECT_NEAR(a.z(), ann.clip.poses[0].root.z(), 0.2f) << animation << " " << frame;
    EXPECT_NEAR(b.x(), bob.clip.poses[0].root.x(), 0.2f) << animation << " " << frame;
  }
}

TEST(SeveralPerformers, ARootBoneCarriesEachOnTheirPath) {
  const TempFolder folder;
  const Dancer ann = in_centimetres(20), bob = z_up(20);
  CharacterExportOptions options;
  options.root_motion = true;
  ExportCost cost;
  const Character file =
      written(folder, {ann.performing("Ann", options), bob.performing("Bob", options)}, &cost);
  EXPECT_LT(cost.largest_mm, 0.1);
  EXPECT_EQ(file.nodes[static_cast<size_t>(node_called(file, "Root"))].parent, node_called(file, "Ann"));
  EXPECT_EQ(file.nodes[static_cast<size_t>(node_called(file, "Bob:Root"))].parent, node_called(file, "Bob"));
}

TEST(SeveralPerformers, OfOneCharacterHaveNoNameInCommon) {
  const TempFolder folder;
  const Dancer ann = in_centimetres(2);
  const Character file =
      written(folder, {ann.performing("Ann"), ann.performing("Ann"), ann.performing("Upper node")});
  std::set<std::string> names;
  for (const CharacterNode& node : file.nodes) EXPECT_TRUE(names.insert(node.name).second) << node.name;
  EXPECT_EQ(names.count("Ann 2") + names.count("mixamorig:Hips") + names.count("Ann 2:mixamorig:Hips"), 3u);
}

/// Of each part the picture that its material names, by the bytes; empty: it has none.
std::vector<std::string> pictures(const Character& file) {
  using nlohmann::json;
  std::vector<std::string> out;
  for (const CharacterPart& part : file.parts) {
    out.emplace_back();
    const auto material = json::parse(file.materials.at(static_cast<size_t>(part.material)));
    const auto& look = material.at("pbrMetallicRoughness");
    if (!look.contains("baseColorTexture")) continue;
    const auto texture = json::parse(file.textures.at(look["baseColorTexture"]["index"].get<size_t>()));
    out.back() = file.images.at(texture["source"].get<size_t>()).bytes +
                 (texture.contains("sampler") ? file.samplers.at(texture["sampler"].get<size_t>()) : "");
  }
  return out;
}

/// Shirt and trousers in two pictures, of which one is its own; the trousers' is named in an extension, too.
Character in_two_pictures(Character out) {
  out.images.insert(out.images.begin(), {"own", "image/png", made_picture() + "more"});
  out.samplers.insert(out.samplers.begin(), R"({"magFilter":9728})");
  out.textures = {R"({"sampler":0,"source":0})", R"({"sampler":1,"source":1})"};
  out.materials[0] = R"({"name":"shirt","pbrMetallicRoughness":{"baseColorTexture":{"index":1}}})";
  out.materials[1] = R"({"extensions":{"KHR_materials_clearcoat":{"clearcoatTexture":{"index":0}}},)"
                     R"("name":"trousers","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  out.extensions = {"KHR_materials_clearcoat"};
  return out;
}

TEST(SeveralPerformers, KeepTheirMaterialsAndShareEqualPictures) {
  const TempFolder folder;
  Dancer ann = in_centimetres(2), bob = z_up(2);
  bob.character.character = in_two_pictures(bob.character.character);
  ann.character.character.extensions = {"KHR_texture_transform"};
  ann.character.character.materials[0] = R"({"pbrMetallicRoughness":{"baseColorTexture":)"
                                         R"({"extensions":{"KHR_texture_transform":{}},"index":0}}})";
  const Character file = written(folder, {ann.performing("Ann"), bob.performing("Bob")});
  const std::string common = made_picture() + R"({"wrapS":33071})";
  EXPECT_EQ(pictures(file), (std::vector<std::string>{common, "", common,
                                                      made_picture() + "more" + R"({"magFilter":9728})"}));
  EXPECT_EQ(file.images.size(), 2u);
  EXPECT_EQ(file.textures.size(), 2u);
  EXPECT_EQ(file.extensions, (std::vector<std::string>{"KHR_materials_clearcoat", "KHR_texture_transform"}));
  const auto coat = nlohmann::json::parse(file.materials.at(3))["extensions"]["KHR_materials_clearcoat"];
  EXPECT_EQ(coat["clearcoatTexture"]["index"], 1);
}

TEST(SeveralPerformers, PlayTheirClipsTogetherAndKeepTheirOwnApart) {
  const TempFolder folder;
  Dancer ann = in_centimetres(4), bob = z_up(4);
  for (Dancer* dancer : {&ann, &bob}) {
    CharacterTrack nod;
    nod.node = dancer->character.map.node[Head];
    nod.times = {0, 1};
    nod.values = {0, 0, 0, 1, 0.1f, 0, 0, 0.995f};
    dancer->character.character.animations = {{"nod", {nod}}};
  }
  CharacterExportOptions options;
  options.keep_clips = true;
  CharacterPerformance twice = bob.performing("Bob", options);
  twice.clips.push_back({"encore", kRate, bob.clip.poses});
  const Character file = written(folder, {ann.performing("Ann", options), twice});
  std::vector<std::string> names;
  for (const auto& animation : file.animations) names.push_back(animation.name);
  ASSERT_EQ(names, (std::vector<std::string>{"dance", "encore", "nod", "Bob:nod"}));
  const int a = node_called(file, "Ann"), b = node_called(file, "Bob");
  const auto moves = [&](size_t animation, int top) {
    const auto& tracks = file.animations[animation].tracks;
    return std::any_of(tracks.begin(), tracks.end(),
                       [&](const auto& track) { return file.is_at_or_below(track.node, top); });
  };
  EXPECT_TRUE(moves(0, a) && moves(0, b));
  EXPECT_TRUE(!moves(1, a) && moves(1, b));
  EXPECT_TRUE(moves(2, a) && !moves(2, b));
  EXPECT_TRUE(!moves(3, a) && moves(3, b));
}

TEST(SeveralPerformers, HaveShapesOfTheirOwn) {
  const TempFolder folder;
  const Dancer ann = in_centimetres(20);
  const PreparedCharacter other = prepare_character(make_character(), nullptr, nullptr);
  BulgingDeformer bulging(0.03f);
  bulging.bind(other.target.mesh.vertices, other.target.joints);
  CharacterExportOptions options;
  options.their_rig = false, options.influences = 8, options.shapes = 3;
  const CharacterPerformance bob{
      other, bulging, {{"dance", kRate, made_motion(20, other.target.joints)}}, options, "Bob"};
  ExportCost alone, both;
  const Character one = written(folder, {bob}, &alone);
  const Character file = written(folder, {ann.performing("Ann"), bob}, &both);
  EXPECT_TRUE(file.parts[0].shapes.empty());
  EXPECT_EQ(file.parts.back().shapes.size(), one.parts.back().shapes.size());
  EXPECT_NEAR(both.largest_mm, alone.largest_mm, 0.05);
}

}  // namespace
}  // namespace understudy::tests
