#include "app/session/frame_cache.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>
#include <thread>

#include "retarget/base/error.hpp"
#include "tests/app/program.hpp"

namespace understudy::app {
namespace {

using namespace std::chrono_literals;

/// What fakes tell the test, and a gate that holds their work up.
struct Probe {
  std::mutex mutex;
  std::condition_variable changed;
  bool open = true;
  int opened = 0, seeks = 0, started = 0;
  std::vector<int> made;  // frames, in order

  void make(int frame) {
    std::unique_lock lock(mutex);
    ++started;
    changed.notify_all();
    changed.wait(lock, [this] { return open; });
    made.push_back(frame);
  }
  void set_open(bool value) {
    std::lock_guard lock(mutex);
    open = value;
    changed.notify_all();
  }
  void wait_started(int count) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return started >= count; });
  }
};

/// A triangle that is `frame` metres up, and lone points of it until there are `points`.
Mesh scan_mesh(int frame, int points) {
  Mesh mesh;
  mesh.vertices = Points::Zero(points, 3);
  for (int i = 0; i < points; ++i)
    mesh.vertices.row(i) << 0.01f * i, static_cast<float>(frame), 0.01f * (i % 7 * (i % 7) % 7);
  mesh.faces.resize(1, 3);
  mesh.faces << 0, 1, 2;
  return mesh;
}

class FakeSource final : public Source {
 public:
  FakeSource(Probe& probe, int count, int points)
      : Source(30), probe_(probe), count_(count), points_(points) {}
  std::optional<SourceFrame> next() override {
    if (at_ >= count_) return {};
    probe_.make(at_);
    SourceFrame frame;
    frame.number = at_;
    frame.mesh = scan_mesh(at_++, points_);
    return frame;
  }
  void seek(int64_t frame) override {
    US_CHECK(frame < count_, "there is no frame ", frame);
    ++probe_.seeks;
    at_ = static_cast<int>(frame);
  }
  std::optional<int64_t> count() const override { return count_; }

 private:
  Probe& probe_;
  int count_, points_, at_ = 0;
};

FrameCache::Open opens(Probe& probe, int count, int points = 16) {
  return [&probe, count, points](const SourceOptions& options) -> std::unique_ptr<Source> {
    EXPECT_TRUE(options.quiet);
    EXPECT_FALSE(options.follow);
    ++probe.opened;
    return std::make_unique<FakeSource>(probe, count, points);
  };
}

SourceOptions source_at(const std::string& path) {
  SourceOptions options;
  options.import.up = "y";
  options.path = path;
  return options;
}

std::shared_ptr<const ScanPicture> scan_now(FrameCache& cache, int frame) {
  cache.scan(frame);
  cache.wait();
  return cache.scan(frame);
}

void rest(const FrameCache& cache) {
  while (cache.busy()) std::this_thread::sleep_for(1ms);
}

TEST(FrameCacheScans, AreMadeInTheBackgroundWithNormals) {
  Probe probe;
  FrameCache cache(64, opens(probe, 10));
  cache.set_source(source_at("scans"), {});
  EXPECT_EQ(cache.scan(3), nullptr);
  cache.wait();
  const auto picture = cache.scan(3);
  ASSERT_NE(picture, nullptr);
  EXPECT_TRUE(picture->usable);
  EXPECT_EQ(picture->mesh.vertices(0, 1), 3);
  ASSERT_EQ(picture->normals.rows(), 16);
  EXPECT_NEAR(std::abs(picture->normals(0, 1)), 1, 1e-5);  // the triangle lies flat
  EXPECT_EQ(probe.made, std::vector<int>{3});
  EXPECT_EQ(cache.made(), 1);
  EXPECT_GT(cache.bytes(), 16 * 24);
}

TEST(FrameCacheScans, CloudsGetEstimatedNormalsAndTheirSpacing) {
  FrameCache cache(64, [](const SourceOptions&) {
    class Plane final : public Source {
     public:
      Plane() : Source(30) {}
      std::optional<SourceFrame> next() override {
        SourceFrame frame;
        frame.mesh.vertices.resize(400, 3);
        for (int i = 0; i < 400; ++i) frame.mesh.vertices.row(i) << 0.01f * (i % 20), 1, 0.01f * (i / 20);
        return frame;
      }
      void seek(int64_t) override {}
      std::optional<int64_t> count() const override { return 1; }
    };
    return std::make_unique<Plane>();
  });
  cache.set_source(source_at("plane"), {});
  const auto picture = scan_now(cache, 0);
  EXPECT_NEAR(picture->spacing, 0.01f, 0.003f);
  EXPECT_GT(picture->normals.col(1).cwiseAbs().minCoeff(), 0.99f);
}

TEST(FrameCacheScans, OneAfterTheOtherNeedNoSeek) {
  Probe probe;
  FrameCache cache(64, opens(probe, 10));
  cache.set_source(source_at("scans"), {});
  for (int frame = 0; frame < 10; ++frame) scan_now(cache, frame);
  EXPECT_EQ(probe.seeks, 0);
  EXPECT_EQ(probe.opened, 1);
  cache.set_source(source_at("scans"), ScanEdits{Box{}, {}});  // other edits: read again, not opened again
  scan_now(cache, 4);
  EXPECT_EQ(probe.seeks, 1);
  EXPECT_EQ(probe.opened, 1);
}

TEST(FrameCacheScans, AreReadOnceAsLongAsTheyAreKept) {
  Probe probe;
  FrameCache cache(64, opens(probe, 10));
  cache.set_source(source_at("scans"), {});
  for (int i = 0; i < 5; ++i) scan_now(cache, 2);
  cache.set_source(source_at("scans"), {});  // no change
  EXPECT_NE(cache.scan(2), nullptr);
  EXPECT_EQ(probe.made.size(), 1u);
}

TEST(FrameCacheScans, TheNewestDemandComesFirst) {
  Probe probe;
  FrameCache cache(64, opens(probe, 100));
  cache.set_source(source_at("scans"), {});
  probe.set_open(false);
  cache.scan(0);
  probe.wait_started(1);  // held up; now the user scrubs
  cache.prefetch_scan(1);
  for (const int frame : {10, 20, 30, 20}) cache.scan(frame);
  probe.set_open(true);
  rest(cache);
  EXPECT_EQ(probe.made, (std::vector<int>{0, 20, 30, 10, 1}));
}

TEST(FrameCacheScans, APrefetchThatIsAskedForIsMadeOnceAndFirst) {
  Probe probe;
  FrameCache cache(64, opens(probe, 100));
  cache.set_source(source_at("scans"), {});
  probe.set_open(false);
  cache.scan(0);
  probe.wait_started(1);
  for (const int frame : {1, 2, 3}) cache.prefetch_scan(frame);
  cache.scan(3);
  cache.prefetch_scan(3);
  probe.set_open(true);
  rest(cache);
  EXPECT_EQ(probe.made, (std::vector<int>{0, 3, 1, 2}));
}

TEST(FrameCacheScans, PrefetchingAndScrubbingAreBounded) {
  Probe probe;
  FrameCache cache(64, opens(probe, 1000));
  cache.set_source(source_at("scans"), {});
  probe.set_open(false);
  cache.scan(0);
  probe.wait_started(1);
  for (int frame = 1; frame < 500; ++frame) cache.prefetch_scan(frame);
  for (int frame = 500; frame < 1000; ++frame) cache.scan(frame);
  probe.set_open(true);
  rest(cache);
  EXPECT_LE(probe.made.size(), 100u);
  EXPECT_EQ(probe.made[1], 999);
}

TEST(FrameCacheScans, AWaitedForPrefetchIsWaitedFor) {
  Probe probe;
  FrameCache cache(64, opens(probe, 10));
  cache.set_source(source_at("scans"), {});
  probe.set_open(false);
  cache.prefetch_scan(0);
  probe.wait_started(1);
  EXPECT_EQ(cache.scan(0), nullptr);
  std::thread later([&] {
    std::this_thread::sleep_for(20ms);
    probe.set_open(true);
  });
  cache.wait();
  EXPECT_NE(cache.scan(0), nullptr);
  later.join();
  EXPECT_EQ(probe.made.size(), 1u);
}

TEST(FrameCacheScans, MemoryDoesNotGrowWithWhatWasLookedAt) {
  Probe probe;
  const int points = 20000;  // 480 kB a frame with normals
  FrameCache cache(4, opens(probe, 60, points));
  cache.set_source(source_at("scans"), {});
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_NE(scan_now(cache, frame), nullptr);
    ASSERT_LE(cache.bytes(), 4 << 20);
  }
  EXPECT_GT(cache.bytes(), 3 << 20);
  EXPECT_NE(cache.scan(59), nullptr);
  EXPECT_EQ(cache.scan(0), nullptr);  // the oldest is gone
  cache.wait();
  cache.set_limit(2);
  EXPECT_LE(cache.bytes(), 2 << 20);
  EXPECT_NE(cache.scan(0), nullptr);
}

TEST(FrameCacheScans, WhatIsUsedStays) {
  Probe probe;
  FrameCache cache(4, opens(probe, 200, 20000));
  cache.set_source(source_at("scans"), {});
  scan_now(cache, 0);
  for (int frame = 1; frame < 50; ++frame) {
    scan_now(cache, frame);
    ASSERT_NE(cache.scan(0), nullptr) << frame;
  }
}

TEST(FrameCacheScans, AFrameThatIsLargerThanTheLimitIsShownAllTheSame) {
  Probe probe;
  FrameCache cache(1, opens(probe, 4, 100000));
  cache.set_source(source_at("scans"), {});
  EXPECT_NE(scan_now(cache, 0), nullptr);
  EXPECT_NE(scan_now(cache, 1), nullptr);
  EXPECT_NE(cache.scan(0), nullptr);  // and the other pane's is not thrown out for it
}

TEST(FrameCacheScans, AnotherSourceForgetsTheOld) {
  Probe probe, other;
  FrameCache cache(64, [&](const SourceOptions& options) {
    return opens(options.path == "old" ? probe : other, options.path == "old" ? 10 : 5)(options);
  });
  cache.set_source(source_at("old"), {});
  scan_now(cache, 2);
  probe.set_open(false);
  cache.scan(3);
  probe.wait_started(2);  // being made for the old one
  cache.set_source(source_at("new"), {});
  EXPECT_EQ(cache.bytes(), 0);
  EXPECT_EQ(cache.scan(2), nullptr);
  probe.set_open(true);
  cache.wait();
  EXPECT_NE(cache.scan(2), nullptr);
  EXPECT_EQ(other.made, std::vector<int>{2});
  EXPECT_EQ(cache.scan(3), nullptr);
}

TEST(FrameCacheScans, AreEdited) {
  Probe probe;
  FrameCache cache(64, opens(probe, 10));
  ScanEdits edits;
  edits.crop = Box{Vec3(-1, -1, -1), Vec3(0.025f, 100, 1)};
  cache.set_source(source_at("scans"), edits);
  EXPECT_EQ(scan_now(cache, 1)->mesh.vertices.rows(), 3);
  edits.crop->high.y() = 0.5f;
  cache.set_source(source_at("scans"), edits);
  const auto nothing = scan_now(cache, 1);
  EXPECT_FALSE(nothing->usable);
  EXPECT_EQ(nothing->problem, "frame 1: the edits leave nothing of the scan");
}

TEST(FrameCacheScans, ThereIsNothingWithoutSourceOrFrame) {
  Probe probe;
  FrameCache cache(64, opens(probe, 3));
  EXPECT_EQ(cache.scan(0), nullptr);
  EXPECT_FALSE(cache.busy());
  cache.set_source(source_at("scans"), {});
  EXPECT_EQ(cache.scan(-1), nullptr);
  EXPECT_FALSE(cache.busy());
  EXPECT_EQ(scan_now(cache, 3)->problem, "there is no frame 3");
  EXPECT_TRUE(scan_now(cache, 2)->usable);  // the others are there all the same
}

TEST(FrameCacheScans, ABrokenFileIsAProblemOfItsFrame) {
  tests::ScratchFolder scratch;
  for (const int frame : {0, 2}) {
    std::ofstream file(scratch.path("frame_" + std::to_string(frame) + ".xyz"));
    for (int i = 0; i < 64; ++i)
      file << 0.1f * (i % 5) << ' ' << 0.0267f * i << ' ' << 0.1f * (i % 3) << '\n';
    if (frame == 2) file << "nan 0 0\n";
  }
  std::ofstream(scratch.path("frame_1.xyz")) << "0 0\n";
  FrameCache cache(64);
  cache.set_source(source_at(scratch.path("")), {});
  EXPECT_FALSE(scan_now(cache, 1)->usable);
  EXPECT_NE(scan_now(cache, 1)->problem.find("frame_1.xyz"), std::string::npos);
  const auto last = scan_now(cache, 2);
  EXPECT_EQ(last->mesh.vertices.rows(), 64);  // what is not finite cannot be drawn
  EXPECT_TRUE(last->mesh.vertices.allFinite() && last->normals.allFinite());
  cache.set_source(source_at(scratch.path("gone")), {});
  EXPECT_FALSE(scan_now(cache, 0)->usable);
  EXPECT_NE(scan_now(cache, 0)->problem.find("gone"), std::string::npos);
}

TEST(FrameCacheScans, AFolderThatIsStillWrittenGrows) {
  tests::ScratchFolder scratch;
  const auto write = [&](int frame) {
    std::ofstream file(scratch.path("frame_" + std::to_string(frame) + ".xyz"));
    for (int i = 0; i < 64; ++i)
      file << 0.1f * (i % 5) << ' ' << 0.0267f * i << ' ' << 0.1f * (i % 3) << '\n';
  };
  write(0);
  write(1);
  SourceOptions options = source_at(scratch.path(""));
  options.follow = true;
  FrameCache cache(64);
  cache.set_source(options, {});
  EXPECT_TRUE(scan_now(cache, 1)->usable);
  write(2);
  EXPECT_TRUE(scan_now(cache, 2)->usable);
}

TEST(FrameCache, EndsWhileItIsBusy) {
  Probe probe;
  probe.set_open(false);
  std::thread later;
  {
    FrameCache cache(64, opens(probe, 1000));
    cache.set_source(source_at("scans"), {});
    for (int frame = 0; frame < 1000; ++frame) cache.scan(frame);
    probe.wait_started(1);
    later = std::thread([&] {
      std::this_thread::sleep_for(20ms);
      probe.set_open(true);
    });
  }
  later.join();
  EXPECT_EQ(probe.made.size(), 1u);  // what was in the making, and no more
}

TEST(FrameCache, EndsWithoutEverWorking) {
  FrameCache cache;
  EXPECT_EQ(cache.bytes(), 0);
  cache.wait();
}

/// Moves the target with the root; offsets are one centimetre up.
class FakeDeformer final : public Deformer {
 public:
  FakeDeformer(Probe& probe, Points rest) : probe_(probe), rest_(std::move(rest)) {}
  void bind(const Points&, const Joints&) override {}
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix) const override { return nullptr; }
  Points deform(const Pose& pose) const override {
    probe_.make(static_cast<int>(pose.root.x()));
    US_CHECK(pose.root.y() >= 0, "the pose is under the floor");
    return rest_.rowwise() + pose.root.transpose();
  }
  Points offsets(const Pose&) const override {
    Points offsets = Points::Zero(rest_.rows(), 3);
    offsets.col(1).setConstant(0.01f);
    return offsets;
  }
  std::string name() const override { return "fake"; }

 private:
  Probe& probe_;
  Points rest_;
  RowMatrix weights_;
};

/// A take of `frames` frames; frame i has its root at (i, 0, 0).
TakeState fake_take(Probe& probe, int frames, int points = 16) {
  auto target = std::make_shared<Target>();
  target->mesh = scan_mesh(0, points);
  TakeState take;
  take.ready = true;
  take.deformer = std::make_shared<FakeDeformer>(probe, target->mesh.vertices);
  take.target = target;
  take.generation = 1;
  take.shown.poses.resize(static_cast<size_t>(frames));
  for (int i = 0; i < frames; ++i) take.shown.poses[static_cast<size_t>(i)].root.x() = static_cast<float>(i);
  return take;
}

std::shared_ptr<const PosedPicture> posed_now(FrameCache& cache, const TakeState& take,
                                              const FrameCache::Wanted& wanted) {
  cache.posed(take, wanted);
  cache.wait();
  return cache.posed(take, wanted);
}

TEST(FrameCachePoses, AreMadeAgainFromTheKeptPoses) {
  Probe probe;
  FrameCache cache(64);
  const TakeState take = fake_take(probe, 10);
  EXPECT_EQ(cache.posed(take, {0, 7}), nullptr);
  cache.wait();
  const auto picture = cache.posed(take, {0, 7});
  ASSERT_NE(picture, nullptr);
  EXPECT_EQ(picture->vertices(0, 0), 7);
  EXPECT_EQ(picture->normals.rows(), 16);
  EXPECT_EQ(picture->offsets.rows(), 0);
  EXPECT_EQ(posed_now(cache, take, {0, 7, true})->offsets(3, 1), 0.01f);
  EXPECT_EQ(cache.posed(take, {0, 10}), nullptr);  // no such frame
  EXPECT_EQ(cache.posed(TakeState(), {1, 0}), nullptr);
  EXPECT_FALSE(cache.busy());
}

TEST(FrameCachePoses, OfACloudHaveNoNormals) {
  Probe probe;
  FrameCache cache(64);
  TakeState take = fake_take(probe, 1);
  auto cloud = std::make_shared<Target>(*take.target);
  cloud->mesh.faces.resize(0, 3);
  take.target = cloud;
  EXPECT_EQ(posed_now(cache, take, {0, 0})->normals.rows(), 0);
}

TEST(FrameCachePoses, OfAnOlderGenerationAreForgotten) {
  Probe probe;
  FrameCache cache(64);
  TakeState take = fake_take(probe, 10), other = fake_take(probe, 10);
  posed_now(cache, take, {0, 1});
  posed_now(cache, other, {1, 1});
  const int64_t both = cache.bytes();
  take.generation = 2;
  take.shown.poses[1].root.z() = 5;
  EXPECT_EQ(cache.posed(take, {0, 1}), nullptr);
  cache.wait();
  EXPECT_EQ(cache.posed(take, {0, 1})->vertices(0, 2), 5);
  EXPECT_NE(cache.posed(other, {1, 1}), nullptr);
  EXPECT_EQ(cache.bytes(), both);
}

TEST(FrameCachePoses, WhatIsMadeForAnOlderGenerationIsDropped) {
  Probe probe;
  FrameCache cache(64);
  TakeState take = fake_take(probe, 10);
  probe.set_open(false);
  cache.posed(take, {0, 1});
  probe.wait_started(1);
  take.generation = 2;
  cache.posed(take, {0, 2});
  probe.set_open(true);
  cache.wait();
  EXPECT_NE(cache.posed(take, {0, 2}), nullptr);
  EXPECT_EQ(cache.posed(take, {0, 1}), nullptr);
  cache.wait();
}

/// Generations are counted by each take: after the first of two takes is removed, the second has its number.
TEST(FrameCachePoses, AreNotThoseOfARemovedTake) {
  Probe probe;
  FrameCache cache(64);
  const TakeState first = fake_take(probe, 10);
  TakeState second = first;  // the same target and deformer, another method
  second.shown.poses[1].root.z() = 5;
  posed_now(cache, first, {0, 1});
  posed_now(cache, second, {1, 1});
  EXPECT_EQ(posed_now(cache, second, {0, 1})->vertices(0, 2), 5);
}

TEST(FrameCachePoses, ThatFailArePicturesWithoutVertices) {
  Probe probe;
  FrameCache cache(64);
  TakeState take = fake_take(probe, 2);
  take.shown.poses[1].root.y() = -1;
  const auto picture = posed_now(cache, take, {0, 1});
  ASSERT_NE(picture, nullptr);
  EXPECT_EQ(picture->vertices.rows(), 0);
}

TEST(FrameCachePoses, MemoryDoesNotGrowWithWhatWasLookedAt) {
  Probe probe;
  FrameCache cache(4);
  const TakeState take = fake_take(probe, 60, 20000);
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_NE(posed_now(cache, take, {0, frame}), nullptr);
    ASSERT_LE(cache.bytes(), 4 << 20);
  }
}

TEST(FrameCachePoses, ArePrefetched) {
  Probe probe;
  FrameCache cache(64);
  const TakeState take = fake_take(probe, 20);
  for (int frame = 1; frame <= 4; ++frame) cache.prefetch_posed(take, {0, frame});
  rest(cache);
  EXPECT_EQ(probe.made, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_NE(cache.posed(take, {0, 4}), nullptr);
}

}  // namespace
}  // namespace understudy::app
