#include "app/run/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "tests/app/program.hpp"

namespace understudy::app {
namespace {

TEST(Report, NamesTheWeightsWithTheirChecksums) {
  const tests::ScratchFolder scratch;
  std::ofstream(scratch.path("skeleton.weights")) << "123456789";  // CRC-32's check value is cbf43926
  std::ofstream(scratch.path("notes.txt")) << "x";
  EXPECT_EQ(report_header(scratch.path(""))["weights"], "skeleton.weights:cbf43926");
  EXPECT_EQ(report_header("")["weights"], "");
}

TEST(Report, KeepsTheOrderOfFigures) {
  EXPECT_EQ(to_json(Metrics{{"mpjpe_m", 0.5}, {"acc", 1}}).dump(), R"({"mpjpe_m":0.5,"acc":1.0})");
}

TEST(Report, IsWrittenWholeOrNotAtAll) {
  const tests::ScratchFolder scratch;
  write_json(scratch.path("r.json"), {{"a", 1}});
  EXPECT_EQ(Json::parse(tests::read_bytes(scratch.path("r.json")))["a"], 1);
  EXPECT_EQ(scratch.files(), std::vector<std::string>{"r.json"});
  EXPECT_THROW(write_json(scratch.path("no/r.json"), {}), Error);
}

TEST(CheckWritable, RefusesWhatCannotBeMade) {
  const tests::ScratchFolder scratch;
  EXPECT_NO_THROW(check_writable(scratch.path("r.json")));
  EXPECT_TRUE(scratch.files().empty());
  EXPECT_THROW(check_writable(scratch.path("no/r.json")), Error);
  EXPECT_THROW(check_writable(scratch.path("")), Error);
}

}  // namespace
}  // namespace understudy::app
