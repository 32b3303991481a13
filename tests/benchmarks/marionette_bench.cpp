// Prints what paper 3's own keypoints cost a frame, at the paper's size and at the trained one; one thread.
#include <torch/torch.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "retarget/base/rng.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/voxel_keypoints.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy {
namespace {

constexpr int kFurther = 4;

/// Milliseconds on the clock, and of this process's work: a busy machine has more of the former.
struct Spent {
  double clock = 0, work = 0;
};
Spent spent_now() {
  return {1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
}

Mesh some_cloud() {
  Mesh cloud;
  cloud.vertices = Points(20000, 3);
  Rng rng(1);
  for (float& number : cloud.vertices.reshaped()) number = rng.uniform(-1, 1);
  return cloud;
}

Spent find_in(KeypointFinder& finder, int frames) {
  const std::vector<Mesh> scans(static_cast<size_t>(frames), some_cloud());
  const Spent began = spent_now();
  finder.find(scans);
  const Spent ended = spent_now();
  return {ended.clock - began.clock, ended.work - began.work};
}

void measure(int64_t grid, int64_t width, const std::string& folder) {
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
  const auto finder = nn::load_paper_keypoints(file);
  find_in(*finder, 1);  // what is done once
  const Spent one = find_in(*finder, 1), more = find_in(*finder, 1 + kFurther);
  std::printf(
      "%lld cells, %lld channels: first frame %.0f ms (%.0f of work), each further one %.0f ms (%.0f)\n",
      static_cast<long long>(grid), static_cast<long long>(width), one.clock, one.work,
      (more.clock - one.clock) / kFurther, (more.work - one.work) / kFurther);
}

}  // namespace
}  // namespace understudy

int main() {
  torch::set_num_threads(1);
  char name[] = "/tmp/understudy_bench_XXXXXX";
  const char* folder = mkdtemp(name);
  if (!folder) return 1;
  understudy::measure(32, 32, folder);
  understudy::measure(64, 128, folder);
  std::filesystem::remove_all(folder);
  return 0;
}
