// Prints what writing, opening and cleaning ten thousand OpenPose files costs: keypoint_bench [PEOPLE].
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "retarget/base/text.hpp"
#include "retarget/keypoints/keypoint_filter.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"

namespace understudy {
namespace {

constexpr int kFrames = 10000;

/// Seconds on the clock, and of this process's work: a busy machine has more of the former.
struct Spent {
  double clock = 0, work = 0;
};
Spent spent_now() {
  return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
}

/// Body, hands and face of somebody who sways.
FlatPose swaying(int person, int frame) {
  FlatPose pose;
  const float x = 150.0f * static_cast<float>(person + 1) + 0.37f * static_cast<float>(frame % 100);
  const auto place = [&](int i) {
    return Vec2(x + 3.217f * static_cast<float>(i % 9), 100.123f + 11.41f * static_cast<float>(i));
  };
  for (int i = 0; i < kBodyPoints; ++i) pose.set(i, place(i), 0.8123f);
  for (FlatPoints* points : {&pose.left_hand, &pose.right_hand, &pose.face}) {
    points->resize(points == &pose.face ? kFacePoints : kHandPoints, 3);
    for (int i = 0; i < static_cast<int>(points->rows()); ++i)
      points->row(i) << place(i).x(), place(i % 25).y(), 0.7321f;
  }
  return pose;
}

void write_files(const std::string& folder, int people) {
  KeypointReading all;
  for (int p = 0; p < people; ++p) all.tracks.push_back({p + 1, {}});
  for (int t = 0; t < kFrames; ++t) {
    all.frames.push_back({t, ""});
    for (int p = 0; p < people; ++p)
      all.tracks[static_cast<size_t>(p)].poses.push_back({t, 1, swaying(p, t)});
  }
  const Spent began = spent_now();
  write_openpose_folder(folder, all);
  const Spent written = spent_now();
  std::printf("%d files written in %.2f s (%.2f s of work)\n", kFrames, written.clock - began.clock,
              written.work - began.work);
}

void measure(int people) {
  char name[] = "/tmp/understudy_poses_XXXXXX";
  const std::string folder = ::mkdtemp(name);
  write_files(folder, people);
  for (int round = 0; round < 3; ++round) {
    const Spent began = spent_now();
    const KeypointReading reading = read_keypoints(folder);
    const Spent opened = spent_now();
    const size_t cleaned = clean_track(reading, reading.performer).size();
    std::printf(
        "%d people with hands and faces: %zu files opened in %.2f s (%.2f s of work), cleaned in %.4f ms a "
        "frame\n",
        people, reading.frames.size(), opened.clock - began.clock, opened.work - began.work,
        1000 * (spent_now().work - opened.work) / static_cast<double>(cleaned));
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace understudy

int main(int count, char** arguments) {
  understudy::measure(count > 1 ? std::max(1, std::atoi(arguments[1])) : 1);
  return 0;
}
