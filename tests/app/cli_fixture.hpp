// What the tests of the shipped program share: files made once, and what a clean failure is.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"

namespace understudy::tests {

class ShippedProgram : public testing::Test {
 protected:
  static constexpr int kFrames = 5;
  static void SetUpTestSuite() {
    shared_ = std::make_unique<ScratchFolder>();
    write_target(shared_->path("target.obj"));
    write_scans(shared_->path("scans"), kFrames);
  }
  static void TearDownTestSuite() { shared_.reset(); }

  static std::string target() { return shared_->path("target.obj"); }
  static std::string scans() { return shared_->path("scans"); }
  std::string out(const std::string& name) {
    std::filesystem::create_directories(scratch.path("out"));
    return scratch.path("out/" + name);
  }
  std::vector<std::string> out_files() {
    std::vector<std::string> names;
    std::filesystem::create_directories(scratch.path("out"));
    for (const auto& entry : std::filesystem::directory_iterator(scratch.path("out")))
      names.push_back(entry.path().filename().string());
    return names;
  }

  Finished retarget(const std::string& source, std::vector<std::string> more = {},
                    ProgramOptions options = {}) {
    std::vector<std::string> arguments = {"retarget", "--source", source, "--target", target()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, std::move(options));
  }

  /// One sentence for the user, a bad exit code that is not a crash, and no file.
  void expect_clean_failure(const Finished& run, const std::string& says) {
    EXPECT_GT(run.code, 0) << run.err;
    EXPECT_LT(run.code, 126) << run.err;
    const size_t at = run.err.rfind("understudy: ");
    ASSERT_NE(at, std::string::npos) << run.err;
    const std::string sentence = run.err.substr(at);
    EXPECT_EQ(line_count(sentence), 1) << run.err;
    EXPECT_NE(sentence.find(says), std::string::npos) << sentence;
    EXPECT_TRUE(out_files().empty()) << out_files().front();
  }

  ScratchFolder scratch;

 private:
  static std::unique_ptr<ScratchFolder> shared_;
};

inline std::unique_ptr<ScratchFolder> ShippedProgram::shared_;

}  // namespace understudy::tests
