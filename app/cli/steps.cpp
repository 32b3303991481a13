#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/cli/commands.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/motion_space/linear_coder.hpp"
#include "retarget/motion_space/step_score.hpp"
#include "retarget/networks/networks.hpp"

namespace understudy::app {
namespace {

struct StepsOptions {
  std::string data, split = "dev", out;
  std::vector<std::string> weights;  ///< folders; empty: the program's own
  std::vector<int> linear;           ///< sizes of linear coders beside them
  StepScoreOptions score;
};

Json errors_json(const StepErrors& errors) {
  return {{"steps", errors.steps},
          {"mpjpe_m", errors.joints_mm / 1000},
          {"mve_m", errors.vertices_mm / 1000},
          {"duration_s", errors.duration_ms / 1000}};
}

void print_errors(const std::string& name, const StepScore& score) {
  std::printf("%-24s", name.c_str());
  for (const StepErrors& errors : {score.walks, score.all})
    std::printf(" | %4d %7.1f %7.1f %6.0f", errors.steps, errors.vertices_mm, errors.joints_mm,
                errors.duration_ms);
  std::printf("\n");
  std::fflush(stdout);
}

class StepsReport {
 public:
  explicit StepsReport(const StepsOptions& options)
      : options_(options),
        split_(read_split(options.data, options.split)),
        body_(mean_body(split_)),
        clips_(read_step_clips(split_, body_.joints)) {}

  void add(const std::string& name, MotionCoder& coder) {
    check_interrupt("before " + name);
    const StepScore score = score_steps(coder, clips_, body_, options_.score);
    print_errors(name, score);
    rows_.push_back({{"coder", name},
                     {"size", coder.size()},
                     {"walks", errors_json(score.walks)},
                     {"all", errors_json(score.all)}});
  }

  void add_linear() {
    const auto train = read_step_clips(read_split(options_.data, "train"), body_.joints);
    const RowMatrix rows = step_rows(train, leg_length(body_.joints));
    for (const int size : options_.linear) {
      add("linear " + std::to_string(size), *fit_linear_coder(rows, size));
      add("linear " + std::to_string(size) + " by reach", *fit_linear_coder(rows, size, &body_));
    }
  }

  const Json& rows() const { return rows_; }

 private:
  const StepsOptions& options_;
  DataSplit split_;
  ShapedBody body_;
  std::vector<StepClip> clips_;
  Json rows_ = Json::array();
};

int steps(const StepsOptions& options) {
  check_writable(options.out);
  StepsReport report(options);
  std::printf("%-24s | %-27s | %-27s\n%-24s", "", "walks and runs", "all", "coder");
  for (int i = 0; i < 2; ++i) std::printf(" | %4s %7s %7s %6s", "n", "mve mm", "mpjpe", "ms");
  std::printf("\n");
  const std::vector<std::string> own = {nn::weights_folder({})};
  for (const std::string& folder : options.weights.empty() ? own : options.weights)
    report.add(options.weights.empty() ? "paper" : folder, *nn::load_motion_coder(folder));
  if (!options.linear.empty()) report.add_linear();
  if (!options.out.empty()) write_json(options.out, {{"split", options.split}, {"coders", report.rows()}});
  return 0;
}

}  // namespace

Action declare_steps(CLI::App& command) {
  const auto options = std::make_shared<StepsOptions>();
  command.add_option("data", options->data, "folder of people and motions with splits.json")->required();
  command.add_option("--split", options->split, "split of splits.json (default: dev)");
  command.add_option("--weights", options->weights,
                     "folders with motion_steps.weights to compare (default: the program's own)");
  command
      .add_option("--linear", options->linear,
                  "principal components beside them, so many: fitted to the split train, each number "
                  "counting alike, and as much as it moves the surface")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024));
  command.add_option("--frames", options->score.frames, "frames that are compared of a step (default: 100)")
      ->check(CLI::Range(2, 1000));
  command.add_option("--out", options->out, "the figures as JSON");
  return [options] { return steps(*options); };
}

}  // namespace understudy::app
