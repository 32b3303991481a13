#include "retarget/formats/scan_times.hpp"

#include <cmath>

#include "retarget/formats/npz.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

using namespace test;

/// A folder of scans, each a point whose x is its number, beside a table of their times.
class ScanTimes : public testing::Test {
 protected:
  void write_scans(const std::vector<int>& numbers) const {
    for (const int i : numbers) write_scan(printed("frame_%04d.off", i), i);
  }
  std::string write_scan(const std::string& name, int x) const {
    return folder.write("scans/" + name, "OFF\n1 0 0\n" + std::to_string(x) + " 0 0\n");
  }
  /// Row i is of scan i + 1.
  static std::string rows(const std::vector<double>& seconds) {
    std::string text;
    for (size_t i = 0; i < seconds.size(); ++i) text += printed("%zu,%.17g\n", i + 1, seconds[i]);
    return text;
  }
  ScanSource open(const std::string& table, double fps = 0, const std::string& scans = "scans") const {
    ScanSourceOptions options;
    options.times = folder.write("times.csv", table);
    options.fps = fps;
    return ScanSource(folder.path(scans), options);
  }
  /// The scan in each frame, by its number; 0: a gap, -1: another problem.
  static std::vector<int> shown(ScanSource& source) {
    std::vector<int> all;
    while (const auto frame = source.next()) {
      EXPECT_EQ(frame->number, static_cast<int64_t>(all.size()));
      const bool is_gap = contains(frame->problem, "is missing");
      all.push_back(frame->usable ? static_cast<int>(std::lround(frame->mesh.vertices(0, 0)))
                    : is_gap      ? 0
                                  : -1);
    }
    return all;
  }
  std::vector<int> shown(const std::string& table, double fps = 0) const {
    ScanSource source = open(table, fps);
    return shown(source);
  }
  /// The sentence without the folder.
  std::string complaint(const std::string& table, double fps = 0) const {
    std::string text = error_of([&] { open(table, fps); });
    const size_t at = text.find(folder.path() + "/");
    return at == text.npos ? text : text.erase(at, folder.path().size() + 1);
  }
  TempFolder folder;
};

using Frames = std::vector<int>;

TEST_F(ScanTimes, TellTheRateInOneSentence) {
  std::string table;
  for (int i = 1; i <= 37; ++i) {
    write_scans({i});
    table += printed("frame_%04d.off,%.2f\n", i, 100 + 0.04 * i);
  }
  ScanSource source = open(table);
  ASSERT_TRUE(source.clock());
  EXPECT_EQ(source.clock()->fps, 25);
  EXPECT_EQ(source.clock()->sentence, folder.path("times.csv") + ": 37 scans in 1.48 s, 25 frames/s");
  EXPECT_EQ(source.count(), 37);
  EXPECT_TRUE(source.gaps().empty());
}

TEST_F(ScanTimes, AreNotAskedForWithoutATable) {
  write_scans({1, 2});
  EXPECT_FALSE(ScanSource(folder.path("scans")).clock());
}

TEST_F(ScanTimes, OfASparseCaptureLeaveGapsOfTrueLength) {
  write_scans({1, 2, 3});
  ScanSource source = open(rows({0, 0.2, 0.4}), 30);
  EXPECT_EQ(source.count(), 13);
  EXPECT_EQ(shown(source), (Frames{1, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 3}));
  EXPECT_EQ(source.clock()->sentence,
            folder.path("times.csv") + ": 3 scans in 0.43 s, 30 frames/s, 10 frames without a scan");
  ASSERT_EQ(source.gaps().size(), 2u);
  EXPECT_EQ(source.gaps()[0].first, 1);
  EXPECT_EQ(source.gaps()[0].last, 5);
}

TEST_F(ScanTimes, TellInPlaceOfNumbers) {
  write_scans({1, 2, 9});
  Warnings warnings;
  EXPECT_EQ(shown("1,0\n2,0.1\n9,0.2\n"), (Frames{1, 2, 9}));
  EXPECT_FALSE(warnings.contain("missing"));
}

TEST_F(ScanTimes, GapsAreAsLongAsTheTableSaysAndTheMedianIsTheRate) {
  write_scans({1, 2, 3, 4, 5});
  EXPECT_EQ(shown(rows({0, 0.1, 0.2, 0.5, 0.6})), (Frames{1, 2, 3, 0, 0, 4, 5}));
}

TEST_F(ScanTimes, InWholeMillisecondsAreNoSlowerThanTheClock) {
  std::vector<int> all;
  std::vector<double> seconds;
  for (int i = 1; i <= 600; ++i) all.push_back(i), seconds.push_back(std::round(1000 * i / 30.0) / 1000);
  write_scans(all);
  EXPECT_EQ(shown(rows(seconds)), all);  // a median of 33 ms would leave six gaps
}

TEST_F(ScanTimes, PutAScanOnTheNearestFrame) {
  write_scans({1, 2, 3, 4});
  EXPECT_EQ(shown(rows({0, 0.14, 0.26, 0.3}), 10), (Frames{1, 2, 0, 4}));
}

TEST_F(ScanTimes, OfTwoScansOnAFrameTheNearerStaysAndItIsSaid) {
  write_scans({1, 2, 3, 4, 5});
  Warnings warnings;
  EXPECT_EQ(shown(rows({0, 0.02, 0.13, 0.19, 0.22}), 10), (Frames{1, 3, 4}));
  EXPECT_TRUE(
      warnings.contain("times.csv: scans are left out, because others are nearer to their frames of 10 "
                       "a second: frame_0002.off, frame_0005.off"));
}

TEST_F(ScanTimes, TheLaterScanMayBeTheNearer) {
  write_scans({1, 2, 3});
  EXPECT_EQ(shown(rows({0, 0.06, 0.09}), 10), (Frames{1, 3}));
}

TEST_F(ScanTimes, NamesWithoutAScanAreGapsAndSaidOnce) {
  write_scans({2, 4});
  Warnings warnings;
  EXPECT_EQ(shown("frame_0001,0\nframe_0002,0.1\nframe_0003.off,0.2\nframe_0004,0.3\nframe_0005,0.4\n"),
            (Frames{0, 2, 0, 4, 0}));
  EXPECT_TRUE(warnings.contain(
      "times.csv: has times of scans that are not there: frame_0001, frame_0003.off, frame_0005"));
}

TEST_F(ScanTimes, AScanWithoutATimeIsRefusedByName) {
  write_scans({1, 2, 3, 4});
  EXPECT_EQ(complaint("1,0\n3,0.2\n"), "times.csv: has no time for frame_0002.off");
}

TEST_F(ScanTimes, NameScansWithAndWithoutFolderSuffixOrByNumber) {
  write_scans({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(shown("frame_0001.off,0\nscans/frame_0002.off,1\n/elsewhere/scans/frame_0003,2\nframe_0004,3\n"
                  "5,4\nC:\\scans\\frame_0006.off,5\n"),
            (Frames{1, 2, 3, 4, 5, 6}));
}

TEST_F(ScanTimes, AreReadAsSpreadsheetsWriteThem) {
  write_scans({1, 2});
  for (const char* const table :
       {"1,0\n2,0.5\n", "file,seconds\n1,0\n2,0.5\n",
        "\xef\xbb\xbf"
        "Datei;Zeit (s)\r\n1;0\r\n2;0.5\r\n",
        "frame\ttime\n1\t0\n2\t0.5", "\"the file\",\"s\"\"\"\n\"frame_0001.off\",\"0\"\n \"2\" , 0.5 \n\n"}) {
    SCOPED_TRACE(table);
    EXPECT_EQ(shown(table), (Frames{1, 2}));
  }
  write_scan("a, b.off", 1);  // natural order: before frame_0001
  EXPECT_EQ(shown("\"a, b.off\",0\n1,1\n2,2\n"), (Frames{1, 1, 2}));
}

TEST_F(ScanTimes, MayBeNegativeAndCountFromTheFirst) {
  write_scans({1, 2, 3});
  EXPECT_EQ(shown(rows({-0.5, -0.25, 0.25})), (Frames{1, 2, 0, 3}));
}

TEST_F(ScanTimes, MayBeListedInAnyOrder) {
  write_scans({1, 2, 10});
  EXPECT_EQ(shown("frame_0001,0\nframe_0010,0.2\nframe_0002,0.1\n"), (Frames{1, 2, 10}));
}

TEST_F(ScanTimes, ThatFallAreRefused) {
  write_scans({1, 2, 3});
  EXPECT_EQ(complaint("file,s\n1,0\n2,0.2\n3,0.1\n"),
            "times.csv: line 4: the time falls: 0.1 s of '3' is before 0.2 s of '2' in line 3");
  EXPECT_EQ(complaint("1,0\n2,0.1\n3,0.2\nframe_0009,0.15\n"),
            "times.csv: line 4: the time falls: 0.15 s of 'frame_0009' is before 0.2 s of '3' in line 3");
}

TEST_F(ScanTimes, ThatAreEqualAreRefused) {
  write_scans({1, 2, 3});
  EXPECT_EQ(complaint(rows({0, 0.25, 0.25})), "times.csv: line 3: has the time of line 2, 0.25 s");
}

TEST_F(ScanTimes, AnHourApartAreRefused) {
  write_scans({1, 2, 3});
  EXPECT_EQ(complaint(rows({0, 1, 3601})),
            "times.csv: line 3: 3601 s is an hour or more after 1 s in line 2; times are in seconds");
  EXPECT_EQ(complaint(rows({0, 1, 3600.5})), "");
}

TEST_F(ScanTimes, ThatAreNoTimesAreRefused) {
  write_scans({1, 2});
  EXPECT_EQ(complaint("1,0\n2,nan\n"), "times.csv: line 2: 'nan' is no time in seconds");
  EXPECT_EQ(complaint("1,-inf\n2,0\n"), "times.csv: line 1: '-inf' is no time in seconds");
  EXPECT_EQ(complaint("1,0\n2,1e999\n"), "times.csv: line 2: '1e999' is no time in seconds");
  EXPECT_EQ(complaint("1;0\n2;0,5\n"), "times.csv: line 2: '0,5' is no time in seconds");
  EXPECT_EQ(complaint("1,0\n2,soon\n"), "times.csv: line 2: 'soon' is no time in seconds");
  EXPECT_EQ(complaint("1,0\n2,\n"), "times.csv: line 2: '' is no time in seconds");
}

TEST_F(ScanTimes, OfTwoColumnsAloneAreTaken) {
  write_scans({1, 2});
  EXPECT_EQ(complaint("1,0\n2\n"), "times.csv: line 2: has 1 column in place of two, scan and seconds");
  EXPECT_EQ(complaint("1,0\n2,1,5\n"), "times.csv: line 2: has 3 columns in place of two, scan and seconds");
  EXPECT_EQ(complaint("1,0\n,1\n"), "times.csv: line 2: names no scan");
  EXPECT_EQ(complaint("1,0\n\"2,1\n"), "times.csv: line 2: a quote is not closed");
}

TEST_F(ScanTimes, AreTwoAtLeast) {
  write_scans({1, 2});
  EXPECT_EQ(complaint(""), "times.csv: holds no times");
  EXPECT_EQ(complaint("file,seconds\n"), "times.csv: holds no times");
  EXPECT_EQ(complaint("file,seconds\n1,0\n"),
            "times.csv: line 2: is the only time; two at least tell a rate");
}

TEST_F(ScanTimes, NameEachScanOnce) {
  write_scans({1, 2});
  EXPECT_EQ(complaint("1,0\n2,1\nframe_0001.off,2\n"),
            "times.csv: line 3: names 'frame_0001.off', as line 1 does");
  EXPECT_EQ(complaint("1,0\n2,1\nx,2\nx,3\n"), "times.csv: line 4: names 'x', as line 3 does");
}

TEST_F(ScanTimes, OfMoreThanTenMillionFramesAreRefusedBeforeTheyAreMade) {
  std::string table = "1,0\n2,0.001\n";
  for (int i = 1; i <= 3; ++i) table += printed("x%d,%d\n", i, 3500 * i);
  write_scans({1, 2});
  EXPECT_EQ(complaint(table, 1000),
            "times.csv: line 5: is 10500 s after line 1, at 1000 frames/s more than ten million frames");
  EXPECT_EQ(complaint(table, 100), "");
}

TEST_F(ScanTimes, OfMoreThanAThousandASecondAreNoSeconds) {
  write_scans({1, 2});
  EXPECT_EQ(
      complaint(rows({0, 1e-7})),
      "times.csv: its scans are 1e-07 s apart, less than a thousandth of a second; times are in seconds");
  EXPECT_EQ(complaint(rows({0, 1e-300})).substr(0, 24), "times.csv: its scans are");
}

TEST_F(ScanTimes, CanBeSoughtToo) {
  write_scans({1, 2, 3});
  ScanSource source = open(rows({0, 0.2, 0.3}), 10);
  for (const int64_t frame : {3, 1, 2, 0}) {
    source.seek(frame);
    const auto found = source.next();
    EXPECT_EQ(found->number, frame);
    EXPECT_EQ(found->usable, frame != 1);
  }
  EXPECT_EQ(source.next()->number, 1);
}

TEST_F(ScanTimes, OfAnArrayGoByItsFrameNumbers) {
  NpyArray points;
  points.shape = {3, 1, 3};
  points.values = {1, 0, 0, 2, 0, 0, 3, 0, 0};
  write_npz(folder.path("scans.npz"), {{"points", points}});
  ScanSource source = open("frame,s\n0,0\n1,0.1\n2,0.4\n", 10, "scans.npz");
  EXPECT_EQ(shown(source), (Frames{1, 2, 0, 0, 3}));
  EXPECT_EQ(error_of([&] { open("0,0\n1,0.1\n", 10, "scans.npz"); }),
            folder.path("times.csv") + ": has no time for frame 2");
}

TEST_F(ScanTimes, OfAListGoByItsFiles) {
  write_scan("left/a.off", 1);
  write_scan("right/a.off", 2);
  folder.write("all.lst", "scans/left/a.off\nscans/right/a.off\n");
  ScanSource source = open("left/a.off,0\nright/a,1\n", 0, "all.lst");
  EXPECT_EQ(shown(source), (Frames{1, 2}));
  EXPECT_EQ(error_of([&] { open("a.off,0\n1,1\n", 0, "all.lst"); }),
            folder.path("times.csv") + ": line 1: 'a.off' may be any of several scans");
}

TEST_F(ScanTimes, KeepAFrameThatCannotBeRead) {
  write_scans({1, 3});
  folder.write("scans/frame_0002.off", "no scan");
  EXPECT_EQ(shown(rows({0, 0.1, 0.2})), (Frames{1, -1, 3}));
}

TEST_F(ScanTimes, AreRefusedOfAFolderThatIsStillBeingWritten) {
  write_scans({1, 2});
  ScanSourceOptions options;
  options.times = folder.write("times.csv", rows({0, 1}));
  options.follow = true;
  EXPECT_TRUE(
      contains(error_of([&] { ScanSource(folder.path("scans"), options); }), "is still being written"));
}

TEST_F(ScanTimes, ThatAreNotThereAreRefused) {
  write_scans({1, 2});
  ScanSourceOptions options;
  options.times = folder.path("gone.csv");
  EXPECT_TRUE(contains(error_of([&] { ScanSource(folder.path("scans"), options); }), "gone.csv: "));
}

}  // namespace
}  // namespace understudy
