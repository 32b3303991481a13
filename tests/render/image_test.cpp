#include "render/image.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "render/text.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

namespace fs = std::filesystem;

class ImageFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("understudy_image_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

Image gradient() {
  Image image(37, 21);
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 37; ++x) {
      image.at(x, y)[0] = static_cast<uint8_t>(x * 6);
      image.at(x, y)[1] = static_cast<uint8_t>(y * 11);
    }
  return image;
}

TEST_F(ImageFile, PngRoundTripKeepsEveryPixel) {
  write_png(path("a.png"), gradient());
  const Image back = read_png(path("a.png"));
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 21);
  EXPECT_EQ(back.pixels, gradient().pixels);
}

TEST_F(ImageFile, KeepsAlpha) {
  Image image = gradient();
  image.alpha.resize(37 * 21);
  for (size_t i = 0; i < image.alpha.size(); ++i) image.alpha[i] = static_cast<uint8_t>(i);
  write_png(path("a.png"), image);
  const Image back = read_png(path("a.png"));
  EXPECT_EQ(back.alpha, image.alpha);
  EXPECT_EQ(back.pixels, image.pixels);
  image.alpha.pop_back();
  EXPECT_THROW(write_png(path("a.png"), image), Error);
}

TEST(Paste, LetsThroughWhereTheSourceIsTransparent) {
  Image below(4, 1, Vec3::Ones()), above(3, 1, Vec3::Zero());
  above.alpha = {255, 0, 128};
  paste(below, above, 1, 0);
  EXPECT_EQ(*below.at(0, 0), 255);
  EXPECT_EQ(*below.at(1, 0), 0);
  EXPECT_EQ(*below.at(2, 0), 255);
  EXPECT_NEAR(*below.at(3, 0), 127, 1);
}

TEST_F(ImageFile, TruncatedPngIsAnErrorWithItsName) {
  write_png(path("a.png"), gradient());
  fs::resize_file(path("a.png"), fs::file_size(path("a.png")) / 2);
  try {
    read_png(path("a.png"));
    FAIL() << "no Error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("a.png"), std::string::npos);
  }
}

TEST_F(ImageFile, WritingIntoNoFolderIsAnError) {
  EXPECT_THROW(write_png(path("none/a.png"), gradient()), Error);
  EXPECT_THROW(write_png(path("b.png"), Image()), Error);
  EXPECT_FALSE(fs::exists(path("b.png")));
}

TEST_F(ImageFile, AFontThatIsNoneIsAnError) {
  std::ofstream(path("font.otf")) << "this is not a font, whatever it is called";
  EXPECT_THROW(Font(path("font.otf")), Error);
  EXPECT_THROW(Font(path("missing.otf")), Error);
}

TEST(Image, RefusesImpossibleSizes) {
  EXPECT_THROW(Image(0, 4), Error);
  EXPECT_THROW(Image(4, 1 << 20), Error);
}

TEST(Image, PasteLeavesOutWhatFallsOutside) {
  Image image(4, 4, Vec3::Ones());
  paste(image, Image(3, 3, Vec3::Zero()), 2, -1);
  EXPECT_EQ(image.at(2, 0)[0], 0);
  EXPECT_EQ(image.at(3, 1)[0], 0);
  EXPECT_EQ(image.at(2, 2)[0], 255);
  EXPECT_EQ(image.at(1, 0)[0], 255);
  paste(image, Image(3, 3), 9, 9);
}

TEST(Font, NoneDrawsNothingAndIsNoWidth) {
  const Font none;
  Image image = gradient();
  none.draw(image, "words", {3, 15}, 12, Vec3::Zero());
  EXPECT_EQ(image.pixels, gradient().pixels);
  EXPECT_EQ(none.width("words", 12), 0);
}

TEST(Font, SystemFontLeavesInkWhereItSays) {
  const Font font = Font::system();
  ASSERT_TRUE(font.found()) << "install fonts-inter";
  Image image(120, 30);
  font.draw(image, "Frame 24 \xC2\xB7 1 s", {4, 22}, 16, Vec3::Zero());
  EXPECT_NE(image.pixels, Image(120, 30).pixels);
  EXPECT_GT(font.width("wider", 16), font.width("wide", 16));
  font.draw(image, "over the edge", {110, 2}, 40, Vec3::Zero());  // must not write outside
}

}  // namespace
}  // namespace understudy::render
