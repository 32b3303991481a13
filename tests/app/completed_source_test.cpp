// Sparse scans as a source: what they are completed to, and what is refused.
#include "app/run/completed_source.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/body/marker_places.hpp"
#include "retarget/formats/markers.hpp"
#include "retarget/formats/surface_writer.hpp"
#include "tests/app/program.hpp"

namespace understudy::app {
namespace {

constexpr int kScans = 4, kEvery = 6;  // frames of the walk from one scan to the next

struct Walker {
  ShapedBody body = builtin_person();
  Motion motion = builtin_motion("walk", body.joints);
  const Pose& pose(int scan) const { return motion.poses[30 + kEvery * scan]; }
  Points points(int scan, int count) const {
    Rng rng(static_cast<uint64_t>(scan) + 9);
    return sample_points(Mesh{posed_vertices(body, pose(scan)), body.faces}, count, rng);
  }
};
const Walker& walker() {
  static const Walker one;
  return one;
}

/// Sees the walker where the scan's middle is.
class KnowingExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh& scan) override {
    Extraction seen;
    float least = 1e9f;
    for (int i = 0; i < kScans; ++i) {
      const PosedSkeleton posed = forward_kinematics(walker().body.joints, walker().pose(i));
      const float off = (posed.joints.colwise().mean() - scan.vertices.colwise().mean()).norm();
      if (off < least) least = off, seen.joints = posed.joints, seen.global = posed.global;
    }
    seen.confidence.setConstant(confidence_for(0.03f));
    return seen;
  }
  std::string name() const override { return "knowing"; }
};

class CompletedSource : public testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([this](log::Level, const std::string& line) { said += line + "\n"; });
  }
  void TearDown() override { log::set_sink(before_); }

  void write_scan(int scan, int count, const std::string& folder = "scans") {
    std::filesystem::create_directories(scratch.path(folder));
    std::ofstream file(scratch.path(folder + "/frame_" + std::to_string(scan) + ".xyz"));
    const Points points = walker().points(scan, count);
    for (Eigen::Index i = 0; i < points.rows(); ++i) file << points.row(i) << '\n';
  }
  SourceOptions scans(int count = 120) {
    for (int i = 0; i < kScans; ++i) write_scan(i, count);
    SourceOptions options;
    options.path = scratch.path("scans");
    options.fps = 5;
    options.complete = 30;
    options.import.units = "m", options.import.up = "y", options.import.floor = 0;
    return options;
  }
  static std::unique_ptr<Source> opened(const SourceOptions& options) {
    auto source = open_source(options);
    SourceTools tools;
    tools.extractor = [] { return std::make_shared<KnowingExtractor>(); };
    source->set_tools(tools);
    return source;
  }
  static std::string refusal(const SourceOptions& options) {
    return failure_of([&] { opened(options)->next(); });
  }
  /// Markers at these times.
  std::string markers(const std::vector<double>& times) {
    std::vector<MarkerFrame> frames;
    const std::vector<int> marked = marker_vertices(walker().body.vertices, walker().body.joints);
    for (size_t i = 0; i < times.size(); ++i) {
      MarkerFrame& frame = frames.emplace_back();
      frame.seconds = times[i];
      const Points posed = posed_vertices(walker().body, walker().pose(static_cast<int>(i) % kScans));
      for (int m = 0; m < kMarkerCount; ++m)
        frame.markers.push_back({kMarkerPlaces[m].name, posed.row(marked[m]).transpose()});
    }
    write_markers(scratch.path("markers.csv"), frames);
    return scratch.path("markers.csv");
  }

  tests::ScratchFolder scratch;
  std::string said;

 private:
  log::Sink before_;
};

TEST_F(CompletedSource, HandsOutExactSkeletonsAtTheWantedRate) {
  const auto source = opened(scans());
  EXPECT_EQ(source->fps(), 30);
  EXPECT_EQ(source->count(), 19);
  for (int t = 0; t < 19; ++t) {
    const auto frame = source->next();
    ASSERT_TRUE(frame && frame->usable && frame->skeleton) << t;
    EXPECT_EQ(frame->number, t);
    EXPECT_TRUE(frame->skeleton->exact);
    EXPECT_FALSE(frame->mesh.is_cloud());
    EXPECT_EQ(frame->doubt_m == 0, t % kEvery == 0) << t;
    const Joints truth = forward_kinematics(walker().body.joints, walker().motion.poses[30 + t]).joints;
    EXPECT_LT((frame->skeleton->joints - truth).rowwise().norm().mean(), 0.06f) << t;
  }
  EXPECT_FALSE(source->next());
  EXPECT_NE(
      source->decision().find("4 scans completed to 30 frames/s, 15 of 19 frames are made (looks both ways)"),
      std::string::npos)
      << source->decision();
}

TEST_F(CompletedSource, WhatWasMadeIsNotMadeAgain) {
  SourceOptions options = scans();
  const auto source = opened(options);
  const auto first = source->next();
  options.made = source->made();
  ASSERT_TRUE(options.made);
  const auto again = open_source(options);  // without tools
  EXPECT_EQ(again->next()->skeleton->joints, first->skeleton->joints);
  EXPECT_EQ(again->decision(), source->decision());
  again->seek(18);
  EXPECT_EQ(again->next()->number, 18);
  EXPECT_FALSE(again->next());
}

TEST_F(CompletedSource, TellsProgressAndCanBeStopped) {
  const auto source = opened(scans());
  SourceTools tools;
  tools.extractor = [] { return std::make_shared<KnowingExtractor>(); };
  float share = 0;
  tools.progress = [&](float now) { share = now; };
  source->set_tools(tools);
  source->next();
  EXPECT_EQ(share, 1);
  const auto stopped = opened(scans());
  tools.progress = [](float) { throw Error("enough"); };
  stopped->set_tools(tools);
  EXPECT_THROW(stopped->next(), Error);
}

TEST_F(CompletedSource, TimesTellWhenItsScansWereTaken) {
  SourceOptions options = scans();
  options.times = scratch.path("times.csv");
  std::ofstream(options.times) << "0,10\n1,10.2\n2,10.4\n3,10.8\n";
  const auto source = opened(options);
  EXPECT_EQ(source->count(), 25);
  std::string made;
  while (const auto frame = source->next()) made += frame->doubt_m > 0 ? '-' : 'x';
  EXPECT_EQ(made, "x-----x-----x-----------x");
}

TEST_F(CompletedSource, TakesMarkersInTheTimeOfItsScansAlone) {
  SourceOptions options = scans(40);
  options.markers = markers({0, 0.2, 0.4, 0.6, 5});
  opened(options)->next();
  EXPECT_NE(said.find("markers.csv: 1 of its times are before the first scan or after the last"),
            std::string::npos)
      << said;
  options.markers = markers({100, 101});
  EXPECT_NE(
      refusal(options).find("markers.csv: none of its markers is from the time of the scans, 0 to 0.6 s"),
      std::string::npos)
      << refusal(options);
}

TEST_F(CompletedSource, RefusesMarkersThatTellNothing) {
  SourceOptions options = scans();
  options.markers = scratch.path("markers.csv");
  std::ofstream(options.markers) << "seconds,name,x,y,z\n0,left_knee,0,0,0\n0,left_hip,0,0,0\n";
  EXPECT_NE(refusal(options).find("three at least"), std::string::npos) << refusal(options);
  std::ofstream(options.markers) << "seconds,name,x,y,z\n0,left_knee,0,0,0\n0,left_hip,0,0,0\n0,,0,0,0\n";
  EXPECT_NE(refusal(options).find("names no marker"), std::string::npos) << refusal(options);
  std::ofstream(options.markers) << "seconds,name,x,y,z\n0,left_knee,0,0,0\n0,left_hip,0,0,0\n0,tail,0,0,0\n";
  EXPECT_NE(refusal(options).find("there is no place for a marker 'tail', only for forehead"),
            std::string::npos)
      << refusal(options);
}

TEST_F(CompletedSource, RefusesTimesThatAreNone) {
  SourceOptions options = scans();
  options.times = scratch.path("times.csv");
  for (const auto& [times, says] : {std::make_pair("0,0\n1,0.2\n2,0.2\n3,0.6\n", "the time"),
                                    std::make_pair("0,0\n1,0.4\n2,0.2\n3,0.6\n", "the time falls"),
                                    std::make_pair("0,0\n1,nan\n2,0.4\n3,0.6\n", "line 2"),
                                    std::make_pair("0,0\n1,0.2\n2,0.4\n3,4000\n", "an hour")}) {
    std::ofstream(options.times) << times;
    EXPECT_NE(refusal(options).find(says), std::string::npos) << refusal(options);
  }
}

TEST_F(CompletedSource, RefusesOneScanAlone) {
  scans();
  SourceOptions options;
  write_scan(0, 120, "one");
  options.path = scratch.path("one"), options.complete = 60;
  EXPECT_NE(refusal(options).find("shows 1 scan of ten points or more; two at least can be completed"),
            std::string::npos)
      << refusal(options);
}

TEST_F(CompletedSource, LeavesScansOfFewerThanTenPointsOut) {
  const SourceOptions options = scans();
  write_scan(1, 9);
  opened(options)->next();
  EXPECT_NE(said.find("1 scan has fewer than ten points and are left out"), std::string::npos) << said;
  for (int i = 1; i < kScans; ++i) write_scan(i, 9);
  EXPECT_NE(refusal(options).find("two at least can be completed"), std::string::npos) << refusal(options);
}

TEST_F(CompletedSource, RefusesWhatIsNoScanOrHasNoEnd) {
  SourceOptions options = scans();
  options.follow = true;
  EXPECT_NE(refusal(options).find("is still being written (--follow)"), std::string::npos)
      << refusal(options);
  options.follow = false, options.person = "2";
  EXPECT_NE(refusal(options).find("none can be chosen (--person)"), std::string::npos) << refusal(options);
  options.person.clear();
  EXPECT_NE(failure_of([&] { open_source(options)->next(); }).find("nothing is here that completes scans"),
            std::string::npos);
  options.complete = 0, options.markers = "m.csv";
  EXPECT_NE(refusal(options).find("markers (--markers) are for scans that are completed"), std::string::npos);
  SourceOptions motion;
  motion.path = scratch.path("walk.bvh"), motion.complete = 60;
  std::ofstream(motion.path) << "HIERARCHY\n";
  EXPECT_NE(refusal(motion).find("is a motion already, only scans are completed"), std::string::npos)
      << refusal(motion);
}

}  // namespace
}  // namespace understudy::app
