#include "retarget/formats/markers.hpp"

#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

using namespace test;

class Markers : public testing::Test {
 protected:
  std::vector<MarkerFrame> read(const std::string& text, double fps = 30) const {
    return read_markers(folder.write("markers.csv", text), fps);
  }
  std::string complaint(const std::string& text) const {
    std::string words = error_of([&] { read(text); });
    const size_t at = words.find(folder.path() + "/");
    return at == words.npos ? words : words.erase(at, folder.path().size() + 1);
  }
  TempFolder folder;
};

constexpr const char* kHead = "seconds,name,x,y,z\n";
constexpr const char* kThree = "0,a,1,2,3\n0,b,0,0,0\n0,c,0,0,0\n";

TEST_F(Markers, AreInTheOrderOfTimeWhateverThatOfTheLines) {
  const auto frames = read(std::string(kHead) + "0.5,head,1,2,-3e-1\n0,head,0,0,0\n0,\"left, knee\",4,5,6\n" +
                           "\n0.5,toe,7,8,9\n");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].seconds, 0);
  ASSERT_EQ(frames[0].markers.size(), 2u);
  EXPECT_EQ(frames[0].markers[1].name, "left, knee");
  EXPECT_EQ(frames[0].markers[1].place, Vec3(4, 5, 6));
  EXPECT_EQ(frames[1].seconds, 0.5);
  EXPECT_EQ(frames[1].markers[0].place, Vec3(1, 2, -0.3f));
}

TEST_F(Markers, OfFramesAreAtTheirTimes) {
  const auto frames =
      read("Frame; Name; X; Y; Z\r\n0; a; 1; 2; 3\r\n50; b; 1; 2; 3\r\n50; c; 1; 2; 3\r\n", 25);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].seconds, 2);
  EXPECT_EQ(frames[1].markers.size(), 2u);
}

TEST_F(Markers, AreReadBackAsTheyWereWritten) {
  std::vector<MarkerFrame> frames(2);
  frames[0].markers = {{"a", Vec3(0.1f, 1e-7f, -3)}, {"b, c", Vec3(1, 2, 3)}};
  frames[1].seconds = 99 / 87.35;
  frames[1].markers = {{"d", Vec3(1.0f / 3, 0, 0)}};
  write_markers(folder.path("out.csv"), frames);
  const auto back = read_markers(folder.path("out.csv"));
  ASSERT_EQ(back.size(), 2u);
  EXPECT_NEAR(back[1].seconds, frames[1].seconds, 1e-8);
  for (size_t t = 0; t < 2; ++t) {
    ASSERT_EQ(back[t].markers.size(), frames[t].markers.size());
    for (size_t m = 0; m < frames[t].markers.size(); ++m) {
      EXPECT_EQ(back[t].markers[m].name, frames[t].markers[m].name);
      EXPECT_EQ(back[t].markers[m].place, frames[t].markers[m].place);
    }
  }
}

TEST_F(Markers, AreRefusedLineByLine) {
  EXPECT_EQ(complaint(""), "markers.csv: holds no markers");
  EXPECT_EQ(complaint("0,a,1,2,3\n"),
            "markers.csv: line 1: names no columns: seconds,name,x,y,z or frame,name,x,y,z");
  const auto after_three = [&](const std::string& line) {
    return complaint(std::string(kHead) + kThree + line + "\n");
  };
  EXPECT_EQ(after_three(""), "");
  EXPECT_EQ(after_three("1,a,1,2"), "markers.csv: line 5: has 4 cells in place of five");
  EXPECT_EQ(after_three("nan,a,1,2,3"), "markers.csv: line 5: 'nan' is no time in seconds");
  EXPECT_EQ(after_three("soon,a,1,2,3"), "markers.csv: line 5: 'soon' is no time in seconds");
  EXPECT_EQ(after_three("1,,1,2,3"), "markers.csv: line 5: names no marker");
  EXPECT_EQ(after_three("1,a,1,,3"), "markers.csv: line 5: '' is no coordinate");
  EXPECT_EQ(after_three("1,a,1,inf,3"), "markers.csv: line 5: 'inf' is no coordinate");
  EXPECT_EQ(after_three("1,a,1,1e300,3"), "markers.csv: line 5: its place is too far away");
  EXPECT_EQ(after_three("0,b,1,2,3"), "markers.csv: line 5: has 'b' again, at the time of line 3");
  EXPECT_EQ(after_three("4000,b,1,2,3"),
            "markers.csv: line 5: is an hour or more after the markers before it");
  EXPECT_EQ(after_three("1,\"b,1,2,3"), "markers.csv: line 5: a quote is not closed");
  EXPECT_EQ(complaint("frame,name,x,y,z\n0.5,a,1,2,3\n"), "markers.csv: line 2: '0.5' is no frame");
  EXPECT_EQ(complaint("frame,name,x,y,z\n-1,a,1,2,3\n"), "markers.csv: line 2: '-1' is no frame");
}

TEST_F(Markers, FewerThanThreeTellNobodysPose) {
  EXPECT_EQ(complaint(std::string(kHead) + "0,a,1,2,3\n1,b,1,2,3\n2,a,1,2,3\n"),
            "markers.csv: has 2 markers; three at least tell where somebody is");
  EXPECT_EQ(complaint(kHead), "markers.csv: has 0 markers; three at least tell where somebody is");
}

}  // namespace
}  // namespace understudy
