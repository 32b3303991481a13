#include "tests/interop/outside_programs.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "tests/app/program.hpp"

namespace understudy::tests {
namespace fs = std::filesystem;
namespace {

/// Where the packages of tests/interop are installed. Throws Error with what ./test noted when it failed.
std::string packages() {
  const fs::path folder = US_INTEROP_PACKAGES, note = folder / "missing.txt";
  US_CHECK(!fs::exists(note), read_bytes(note.string()));
  for (const char* name : {"gltf-validator", "three"})
    US_CHECK(fs::exists(folder / "node_modules" / name), "the npm package ", name, " is not in ",
             folder.string(), "; ./test installs it");
  return folder.string();
}

}  // namespace

nlohmann::json run_node(const std::string& script, const std::vector<std::string>& arguments) {
  ProgramOptions options;
  options.program = "node";
  options.patience_s = 280;  // longer than the scripts have
  std::vector<std::string> all = {US_SOURCE_DIR "/tests/interop/" + script};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Finished done = run_program(all, options);
  US_CHECK(done.code != 127, "node is not installed; ./test installs it");
  US_CHECK(done.code == 0, script, " ended with ", done.code, ": ", done.err.substr(0, 2000));
  return nlohmann::json::parse(done.out);
}

nlohmann::json run_script(const std::string& script, const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {packages()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return run_node(script, all);
}

nlohmann::json validated(const std::vector<std::string>& paths) {
  nlohmann::json reports = run_script("validate.mjs", paths);
  US_CHECK(reports.size() == paths.size(), "the validator looked at ", reports.size(), " files of ",
           paths.size());
  return reports;
}

std::string write_jobs(const std::vector<PlayJob>& jobs) {
  nlohmann::json list = nlohmann::json::array();
  for (const PlayJob& job : jobs)
    list.push_back(
        {{"file", job.file}, {"out", job.out}, {"clip", job.clip}, {"fps", job.fps}, {"times", job.times}});
  const std::string path = jobs.at(0).out + ".jobs.json";
  std::ofstream(path) << list.dump();
  return path;
}

std::vector<Points> read_positions(const PlayJob& job, Eigen::Index vertices) {
  const std::string bytes = read_bytes(job.out);
  const size_t a_time = sizeof(float) * 3 * static_cast<size_t>(vertices);
  US_CHECK(bytes.size() == a_time * job.times.size(), job.file, ": was played with ",
           bytes.size() / 12 / job.times.size(), " vertices in place of ", vertices);
  std::vector<Points> out;
  for (size_t t = 0; t < job.times.size(); ++t) {
    out.emplace_back(vertices, 3);
    std::memcpy(out.back().data(), bytes.data() + t * a_time, a_time);
  }
  return out;
}

}  // namespace understudy::tests
