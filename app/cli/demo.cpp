#include <CLI/CLI.hpp>
#include <filesystem>
#include <future>
#include <vector>

#include "app/cli/commands.hpp"
#include "app/cli/job.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

/// The bundled scan onto each bundled target: OUT/<target>.glb, .json and .png.
int demo(const std::string& out) {
  namespace fs = std::filesystem;
  std::error_code failed;
  fs::create_directories(out, failed);
  US_CHECK(fs::is_directory(out), out, ": the folder cannot be made");
  const std::string samples = samples_folder();
  // One job a core: they share nothing but the sample.
  std::vector<std::future<void>> jobs;
  for (const char* name : {"target_adult", "target_child"}) {
    JobOptions job;
    job.source.path = samples + "/scan";
    job.target.path = samples + "/" + name + ".glb";
    const std::string stem = (fs::path(out) / name).string();
    job.out = stem + ".glb";
    job.report = stem + ".json";
    job.preview = stem + ".png";
    job.progress_lines = true;
    jobs.push_back(std::async(std::launch::async, [job] { run_job(job); }));
  }
  for (auto& job : jobs) job.wait();
  for (auto& job : jobs) job.get();
  return 0;
}

}  // namespace

Action declare_demo(CLI::App& command) {
  const auto out = std::make_shared<std::string>("out");
  command.add_option("--out", *out, "folder for the results");
  return [out] { return demo(*out); };
}

}  // namespace understudy::app
