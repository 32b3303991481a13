#include "retarget/formats/scan_source.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "retarget/formats/npz.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

using namespace test;

// A cloud of one point whose x tells which frame it is.
std::string cloud(int x) {
  return "OFF\n1 0 0\n" + std::to_string(x) + " 0 0\n";
}

std::vector<int64_t> numbers_of(ScanSource& source) {
  std::vector<int64_t> numbers;
  while (const auto frame = source.next()) numbers.push_back(frame->number);
  return numbers;
}

std::string npy(const std::string& descr, const std::string& shape, const std::string& body) {
  std::string header = "{'descr': '" + descr + "', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize(117, ' ');
  return "\x93NUMPY" + std::string("\1\0", 2) + bytes_of(uint16_t{118}) + header + "\n" + body;
}

TEST(ScanSource, SortsFrameNumbersAndReportsGaps) {
  const TempFolder folder;
  for (const int i : {1, 2, 10, 11, 100}) folder.write("frame_" + std::to_string(i) + ".off", cloud(i));
  Warnings warnings;
  ScanSource source(folder.path());
  EXPECT_EQ(source.count(), 100);
  ASSERT_EQ(source.gaps().size(), 2u);
  EXPECT_EQ(source.gaps()[0].first, 3);
  EXPECT_EQ(source.gaps()[0].last, 9);
  EXPECT_TRUE(warnings.contain("frames are missing: 3-9, 12-99"));
  for (int64_t number = 1; number <= 100; ++number) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->number, number);
    EXPECT_EQ(frame->usable, number <= 2 || number == 10 || number == 11 || number == 100) << number;
    if (number == 7) EXPECT_EQ(frame->problem, folder.path() + ": frame 7 is missing");
  }
  EXPECT_FALSE(source.next());
  source.seek(9);
  EXPECT_TRUE(source.next()->usable);
}

TEST(ScanSource, NumbersThatAreNearlyEvenlyApartAreNoGaps) {
  const TempFolder folder;
  for (const int ms : {1000, 1033, 1067, 1100, 1133, 1233})
    folder.write("f" + std::to_string(ms) + ".off", cloud(1));
  ScanSource source(folder.path());
  EXPECT_EQ(numbers_of(source), (std::vector<int64_t>{1000, 1033, 1067, 1100, 1133, 1166, 1199, 1233}));
}

TEST(ScanSource, AGapOfThousandsIsLeftOut) {
  const TempFolder folder;
  for (const int i : {1, 2, 3, 5000}) folder.write("f" + std::to_string(i) + ".off", cloud(i));
  Warnings warnings;
  ScanSource source(folder.path());
  EXPECT_EQ(source.count(), 4);
  EXPECT_TRUE(warnings.contain("frames are missing: 4-4999"));
}

TEST(ScanSource, AListOfWhichNothingCanBeReadIsRefusedInOneSentence) {
  const TempFolder folder;
  std::string list;
  for (int i = 0; i < 100000; ++i) list += "gone_" + std::to_string(i) + ".ply\n";
  ScanSource source(folder.write("frames.lst", list));
  const std::string complaint = error_of([&] {
    while (source.next()) {
    }
  });
  EXPECT_TRUE(contains(complaint, "frames.lst: none of its first 100 frames can be read; ")) << complaint;
}

TEST(ScanSource, ManyFramesMayBeMissingAfterAGoodOne) {
  const TempFolder folder;
  folder.write("f0.off", cloud(0));
  std::string list = "f0.off\n";
  for (int i = 1; i < 300; ++i) list += "f" + std::to_string(i) + ".off\n";
  ScanSource source(folder.write("frames.lst", list));
  int frames = 0;
  while (source.next()) ++frames;
  EXPECT_EQ(frames, 300);
}

TEST(ScanSource, AStageMayBeEmptyForLong) {
  const TempFolder folder;
  for (int i = 0; i < 150; ++i) folder.write("f" + std::to_string(i) + ".xyz", "nan nan nan\nnan nan nan\n");
  folder.write("f150.xyz", "0 0 0\n1 1 1\n");
  ScanSource source(folder.path());
  int frames = 0;
  while (source.next()) ++frames;
  EXPECT_EQ(frames, 151);
}

TEST(ScanSource, EveryFifthFrameIsNoGap) {
  const TempFolder folder;
  for (int i = 0; i < 6; ++i) folder.write("f" + std::to_string(5 * i) + ".off", cloud(i));
  EXPECT_TRUE(ScanSource(folder.path()).gaps().empty());
}

TEST(ScanSource, NaturalOrderComparesRunsOfDigitsAsNumbers) {
  EXPECT_TRUE(natural_less("a2b", "a10a"));
  EXPECT_TRUE(natural_less("take2_frame9", "take2_frame010"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_FALSE(natural_less("a1", "a1"));
  EXPECT_TRUE(natural_less("f99999999999999999999998", "f99999999999999999999999"));
}

TEST(ScanSource, TakesTheMostFrequentFormatAndSaysWhatItLeavesOut) {
  const TempFolder folder;
  for (int i = 0; i < 3; ++i) folder.write("a" + std::to_string(i) + ".off", cloud(i));
  folder.write("b.ply", ascii_ply());
  folder.write("a.png", "no mesh");
  folder.write("README.txt", "no cloud");
  folder.write(".hidden.off", "x");
  Warnings warnings;
  EXPECT_EQ(ScanSource(folder.path()).count(), 3);
  EXPECT_TRUE(warnings.contain("1 PLY files are left out"));
  EXPECT_FALSE(warnings.contain("XYZ"));
}

TEST(ScanSource, RefusesAFolderOfTwoFormatsEquallyFrequent) {
  const TempFolder folder;
  folder.write("a0.off", cloud(0));
  folder.write("a0.ply", ascii_ply());
  EXPECT_TRUE(
      contains(error_of([&] { ScanSource source(folder.path()); }), "holds 1 frames each of PLY and OFF"));
}

TEST(ScanSource, FlagsABadFrameAndGoesOn) {
  const TempFolder folder;
  folder.write("f0.ply", ascii_ply());
  folder.write("f1.ply", binary_ply(false).substr(0, 200));
  folder.write("f2.ply", "");
  folder.write("f3.ply",
               "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float "
               "z\nend_header\n");
  folder.write("f4.ply", binary_ply(true));
  ScanSource source(folder.path());
  std::string usable;
  std::vector<std::string> problems;
  while (const auto frame = source.next()) {
    usable += frame->usable ? '1' : '0';
    if (!frame->usable) problems.push_back(frame->problem);
  }
  EXPECT_EQ(usable, "10001");
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_TRUE(contains(problems[1], "f2.ply: is empty"));
  EXPECT_TRUE(contains(problems[2], "f3.ply: has no points"));
}

TEST(ScanSource, FlagsAFrameThatVanishedMeanwhile) {
  const TempFolder folder;
  folder.write("f0.off", cloud(0));
  folder.write("f1.off", cloud(1));
  ScanSource source(folder.path());
  std::filesystem::remove(folder.path("f1.off"));
  EXPECT_TRUE(source.next()->usable);
  EXPECT_TRUE(contains(source.next()->problem, "no such file"));
  EXPECT_FALSE(source.next());
}

TEST(ScanSource, ThrowsOneSentenceWhenThereIsNothing) {
  const TempFolder folder;
  EXPECT_EQ(error_of([&] { ScanSource source(folder.path("no")); }),
            folder.path("no") + ": there is no such file or folder");
  EXPECT_EQ(error_of([&] { ScanSource source(folder.path()); }).rfind(folder.path() + ": holds no frames", 0),
            0u);
  EXPECT_NE(error_of([&] { ScanSource source(""); }), "");
  EXPECT_NE(error_of([&] { ScanSource source(std::vector<std::string>{}); }), "");
}

TEST(ScanSource, NamesThePermissionThatIsMissing) {
  const TempFolder folder;
  ::chmod(folder.path().c_str(), 0755);
  folder.write("in/f0.off", cloud(0));
  ::chmod(folder.path("in").c_str(), 0);
  const bool root = ::geteuid() == 0;
  if (root) ASSERT_EQ(::seteuid(65534), 0);  // root may read everything
  const std::string message = error_of([&] { ScanSource source(folder.path("in")); });
  if (root) ASSERT_EQ(::seteuid(0), 0);
  ::chmod(folder.path("in").c_str(), 0700);
  EXPECT_EQ(message, folder.path("in") + ": cannot be opened (Permission denied)");
}

TEST(ScanSource, ReadsASingleFileAsOneFrameAndThrowsWhenItIsBroken) {
  const TempFolder folder;
  ScanSource good(folder.write("a.ply", ascii_ply()));
  EXPECT_EQ(good.count(), 1);
  EXPECT_EQ(good.next()->mesh.faces.rows(), 4);
  EXPECT_FALSE(good.next());
  ScanSource bad(folder.write("b.ply", "ply\n"));
  EXPECT_NE(error_of([&] { bad.next(); }), "");
}

TEST(ScanSource, ReadsListsInTheirOrder) {
  const TempFolder folder;
  for (int i = 0; i < 3; ++i) folder.write("in/f" + std::to_string(i) + ".off", cloud(i));
  const std::string text = "# a list\nin/f2.off\nin/f0.off\r\n\nin/gone.off\n";
  for (const char* const name : {"list.lst", "list.txt"}) {
    ScanSource source(folder.write(name, text));
    EXPECT_EQ(source.next()->mesh.vertices(0, 0), 2);
    EXPECT_EQ(source.next()->mesh.vertices(0, 0), 0);
    EXPECT_FALSE(source.next()->usable);
    EXPECT_FALSE(source.next());
  }
  ScanSource files(std::vector<std::string>{folder.path("in/f1.off"), folder.path("in/f0.off")});
  EXPECT_EQ(numbers_of(files), (std::vector<int64_t>{0, 1}));
  EXPECT_EQ(ScanSource(folder.write("cloud.txt", "1 2 3\n4 5 6\n")).next()->mesh.vertices.rows(), 2);
}

TEST(ScanSource, StreamsArraysOfSeveralTypes) {
  const TempFolder folder;
  std::string floats, big;
  for (int i = 0; i < 12; ++i) {
    floats += bytes_of(static_cast<float>(i));
    big += bytes_of(static_cast<double>(i), true);
  }
  for (const auto& bytes : {npy("<f4", "(2, 2, 3)", floats), npy(">f8", "(2, 2, 3)", big)}) {
    ScanSource source(folder.write("a.npy", bytes));
    EXPECT_EQ(source.count(), 2);
    source.next();
    EXPECT_EQ(source.next()->mesh.vertices.row(1), Eigen::RowVector3f(9, 10, 11));
    EXPECT_FALSE(source.next());
  }
  EXPECT_EQ(ScanSource(folder.write("b.npy", npy("<f4", "(4, 3)", floats))).next()->mesh.vertices.rows(), 4);
}

TEST(ScanSource, RefusesArraysThatLieOrDoNotFit) {
  const TempFolder folder;
  const auto message = [&](const std::string& shape, size_t bytes) {
    return error_of([&] {
      ScanSource source(folder.write("a.npy", npy("<f4", shape, std::string(bytes, '\0'))));
      while (source.next()) continue;
    });
  };
  EXPECT_EQ(message("(2, 2, 3)", 48), "");
  EXPECT_NE(message("(4294967295, 4294967295, 3)", 48), "");
  EXPECT_NE(message("(9223372036854775807, 1, 3)", 48), "");
  EXPECT_NE(message("(2, 2, 3)", 47), "");
  EXPECT_NE(message("(2, 2, 4)", 64), "");
  EXPECT_NE(message("(0, 2, 3)", 0), "");
  EXPECT_NE(message("(-1, 2, 3)", 48), "");
  EXPECT_NE(error_of([&] { ScanSource source(folder.write("b.npz", "PK no zip")); }), "");
}

TEST(ScanSource, StreamsNpzWithFacesBesideThePoints) {
  const TempFolder folder;
  NpyArray vertices, faces, other;
  vertices.shape = {2, 3, 3};
  for (int i = 0; i < 18; ++i) vertices.values.push_back(static_cast<float>(i));
  faces.shape = {1, 3};
  faces.values = {0, 1, 2};
  other.shape = {1, 1, 3};
  other.values = {0, 0, 0};
  write_npz(folder.path("a.npz"), {{"vertices", vertices}, {"faces", faces}, {"another", other}});
  ScanSource source(folder.path("a.npz"));
  EXPECT_EQ(source.count(), 2);
  const auto first = source.next();
  EXPECT_EQ(first->mesh.faces, Eigen::RowVector3i(0, 1, 2));
  EXPECT_EQ(source.next()->mesh.vertices(2, 2), 17);
  EXPECT_FALSE(source.next());
}

// Writes as a rig does, and waits until each frame has been read before it begins the next.
TEST(ScanSource, FollowHandsOutAFrameBeforeTheNextExists) {
  const TempFolder folder;
  std::atomic<int> read{0};
  std::thread writer([&] {
    for (int i = 0; i < 5; ++i) {
      const std::string text = cloud(i);
      std::ofstream file(folder.path("f" + std::to_string(i) + ".off"), std::ios::binary);
      file << text.substr(0, 9) << std::flush;  // in two pieces
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
      file << text.substr(9) << std::flush;
      file.close();
      for (int wait = 0; read <= i && wait < 1000; ++wait)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    folder.write("done", "");
  });
  ScanSourceOptions options;
  options.follow = true;
  options.poll_s = 0.01;
  ScanSource source(folder.path(), options);
  EXPECT_FALSE(source.count());
  for (int i = 0; i < 5; ++i) {
    const auto frame = source.next();
    if (!frame) break;
    EXPECT_TRUE(frame->usable) << frame->problem;
    EXPECT_EQ(frame->number, i);
    EXPECT_FALSE(std::filesystem::exists(folder.path("f" + std::to_string(i + 1) + ".off")));
    ++read;
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(source.next());  // ends at `done`, long before the timeout
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_EQ(read, 5);
  read = 100;
  writer.join();
}

ScanSourceOptions follow_for(double seconds) {
  ScanSourceOptions options;
  options.follow = true;
  options.timeout_s = seconds;
  options.poll_s = 0.01;
  return options;
}

TEST(ScanSource, FollowEndsAtTheTimeout) {
  const TempFolder folder;
  folder.write("f0.off", cloud(0));
  ScanSource source(folder.path(), follow_for(0.1));
  EXPECT_TRUE(source.next());
  EXPECT_FALSE(source.next());
  EXPECT_FALSE(source.next());
}

TEST(ScanSource, FollowOfAFolderThatStaysEmptyThrows) {
  const TempFolder folder;
  ScanSource source(folder.path(), follow_for(0.05));
  EXPECT_TRUE(contains(error_of([&] { source.next(); }), "no frame came within 0.05 s"));
  EXPECT_NE(error_of([&] { ScanSource none(folder.path("no"), follow_for(1)); }), "");
}

TEST(ScanSource, FollowFlagsAFrameThatStayedBrokenAndReportsGaps) {
  const TempFolder folder;
  folder.write("f0.off", cloud(0));
  folder.write("f1.off", "OFF\n1 0 0\n");
  folder.write("f2.off", cloud(2));
  folder.write("f5.off", cloud(5));
  folder.write("f5.ply", ascii_ply());
  folder.write(".done", "");
  Warnings warnings;
  ScanSource source(folder.path(), follow_for(2));
  std::string usable;
  while (const auto frame = source.next()) usable += frame->usable ? '1' : '0';
  EXPECT_EQ(usable, "101001");
  ASSERT_EQ(source.gaps().size(), 1u);
  EXPECT_EQ(source.gaps()[0].first, 3);
  EXPECT_EQ(source.gaps()[0].last, 4);
}

TEST(ScanSource, FollowTakesNumbersThatAreThereTwice) {
  const TempFolder folder;
  for (const char* name : {"a1.off", "b1.off", "c2.off"}) folder.write(name, cloud(0));
  folder.write("done", "");
  ScanSource source(folder.path(), follow_for(2));
  int frames = 0;
  while (source.next()) ++frames;
  EXPECT_EQ(frames, 3);
}

TEST(ScanSource, FollowCanBeCancelled) {
  const TempFolder folder;
  ScanSourceOptions options = follow_for(100);
  options.cancelled = [] { return true; };
  ScanSource source(folder.path(), options);
  EXPECT_FALSE(source.next());
}

}  // namespace
}  // namespace understudy
