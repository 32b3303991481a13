// Prints what keypoints cost a frame, with one thread: by slots, and by paper 3's own network at the paper's
// size and at the trained one. Their numbers are drawn at random, which costs the same.
#include <torch/torch.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "retarget/base/rng.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/slot_net.hpp"
#include "retarget/nn/modules/voxel_keypoints.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy {
namespace {

constexpr int kFurther = 4, kKeypoints = 28;
constexpr int kBodyPoints = 6890, kScanPoints = 50000;  // an SMPL body's vertices, a raw scan's

/// Milliseconds on the clock, and of this process's work: a busy machine has more of the former.
struct Spent {
  double clock = 0, work = 0;
};
Spent spent_now() {
  return {1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
}

Mesh some_cloud(int points) {
  Mesh cloud;
  cloud.vertices = Points(points, 3);
  Rng rng(1);
  for (float& number : cloud.vertices.reshaped()) number = rng.uniform(-1, 1);
  return cloud;
}

Spent find_in(KeypointFinder& finder, int frames, int points) {
  const std::vector<Mesh> scans(static_cast<size_t>(frames), some_cloud(points));
  const Spent began = spent_now();
  finder.find(scans);
  const Spent ended = spent_now();
  return {ended.clock - began.clock, ended.work - began.work};
}

void print_costs(const std::string& name, KeypointFinder& finder) {
  find_in(finder, 1, kBodyPoints);  // what is done once
  for (const int points : {kBodyPoints, kScanPoints}) {
    const Spent one = find_in(finder, 1, points), more = find_in(finder, 1 + kFurther, points);
    std::printf(
        "%s, %d points: first frame %.0f ms (%.0f of work), each further one %.0f ms (%.0f); %d thread%s\n",
        name.c_str(), points, one.clock, one.work, (more.clock - one.clock) / kFurther,
        (more.work - one.work) / kFurther, torch::get_num_threads(),
        torch::get_num_threads() == 1 ? "" : "s");
  }
}

void measure_slots(const std::string& folder) {
  nn::SlotNet net(kKeypoints);
  const std::string file = folder + "/slots.weights";
  nn::save_weights(
      file, {"marionette-slots", nn::kSlotVersion, {{"slots", kKeypoints}}, {{"kind", "person"}}}, *net);
  print_costs("slots", *nn::load_slots(file));
}

void measure_paper(int64_t grid, int64_t width, const std::string& folder) {
  nn::VoxelKeypointsForm form;
  form.grid = grid;
  form.width = width;
  nn::VoxelKeypointsNet net(form);
  const std::string file = folder + "/bench.weights";
  nn::save_weights(
      file,
      {"marionette-paper",
       nn::kVoxelKeypointsVersion,
       {{"keypoints", 24}, {"grid", static_cast<double>(grid)}, {"width", static_cast<double>(width)}},
       {{"kind", "person"}}},
      *net);
  print_costs("paper, " + std::to_string(grid) + " cells, " + std::to_string(width) + " channels",
              *nn::load_paper_keypoints(file));
}

}  // namespace
}  // namespace understudy

int main() {
  torch::set_num_threads(1);
  char name[] = "/tmp/understudy_bench_XXXXXX";
  const char* folder = mkdtemp(name);
  if (!folder) return 1;
  understudy::measure_slots(folder);
  understudy::measure_paper(32, 32, folder);
  understudy::measure_paper(64, 128, folder);
  std::filesystem::remove_all(folder);
  return 0;
}
