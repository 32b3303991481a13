// The program where threads, memory or weights are other than it would like.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <mutex>

#include "retarget/base/log.hpp"
#include "retarget/networks/networks.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;

TEST(Threads, AHundredThousandAreClamped) {
  ProgramOptions options;
  options.environment = {"OMP_NUM_THREADS=100000"};
  const Finished run = run_program({"doctor"}, options);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("OMP_NUM_THREADS=100000 is more than this machine can use"), std::string::npos)
      << run.err;
}

TEST(AddressSpace, TooLittleForLibTorchIsToldInOneSentence) {
  const ScratchFolder scratch;
  const std::string samples = US_SOURCE_DIR "/assets/samples/";
  const std::string command = std::string("ulimit -v 1048576; timeout 60 ") + US_PROGRAM +
                              " retarget --engine paper --source " + samples + "scan --target " + samples +
                              "target_adult.glb --out " + scratch.path("motion.npz") + " 2> " +
                              scratch.path("said");
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  EXPECT_NE(read_bytes(scratch.path("said")).find("of address space"), std::string::npos)
      << read_bytes(scratch.path("said"));
}

TEST(Weights, ThatLackPartsAreWarnedOf) {
  const ScratchFolder scratch;
  for (const auto& file : fs::directory_iterator(US_SOURCE_DIR "/assets/weights"))
    if (file.path().filename() != "part.weights")
      fs::create_symlink(file.path(), scratch.path(file.path().filename().string()));
  std::mutex mutex;
  std::string told;
  const auto before = log::set_sink([&](log::Level level, const std::string& message) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (level == log::Level::Warning) told += message + "\n";
  });
  nn::NetworkOptions options;
  options.weights = scratch.path("");
  nn::load_networks(options);
  log::set_sink(before);
  EXPECT_NE(told.find("part.weights: is missing"), std::string::npos) << told;
}

}  // namespace
}  // namespace understudy::tests
