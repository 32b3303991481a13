#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "app/cli/commands.hpp"
#include "app/cli/job.hpp"
#include "app/cli/samples.hpp"
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
  for (const char* name : {"target_adult", "target_child"}) {
    JobOptions job;
    job.source.path = samples + "/scan";
    job.target.path = samples + "/" + name + ".glb";
    const std::string stem = (fs::path(out) / name).string();
    job.out = stem + ".glb";
    job.report = stem + ".json";
    job.preview = stem + ".png";
    run_job(job);
  }
  return 0;
}

}  // namespace

Action declare_demo(CLI::App& command) {
  const auto out = std::make_shared<std::string>("out");
  command.add_option("--out", *out, "folder for the results");
  return [out] { return demo(*out); };
}

}  // namespace understudy::app
