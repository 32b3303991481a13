#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "app/cli/commands.hpp"
#include "app/cli/machine.hpp"
#include "app/run/version.hpp"
#include "render/context/context.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/networks/kernels/kernels.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

void line(const char* what, const std::string& found) {
  std::printf("%-10s %s\n", what, found.c_str());
}

/// What `find` returns, or why it failed.
template <class Find>
std::string found_or_why(Find find, bool& healthy) {
  std::string found;
  const std::string why = failure_of([&] { found = find(); });
  if (why.empty()) return found;
  healthy = false;
  return "MISSING: " + why;
}

/// Those whose weights are in the folder.
std::string present(const MethodChoices& choices, const std::string& folder) {
  std::string names;
  for (const MethodChoice& choice : choices)
    if (!choice.weights || std::filesystem::exists(folder + "/" + choice.weights))
      append_item(names, choice.name);
  return names;
}

std::string weights_line(const nn::NetworkOptions& options) {
  const std::string folder = nn::weights_folder(options);
  US_CHECK(!folder.empty(), "no folder of weights, neither beside the program nor in its source tree");
  const Networks networks = nn::load_networks(options);
  return folder + " (" + networks.extractor->name() + ", " + networks.transfer->name() + ", " +
         networks.deformer->name() + "); engines: " + present(engines(), folder) +
         "; extractors: " + present(extractors(), folder);
}

int doctor(const nn::NetworkOptions& options) {
  bool healthy = true;
  line("program", kProgram);
  line("machine", processor());
  line("kernels", nn::kernels().name);
  line("torch", found_or_why([] { return nn::runtime_report().torch_version; }, healthy));
  if (healthy) {
    const nn::RuntimeReport report = nn::runtime_report();
    line("BLAS", report.blas + ", kernel " + report.blas_core +
                     (report.slow_blas ? ", SLOW: install libopenblas0-openmp" : ""));
    line("threads", std::to_string(report.threads) + ", " + report.threads_why);
    healthy = !report.slow_blas;
  }
  line("weights", found_or_why([&] { return weights_line(options); }, healthy));
  line("OpenGL", found_or_why([] { return render::make_offscreen_context()->description(); }, healthy));
  line("result", healthy ? "everything is here" : "something is missing, see above");
  return healthy ? 0 : 1;
}

}  // namespace

Action declare_doctor(CLI::App& command) {
  const auto options = std::make_shared<nn::NetworkOptions>();
  command.add_option("--weights", options->weights, "folder of the weights (default: beside the program)");
  return [options] { return doctor(*options); };
}

}  // namespace understudy::app
