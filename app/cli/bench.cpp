#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/cli/bench_ui.hpp"
#include "app/cli/commands.hpp"
#include "app/cli/job.hpp"
#include "app/cli/machine.hpp"
#include "app/cli/options.hpp"
#include "app/cli/progress.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy::app {
namespace {

struct BenchOptions {
  std::string source, target;
  int64_t frames = 300;
  MethodOptions how;
};

/// The same source again and again, up to a number of frames: one long sequence.
class Repeated final : public Source {
 public:
  Repeated(const SourceOptions& options, int64_t frames)
      : Source(options.fps > 0 ? options.fps : 30),
        options_(options),
        left_(frames),
        inner_(open_source(options)) {}
  std::optional<SourceFrame> next() override {
    if (left_-- <= 0) return std::nullopt;
    auto frame = inner_->next();
    if (frame) return frame;
    const auto sink = log::set_sink([](log::Level, const std::string&) {});  // all of it was logged once
    inner_ = open_source(options_);
    frame = inner_->next();
    log::set_sink(sink);
    US_CHECK(frame, options_.path, ": has no frames");
    return frame;
  }
  void seek(int64_t frame) override { inner_->seek(frame); }
  std::optional<int64_t> count() const override { return std::nullopt; }

 private:
  SourceOptions options_;
  int64_t left_;
  std::unique_ptr<Source> inner_;
};

/// Floating-point operations of the default extraction network for one scan, by its shape: 128 patches of 24
/// points, width 192, 4 encoder and 2 decoder layers, feed-forward 384 (nn/modules/skeleton_extractor). A
/// product and a sum count as two; what is not a matrix product is left out.
double extraction_flop() {
  constexpr double M = 128, K = 24, C = 192, F = 384, J = 22;
  const double embed = M * K * (3 * 64 + 64 * 96) + M * 96 * C + M * (3 * C + C * C);
  const double encoder = M * 4 * C * C + 2 * M * M * C + M * 2 * C * F;
  const double votes = M * (C * 256 + 256 * (23 + J + 3 * J));
  const double among = J * 4 * C * C + 2 * J * J * C;
  const double across = 2 * J * C * C + 2 * M * C * C + 2 * J * M * C;
  const double decoder = among + across + J * 2 * C * F;
  const double read_off = J * M * C + J * (C * 128 + 128 * 10);
  return 2 * (embed + 4 * encoder + votes + 2 * decoder + read_off);
}

/// Skinning: some five influences of twelve numbers a vertex, one transform, and two offset blocks of 3 x 9.
double deformation_flop(Eigen::Index vertices) {
  return 2.0 * static_cast<double>(vertices) * (5 * 12 + 12 + 2 * 27);
}

void print_work(const Latency& latency, Eigen::Index vertices) {
  const double flop = extraction_flop() + deformation_flop(vertices), peak = gemm_gflops();
  const double seconds = latency.quantile(4, 0.5) / 1000, rate = flop / seconds / 1e9;
  std::printf("work           %.1f MFLOP a frame (estimated), %.2f GFLOP/s\n", flop / 1e6, rate);
  if (peak > 0)
    std::printf("peak           %.1f GFLOP/s (matrix product): %.1f %% of it used\n", peak,
                100 * rate / peak);
}

int bench(const BenchOptions& options) {
  SourceOptions from;
  from.path = options.source.empty() ? samples_folder() + "/scan" : options.source;
  TargetOptions onto;
  onto.path = options.target.empty() ? samples_folder() + "/target_adult.glb" : options.target;
  Networks networks = nn::load_networks(network_options(options.how));
  const auto character = open_target(onto, networks);
  Repeated source(from, options.frames);
  networks = networks_for(std::move(networks), *character, on_their_rig(onto, *character));
  Retargeter retargeter(std::move(networks), retarget_options(options.how));
  retargeter.set_target(character->target);
  RetargetedSource retargeted(source, retargeter, from);
  Latency latency;
  double first_s = 0, memory_1000 = 0;
  Progress progress("bench", options.frames);
  while (const auto frame = retargeted.next()) {
    const int64_t i = frame->index;
    check_interrupt("after frame " + std::to_string(i));
    if (i == 0) first_s = seconds_since_start();
    if (i > 0) latency.add(frame->times);  // the first frame also pays for what is done once
    if (i + 1 == 1000) memory_1000 = resident_mb();
    progress.step(i + 1);
  }
  progress.finish();
  const double memory_end = resident_mb(), memory_peak = peak_resident_mb();
  std::printf("machine        %s\n", processor().c_str());
  std::printf("%s", latency.table().c_str());
  std::printf("start-up       %.2f s to the first finished frame\n", first_s);
  std::printf("memory         %.0f MB at the end, %.0f MB at most\n", memory_end, memory_peak);
  if (options.frames > 1000)
    std::printf("long run       %.0f MB at frame 1000, %.0f MB at frame %lld: x %.3f\n", memory_1000,
                memory_end, static_cast<long long>(options.frames), memory_end / memory_1000);
  print_work(latency, character->target.mesh.vertices.rows());
  return 0;
}

}  // namespace

Action declare_bench(CLI::App& command) {
  const auto options = std::make_shared<BenchOptions>();
  command.add_option("--source", options->source,
                     "scans, repeated as often as needed (default: the bundled one)");
  command.add_option("--target", options->target, "a body in T-pose (default: a bundled one)");
  command.add_option("--frames", options->frames, "how many; 10000 shows whether memory grows")
      ->check(CLI::Range(2, 10000000));
  add_method_options(command, options->how);
  const auto ui_options = std::make_shared<UiBenchOptions>();
  CLI::App* ui = command.add_subcommand("ui", "the studio: frames a second, delays, start-up, memory");
  ui->add_option("--context", ui_options->context, "OpenGL context: any, egl, osmesa")
      ->check(CLI::IsMember({"any", "egl", "osmesa"}));
  ui->add_option("--seconds", ui_options->seconds, "time per measurement")->check(CLI::Range(0.5, 600.0));
  ui->add_option("--weights", ui_options->weights, "folder of the weights (default: beside the program)");
  return [options, ui_options, ui] { return ui->parsed() ? bench_ui(*ui_options) : bench(*options); };
}

}  // namespace understudy::app
