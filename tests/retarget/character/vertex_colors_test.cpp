#include "retarget/character/vertex_colors.hpp"

#include <gtest/gtest.h>

#include <webp/encode.h>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/character/picture.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace understudy {
namespace {

/// Two pixels: red on the left, green on the right.
std::string red_and_green() {
  const unsigned char pixels[] = {255, 0, 0, 0, 255, 0};
  std::string bytes;
  stbi_write_png_to_func(
      [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<size_t>(size));
      },
      &bytes, 2, 1, 3, pixels, 6);
  return bytes;
}

std::string red_and_green_as_webp() {
  const unsigned char pixels[] = {255, 0, 0, 0, 255, 0};
  uint8_t* made = nullptr;
  const size_t size = WebPEncodeLosslessRGB(pixels, 2, 1, 6, &made);
  const std::string bytes(reinterpret_cast<const char*>(made), size);
  WebPFree(made);
  return bytes;
}

/// Three vertices with texture coordinates 0.25, 0.75 and 1.25, a picture on them.
Character textured(const std::string& picture, const std::string& sampler = "{}") {
  Mesh mesh;
  mesh.vertices = Points::Random(3, 3);
  mesh.faces = Faces(1, 3);
  mesh.faces << 0, 1, 2;
  Character out = character_of_mesh(mesh, "made");
  out.images = {{"skin", "image/png", picture}};
  out.samplers = {sampler};
  out.textures = {R"({"source":0,"sampler":0})"};
  out.materials = {R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})"};
  RowMatrix uv(3, 2);
  uv << 0.25f, 0.5f, 0.75f, 0.5f, 1.25f, 0.5f;
  out.parts[0].uvs = {uv};
  return out;
}

/// What was warned of while it ran.
template <class Part>
std::string warnings(Part part) {
  std::string all;
  const auto sink = log::set_sink([&](log::Level level, const std::string& text) {
    if (level == log::Level::Warning) all += text + "\n";
  });
  part();
  log::set_sink(sink);
  return all;
}

TEST(VertexColors, AreThoseOfTheTextureAtTheVertex) {
  const Points colors = vertex_colors(textured(red_and_green()));
  ASSERT_EQ(colors.rows(), 3);
  EXPECT_TRUE(colors.row(0).isApprox(Eigen::RowVector3f(1, 0, 0), 0.01f)) << colors;
  EXPECT_TRUE(colors.row(1).isApprox(Eigen::RowVector3f(0, 1, 0), 0.01f)) << colors;
  EXPECT_TRUE(colors.row(2).isApprox(Eigen::RowVector3f(1, 0, 0), 0.01f)) << colors;  // it is repeated
  const Points clamped = vertex_colors(textured(red_and_green(), R"({"wrapS":33071})"));
  EXPECT_TRUE(clamped.row(2).isApprox(Eigen::RowVector3f(0, 1, 0), 0.01f)) << clamped;
}

TEST(VertexColors, AreThoseOfAWebPPictureThatAnExtensionNames) {
  Character made = textured(red_and_green_as_webp());
  made.textures = {R"({"extensions":{"EXT_texture_webp":{"source":0}}})"};
  Points colors = vertex_colors(made);
  ASSERT_EQ(colors.rows(), 3);
  EXPECT_TRUE(colors.row(1).isApprox(Eigen::RowVector3f(0, 1, 0), 0.01f)) << colors;
  made.images.push_back(
      {"packed", "image/ktx2", std::string("\xabKTX 20\xbb\r\n\x1a\n", 12) + std::string(40, '\0')});
  made.textures = {R"({"source":0,"extensions":{"KHR_texture_basisu":{"source":1}}})"};
  EXPECT_EQ(vertex_colors(made), colors);  // the one that everybody reads stands for the other
}

TEST(VertexColors, ArePlainWhereNoPictureIsDecodedAndThatIsToldOnce) {
  Character made = textured(std::string("\xabKTX 20\xbb\r\n\x1a\n", 12) + std::string(40, '\0'));
  made.file = "folder/made.glb";
  made.parts.push_back(made.parts[0]);
  made.textures = {R"({"extensions":{"KHR_texture_basisu":{"source":0}}})"};
  Points colors;
  const std::string said = warnings([&] { colors = vertex_colors(made); });
  EXPECT_EQ(said, "folder/made.glb: the picture 'skin' is not shown: it is neither PNG, JPEG nor WebP\n");
  EXPECT_EQ(colors.rows(), 0);
}

TEST(VertexColors, OfAPictureThatUnpacksToFarMoreThanItsPixelsAreLeftOut) {
  const std::string bomb = read_file(US_SOURCE_DIR "/tests/fuzz/corpus/picture/bomb.png");
  const std::string said = warnings([&] { vertex_colors(textured(bomb)); });
  EXPECT_NE(said.find("it cannot be decoded"), std::string::npos) << said;
}

TEST(VertexColors, AreDarkerByTheMaterialAndTheVertexInLinearLight) {
  Character made = textured(red_and_green());
  made.materials = {
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[0.5,0.5,0.5,1]}})"};
  made.parts[0].colors = RowMatrix::Constant(3, 4, 0.5f);
  const Points colors = vertex_colors(made);
  EXPECT_NEAR(colors(0, 0), 0.537f, 0.003f);  // 0.25 of the light
}

TEST(VertexColors, TellPartsApartByTheirMaterials) {
  Mesh mesh;
  mesh.vertices = Points::Random(2, 3);
  Character made = character_of_mesh(mesh, "made");
  EXPECT_EQ(vertex_colors(made).rows(), 0);  // one colour says nothing
  made.parts.push_back(made.parts[0]);
  made.parts[1].material = 1;
  made.materials.push_back(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}})");
  const Points colors = vertex_colors(made);
  ASSERT_EQ(colors.rows(), 4);
  EXPECT_TRUE(colors.row(3).isApprox(Eigen::RowVector3f(1, 0, 0), 1e-5f));
  EXPECT_GT(colors(0, 1), 0.8f);
}

TEST(VertexColors, OfAScanAreItsOwn) {
  Mesh mesh;
  mesh.vertices = Points::Random(50, 3);
  mesh.colors = (Points::Random(50, 3).array() + 1) / 2;
  const Character made = character_of_mesh(mesh, "made");
  EXPECT_LT((vertex_colors(made) - mesh.colors).cwiseAbs().maxCoeff(), 1e-4f);
  MergedSurface surface = merged_surface(made, mesh.vertices);
  paint(surface, made);
  EXPECT_LT((surface.mesh.colors - mesh.colors).cwiseAbs().maxCoeff(), 1e-4f);
}

TEST(VertexColors, LeaveOutPicturesThatAreNoneOrTooLarge) {
  std::string large = red_and_green();
  const unsigned char size[] = {0, 0, 0x40, 0, 0, 0, 0x40, 0};  // 16384 x 16384
  large.replace(16, 8, reinterpret_cast<const char*>(size), 8);
  for (const std::string& picture :
       {large, red_and_green().substr(0, 40), std::string("no picture at all")}) {
    Points colors;
    const std::string said = warnings([&] { colors = vertex_colors(textured(picture)); });
    EXPECT_NE(said.find("'skin' is not shown"), std::string::npos) << said;
    EXPECT_EQ(colors.rows(), 0);
  }
  const std::string said = warnings([&] { vertex_colors(textured(large)); });
  EXPECT_NE(said.find("64 megapixels"), std::string::npos) << said;
}

// Its scan names a table of codes that the file does not have: what lay in memory before must not count.
TEST(DecodedPictures, OfAJpegWithoutItsCodesDependOnNothingElse) {
  std::string jpeg("\xff\xd8\xff\xe0\0\x10JFIF\0\1\1\0\0\1\0\1\0\0", 20);
  jpeg += std::string("\xff\xdb\0\x43\0", 5) + std::string(64, '\x08');
  jpeg += std::string("\xff\xc0\0\x11\x08\0\x10\0\x10\3\1\x22\0\2\x11\0\3\x11\0", 19);
  jpeg += std::string("\xff\xc4\0\x15\0\1\1", 7) + std::string(15, '\0') + '\1';
  jpeg += std::string("\xff\xda\0\x0c\3\1\0\2\0\3\0\0\x3f\0\0\x3f\0\xff\xd9", 19);
  std::vector<std::string> seen;
  for (const int before : {0xee, 0x7f, 0x01}) {
    for (int i = 0; i < 64; ++i) {
      std::vector<std::string> dirt;
      for (size_t size = 16000; size < 24000; size += 500) dirt.emplace_back(size, static_cast<char>(before));
    }
    try {
      const Pixels pixels = decode_picture(jpeg);
      seen.emplace_back(reinterpret_cast<const char*>(pixels.rgb.get()),
                        3 * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
    } catch (const Error& error) {
      seen.emplace_back(error.what());
    }
  }
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_EQ(seen[0], seen[2]);
}

}  // namespace
}  // namespace understudy
