#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::tests {
namespace {

using nlohmann::json;
using test::contains;
using test::error_of;
using test::TempFolder;

float largest_difference(const Points& a, const Points& b) {
  return a.rows() == b.rows() ? (a - b).rowwise().norm().maxCoeff() : 1e9f;
}

Character written_and_read(const Character& character, const std::string& name) {
  const TempFolder folder;
  const std::string path = folder.path(name);
  write_gltf_character(path, character);
  return read_character(path);
}

/// A small glTF as JSON, to be broken by a test.
json broken_base() {
  const TempFolder folder;
  write_gltf_character(folder.path("a.gltf"), make_character());
  return json::parse(read_file(folder.path("a.gltf")));
}

std::string complaint_about(const json& gltf) {
  const std::string text = gltf.dump(), path = "broken.gltf";
  return error_of([&] { parse_gltf_character(text, path); });
}

TEST(CharacterFile, RoundTripKeepsEverything) {
  for (const char* name : {"a.glb", "a.gltf"}) {
    const Character made = make_character(), read = written_and_read(made, name);
    ASSERT_EQ(read.parts.size(), 2u);
    EXPECT_EQ(read.parts[0].name, "Upper");
    EXPECT_LT(largest_difference(read.parts[0].vertices, made.parts[0].vertices), 1e-7f);
    EXPECT_EQ(read.parts[0].faces, made.parts[0].faces);
    EXPECT_LT((read.parts[0].uvs[0] - made.parts[0].uvs[0]).norm(), 1e-5f);
    EXPECT_NEAR(read.parts[1].colors(0, 0), 0.5f, 1e-6f);
    EXPECT_EQ(read.materials.size(), 2u);
    EXPECT_TRUE(contains(read.materials[0], "baseColorTexture"));
    EXPECT_EQ(read.images[0].bytes, made_picture());
    EXPECT_TRUE(contains(read.samplers[0], "33071"));
    EXPECT_EQ(read.nodes[1].name, "mixamorig:Hips");
    EXPECT_LT(largest_difference(posed_vertices(read, read.world()), posed_vertices(made, made.world())),
              1e-5f);
  }
}

TEST(CharacterFile, RoundTripKeepsShapesAndAnimations) {
  Character made = make_character();
  Points shape = Points::Zero(made.parts[0].vertices.rows(), 3);
  shape(7, 1) = 0.25f;
  made.parts[0].shapes = {shape};
  made.nodes[static_cast<size_t>(made.parts[0].node)].shape_weights = {0.0f};
  CharacterTrack turn{
      1 + LeftElbow, TrackPath::Rotation, TrackInterpolation::Linear, {0, 1}, {0, 0, 0, 1, 1, 0, 0, 0}};
  CharacterTrack grow{made.parts[0].node, TrackPath::Shapes, TrackInterpolation::Step, {0, 1}, {0, 1}};
  made.animations.push_back({"wave", {turn, grow}});
  const Character read = written_and_read(made, "a.glb");
  ASSERT_EQ(read.animations.size(), 1u);
  EXPECT_EQ(read.animations[0].name, "wave");
  for (const float t : {0.0f, 0.3f, 0.5f, 1.0f, 2.0f})
    EXPECT_LT(largest_difference(vertices_at(read, 0, t), vertices_at(made, 0, t)), 1e-5f) << t;
  EXPECT_GT(largest_difference(vertices_at(read, 0, 0), vertices_at(read, 0, 1)), 0.1f);
}

TEST(CharacterFile, BindPoseIsNotTheNodesPose) {
  MadeCharacter options;
  options.nodes_posed = true;
  const Character posed = make_character(options), straight = make_character();
  const Points bound = bind_pose(posed).vertices;
  EXPECT_LT(largest_difference(bound, posed_vertices(straight, straight.world())), 1e-4f);
  EXPECT_GT(largest_difference(bound, posed_vertices(posed, posed.world())), 0.1f);
}

TEST(CharacterFile, MergedSurfaceJoinsCornersThatDifferInTextureOnly) {
  Character character = character_of_mesh({test::four_points(), Faces{{0, 1, 2}, {0, 2, 3}}, {}}, "x");
  CharacterPart& part = character.parts[0];
  part.vertices.conservativeResize(5, 3);
  part.vertices.row(4) = part.vertices.row(0);
  part.faces(1, 0) = 4;
  part.normals.resize(0, 3);
  const MergedSurface merged = merged_surface(character, part.vertices);
  EXPECT_EQ(merged.mesh.vertices.rows(), 4);
  EXPECT_EQ(merged.map[4], 0);
  EXPECT_EQ(merged.mesh.faces(1, 0), 0);
}

TEST(CharacterFile, TruncatedFilesAreRefusedWithTheirName) {
  const TempFolder folder;
  write_gltf_character(folder.path("a.glb"), make_character());
  const std::string whole = read_file(folder.path("a.glb"));
  for (const double share : {0.0001, 0.01, 0.3, 0.9, 0.999}) {
    const std::string path = folder.write(
        "cut.glb", whole.substr(0, static_cast<size_t>(share * static_cast<double>(whole.size()))));
    EXPECT_TRUE(contains(error_of([&] { read_character(path); }), "cut.glb")) << share;
  }
}

TEST(CharacterFile, DamagedBytesNeverCrash) {
  const TempFolder folder;
  write_gltf_character(folder.path("a.glb"), make_character());
  const std::string whole = read_file(folder.path("a.glb")), path = "damaged.glb";
  Rng rng(5);
  for (int round = 0; round < 200; ++round) {
    std::string bytes = whole;
    for (int i = 0; i < 6; ++i)
      bytes[static_cast<size_t>(rng.uniform(0, 1) * 6000)] =
          static_cast<char>(static_cast<unsigned char>(rng.uniform(0, 255)));
    error_of([&] { parse_gltf_character(bytes, path); });
  }
}

TEST(CharacterFile, AccessorPastItsBufferIsRefused) {
  json gltf = broken_base();
  gltf["accessors"][0]["count"] = 4000000000ull;
  EXPECT_TRUE(contains(complaint_about(gltf), "reaches beyond"));
}

TEST(CharacterFile, NegativeStrideIsRefused) {
  json gltf = broken_base();
  gltf["bufferViews"][0]["byteStride"] = -12;
  EXPECT_TRUE(contains(complaint_about(gltf), "'byteStride' is negative"));
}

TEST(CharacterFile, OtherVersionsOfGltfAreRefused) {
  json gltf = broken_base();
  gltf["asset"]["version"] = "1.0";
  EXPECT_TRUE(contains(complaint_about(gltf), "broken.gltf: is glTF version 1.0, only 2 is read"));
  gltf["asset"] = {{"version", "2.1"}, {"minVersion", "3.0"}};
  EXPECT_TRUE(contains(complaint_about(gltf), "version 3.0"));
  gltf["asset"] = {{"version", "2.1"}};
  EXPECT_EQ(complaint_about(gltf), "");
}

TEST(CharacterFile, ABoneThatASkinNamesTwiceIsRefused) {
  json gltf = broken_base();
  gltf["skins"][0]["joints"][4] = gltf["skins"][0]["joints"][3];
  EXPECT_TRUE(contains(complaint_about(gltf), "broken.gltf: a skin names the bone 'mixamorig:"))
      << complaint_about(gltf);
  EXPECT_TRUE(contains(complaint_about(gltf), "' twice"));
}

TEST(CharacterFile, AMissingBufferIsToldWithBothFiles) {
  json gltf = broken_base();
  gltf["buffers"][0]["uri"] = "gone.bin";
  const std::string complaint = complaint_about(gltf);
  EXPECT_TRUE(contains(complaint, "broken.gltf: buffer 0, gone.bin: there is no such file")) << complaint;
}

TEST(CharacterFile, PicturesThatOnlyExtensionsNameAreKeptAsTheyCame) {
  json gltf = broken_base();
  const std::string picture = read_file(US_SOURCE_DIR "/tests/fuzz/corpus/picture/lossless.webp");
  const std::string packed = "data:application/octet-stream;base64,q0tUWCAyMLsNChoKAAAAAAAAAAA=";  // KTX2
  const TempFolder folder;
  folder.write("a.webp", picture);
  gltf["images"] = {{{"uri", "a.webp"}, {"name", "skin"}}, {{"uri", packed}}};
  gltf["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}},
                      {{"source", 0}, {"extensions", {{"KHR_texture_basisu", {{"source", 1}}}}}}};
  gltf["extensionsUsed"] = {"EXT_texture_webp", "KHR_texture_basisu", "EXT_never_used"};
  gltf["extensionsRequired"] = {"EXT_texture_webp"};
  const Character read = read_character(folder.write("a.gltf", gltf.dump()));
  const Character again = written_and_read(read, "b.glb");
  ASSERT_EQ(again.images.size(), 2u);
  EXPECT_EQ(again.images[0].bytes, picture);
  EXPECT_EQ(again.images[0].mime, "image/webp");
  EXPECT_EQ(again.images[1].mime, "image/ktx2");
  EXPECT_EQ(again.textures, read.textures);
  EXPECT_EQ(again.extensions, (std::vector<std::string>{"EXT_texture_webp", "KHR_texture_basisu"}));
  EXPECT_EQ(again.required, std::vector<std::string>{"EXT_texture_webp"});
  gltf["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 7;
  folder.write("a.gltf", gltf.dump());
  EXPECT_TRUE(
      contains(error_of([&] { read_character(folder.path("a.gltf")); }), "names number 7 of its 2 sources"));
}

TEST(CharacterFile, NodesInACircleAreRefused) {
  json gltf = broken_base();
  gltf["nodes"].push_back({{"children", {gltf["nodes"].size() + 1}}});
  gltf["nodes"].push_back({{"children", {gltf["nodes"].size() - 1}}});
  EXPECT_TRUE(contains(complaint_about(gltf), "in a circle"));
  json twice = broken_base();
  twice["nodes"].push_back({{"children", {3}}});
  EXPECT_TRUE(contains(complaint_about(twice), "child of two nodes"));
}

TEST(CharacterFile, TenThousandLevelsAreRefused) {
  json gltf = broken_base();
  const size_t first = gltf["nodes"].size();
  for (size_t i = 0; i < 10000; ++i) gltf["nodes"].push_back({{"children", {first + i + 1}}});
  gltf["nodes"].push_back(json::object());
  EXPECT_TRUE(contains(complaint_about(gltf), "1000 levels"));
}

TEST(CharacterFile, JsonNestedWithoutEndIsRefused) {
  const std::string path = "deep.gltf";
  for (const size_t depth : {300u, 200000u}) {
    const std::string text =
        R"({"asset":{},"materials":[{"extras":)" + std::string(depth, '[') + std::string(depth, ']') + "}]}";
    EXPECT_TRUE(contains(error_of([&] { parse_gltf_character(text, path); }), "nested more than 200 levels"));
  }
}

TEST(CharacterFile, BytesNamedAgainAndAgainAreRefused) {
  json gltf = broken_base();
  gltf["accessors"].push_back(
      json::parse(R"({"componentType":5126,"count":2000000,"type":"MAT4","sparse":{"count":0,)"
                  R"("indices":{"bufferView":0,"componentType":5123},"values":{"bufferView":0}}})"));
  for (auto& skin : gltf["skins"]) skin["inverseBindMatrices"] = gltf["accessors"].size() - 1;
  const json first = gltf["skins"][0];
  for (int i = 0; i < 5; ++i) gltf["skins"].push_back(first);
  EXPECT_TRUE(contains(complaint_about(gltf), "broken.gltf: unpacks to more than"));
  json pictures = broken_base();
  for (int i = 0; i < 300; ++i) pictures["images"].push_back(pictures["images"][0]);
  EXPECT_EQ(complaint_about(pictures), "");  // small things may be named often
}

TEST(CharacterFile, ListsThatWouldTakeManyTimesTheFileAreRefused) {
  const std::string path = "many.gltf";
  for (const char* name : {"nodes", "meshes", "skins", "accessors", "animations", "images"}) {
    std::string text = std::string(R"({"asset":{"version":"2.0"},")") + name + "\":[{}";
    for (int i = 0; i < 5000; ++i) text += ",{}";
    const std::string complaint = error_of([&] { parse_gltf_character(text + "]}", path); });
    EXPECT_TRUE(contains(complaint, "lists 5001 things, more than a file of its size may")) << complaint;
  }
}

TEST(CharacterFile, MaterialsTexturesAndSamplersStayAsTheyCame) {
  json gltf = broken_base();
  gltf["materials"][0]["extras"] = {
      {"nothing", nullptr}, {"large", 12345678901234}, {"empty", json::array()}};
  gltf["materials"][0]["alphaCutoff"] = 0.5;
  gltf["samplers"][0]["name"] = "tiles";
  const TempFolder folder;
  for (const char* name : {"b.glb", "b.gltf"}) {
    const Character read = read_character(folder.write("a.gltf", gltf.dump()));
    const Character again = written_and_read(read, name);
    EXPECT_EQ(json::parse(again.materials[0]), gltf["materials"][0]);
    EXPECT_EQ(json::parse(again.samplers[0]), gltf["samplers"][0]);
    EXPECT_EQ(again.textures, read.textures);
  }
}

TEST(CharacterFile, BuffersMayBeLargerThanToldAndOfAnyName) {
  json gltf = broken_base();
  std::string uri = gltf["buffers"][0]["uri"];
  std::string lines = uri;
  for (size_t i = 40; i < lines.size(); i += 77) lines.insert(i, "\n");
  gltf["buffers"][0]["uri"] = lines + "AAAA";
  EXPECT_EQ(complaint_about(gltf), "");
  const TempFolder folder;
  const Character made = make_character();
  write_gltf_character(folder.path("a.glb"), made);
  const std::string glb = read_file(folder.path("a.glb"));
  uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  folder.write("a+b c.bin", glb.substr(28 + length) + "more");
  gltf["buffers"][0]["uri"] = "a+b%20c.bin";
  const Character read = read_character(folder.write("a.gltf", gltf.dump()));
  EXPECT_EQ(read.parts[0].vertices, made.parts[0].vertices);
  gltf["buffers"][0]["byteLength"] = glb.size();
  folder.write("a.gltf", gltf.dump());
  EXPECT_TRUE(contains(error_of([&] { read_character(folder.path("a.gltf")); }), "bytes, it should hold"));
}

TEST(CharacterFile, NamesThatAreNoUtf8AreWrittenAllTheSame) {
  Character made = make_character();
  made.nodes[0].name = "B\xe9n\xe9";
  EXPECT_EQ(written_and_read(made, "a.glb").nodes[0].name, "B\xef\xbf\xbdn\xef\xbf\xbd");
}

TEST(CharacterFile, UrisOutsideOfTheFolderAreRefused) {
  for (const char* uri : {"../../etc/passwd", "/etc/passwd", "a/../../b.bin", "%2e%2e/b.bin"}) {
    json gltf = broken_base();
    gltf["buffers"][0]["uri"] = uri;
    EXPECT_TRUE(contains(complaint_about(gltf), "outside of the file's folder")) << uri;
  }
  json gltf = broken_base();
  gltf["buffers"][0]["uri"] = "https://example.org/b.bin";
  EXPECT_TRUE(contains(complaint_about(gltf), "on the network"));
}

TEST(CharacterFile, DataThatAreNoBase64AreRefused) {
  json gltf = broken_base();
  gltf["buffers"][0]["uri"] = "data:application/octet-stream;base64,%%%%";
  EXPECT_TRUE(contains(complaint_about(gltf), "not base64"));
}

TEST(CharacterFile, PicturesThatAreNoneAreRefused) {
  json gltf = broken_base();
  gltf["images"][0] = {{"uri", "data:image/png;base64,SGVsbG8="}, {"name", "face"}};
  EXPECT_TRUE(contains(complaint_about(gltf), "'face' is not a picture"));
}

TEST(CharacterFile, AMissingPictureBecomesWhiteWithAWarning) {
  json gltf = broken_base();
  gltf["images"][0] = {{"uri", "gone.png"}};
  test::Warnings warnings;
  const std::string text = gltf.dump(), path = "/tmp/nowhere/x.gltf";
  const Character character = parse_gltf_character(text, path);
  EXPECT_EQ(character.images[0].mime, "image/png");
  EXPECT_TRUE(warnings.contain("gone.png"));
}

TEST(CharacterFile, WeightsAndBonesThatDoNotFitAreRefused) {
  json gltf = broken_base();
  gltf["skins"][0]["joints"].erase(gltf["skins"][0]["joints"].size() - 3);
  for (int i = 0; i < 8; ++i) gltf["skins"][0]["joints"].erase(0);
  EXPECT_TRUE(contains(complaint_about(gltf), "bone that its skin does not have"));
}

TEST(CharacterFile, ReadsObjWithMaterialsAndPictures) {
  const TempFolder folder;
  folder.write("tex/cloth.png", made_picture());
  folder.write("a.mtl",
               "newmtl red shirt\nKd 1 0 0\nmap_Kd tex\\cloth.png\nnewmtl skin\nKd 0.9 0.7 0.6\nd 0.5\n");
  const std::string path = folder.write(
      "a.obj",
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl red shirt\n"
      "f 1/1 2/2 3/3\nusemtl skin\nf -4 -2 -1\n");
  const Character character = read_character(path);
  ASSERT_EQ(character.parts.size(), 2u);
  EXPECT_EQ(character.parts[0].name, "red shirt");
  EXPECT_FLOAT_EQ(character.parts[0].uvs[0](0, 1), 1.0f);
  EXPECT_EQ(character.images.size(), 1u);
  EXPECT_TRUE(contains(character.materials[1], "BLEND"));
  EXPECT_TRUE(character.parts[1].uvs.empty());
}

TEST(CharacterFile, ObjSaysWhatIsWrong) {
  const TempFolder folder;
  const auto complaint = [&](const std::string& text) {
    const std::string path = folder.write("b.obj", text);
    return error_of([&] { read_character(path); });
  };
  EXPECT_TRUE(
      contains(complaint("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "line 4: a face names number 9 of 3"));
  EXPECT_TRUE(contains(complaint("v 0 0 0\nmtllib ../../x.mtl\n"), "outside of its folder"));
  EXPECT_TRUE(contains(complaint("v 0 zero 0\n"), "b.obj"));
}

TEST(CharacterFile, ReadsPlainMeshesAsOnePart) {
  const TempFolder folder;
  const std::string path =
      folder.write("a.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 2 3\n");
  const Character character = read_character(path);
  EXPECT_EQ(character.parts.size(), 1u);
  EXPECT_EQ(character.parts[0].faces.rows(), 2);
  EXPECT_EQ(character.materials.size(), 1u);
}

// COLLADA is text, so that a test can write one; it goes the same way as FBX.
std::string made_collada() {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#pa" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="body" name="body"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST(ImportProcess, ReadsWhatAnotherProcessMade) {
  const TempFolder folder;
  ReadCharacterOptions options;
  options.worker = US_PROGRAM;
  const Character character = read_character(folder.write("a.dae", made_collada()), options);
  EXPECT_EQ(character.vertex_count(), 3);
  EXPECT_EQ(character.name, "a");
}

TEST(ImportProcess, DamagedFilesAreOneSentence) {
  const TempFolder folder;
  ReadCharacterOptions options;
  options.worker = US_PROGRAM;
  const std::string path = folder.write("bad.fbx", "Kaydara FBX Binary  \0\x1a\0 nonsense");
  const std::string complaint = error_of([&] { read_character(path, options); });
  EXPECT_TRUE(contains(complaint, "bad.fbx: ")) << complaint;
  EXPECT_EQ(complaint.find('\n'), complaint.npos);
}

TEST(ImportProcess, CrashesHangsAndMissingProgramsAreOneSentence) {
  const TempFolder folder;
  const std::string file = folder.write("a.fbx", "Kaydara FBX Binary  ");
  const auto worker = [&](const std::string& script) {
    ReadCharacterOptions options;
    options.worker = folder.write("worker.sh", "#!/bin/sh\n" + script);
    options.patience_s = 0.5;
    std::filesystem::permissions(options.worker, std::filesystem::perms::owner_all);
    return error_of([&] { read_character(file, options); });
  };
  EXPECT_TRUE(contains(worker("kill -SEGV $$\n"), "a.fbx: the reader of this format crashed"));
  EXPECT_TRUE(contains(worker("exec sleep 20\n"), "longer than 0.5 s"));
  // None of the program's own files, sockets or windows: 77 is open here and inherited by any other child.
  ASSERT_EQ(::dup2(2, 77), 77);
  EXPECT_TRUE(contains(worker("[ -e /proc/$$/fd/77 ] && echo inherited >&2 || echo alone >&2; exit 1\n"),
                       "a.fbx: alone"));
  ::close(77);
  EXPECT_TRUE(contains(worker("echo it is no FBX >&2; exit 1\n"), "a.fbx: it is no FBX"));
  EXPECT_TRUE(contains(worker("printf 'it is\\033[31m\\001bad' >&2; exit 1\n"), "a.fbx: it is?[31m?bad"));
  EXPECT_TRUE(
      contains(worker("echo nonsense >$3\n"), "a.fbx: the reader of this format found nothing usable in it"));
  EXPECT_TRUE(contains(worker("mkfifo $3\n"), "a.fbx: the reader of this format found nothing usable in it"));
  ReadCharacterOptions missing;
  missing.worker = folder.path("nobody");
  EXPECT_TRUE(contains(error_of([&] { read_character(file, missing); }), "cannot be started"));
}

TEST(ImportProcess, HungerForMemoryIsOneSentence) {
  const TempFolder folder;
  ReadCharacterOptions options;
  options.worker = folder.write("worker.sh", "#!/bin/sh\nLC_ALL=C exec tail /dev/zero\n");
  options.memory_bytes = 200 << 20;
  std::filesystem::permissions(options.worker, std::filesystem::perms::owner_all);
  const std::string file = folder.write("a.fbx", "Kaydara FBX Binary  ");
  const std::string complaint = error_of([&] { read_character(file, options); });
  EXPECT_TRUE(contains(complaint, "a.fbx: ") && contains(complaint, "memory")) << complaint;
}

}  // namespace
}  // namespace understudy::tests
