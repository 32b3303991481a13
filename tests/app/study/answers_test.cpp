#include "app/study/answers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "tests/app/program.hpp"

namespace understudy::app {
namespace {

const std::string kHeader = "participant,trial,question,answer,rt_ms,replays,shown_at,method\n";

class AnswersTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder()); }
  std::string folder() const { return scratch_.path("answers"); }
  void add(const std::string& name, const std::string& text) { write_file(folder() + "/" + name, text); }
  /// The sentence that reading ends with; empty where it goes well.
  std::string complaint() const {
    return failure_of([&] { read_answers(folder()); });
  }
  /// The same of one file with these lines after the header.
  std::string complaint_of(const std::string& lines) {
    add("P1.csv", kHeader + lines);
    return complaint();
  }
  tests::ScratchFolder scratch_;
};

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), text.npos) << text;
}

TEST_F(AnswersTest, AreReadWithTheirFactors) {
  add("b.csv", "\xef\xbb\xbf" + kHeader + "P2,1,motion,6,1500.5,2,2024-05-02T10:00:00,ours\r\n");
  add("a.csv", kHeader + "P9,1,motion,4,,,,\"ours, \"\"new\"\"\"\nP9,1,shape,,900,0,,TST\n");
  add("notes.txt", "not answers");
  const StudyAnswers all = read_answers(folder());
  EXPECT_EQ(all.factors, std::vector<std::string>{"method"});
  ASSERT_EQ(all.participants.size(), 2u);
  EXPECT_EQ(all.participants[0].participant, "P2");
  const StudyAnswer& first = all.participants[0].answers[0];
  EXPECT_EQ(first.answer, "6");
  EXPECT_EQ(first.rt_ms, 1500.5);
  EXPECT_EQ(first.replays, 2);
  EXPECT_EQ(first.levels, std::vector<std::string>{"ours"});
  ASSERT_EQ(all.participants[1].answers.size(), 2u);
  const StudyAnswer& quoted = all.participants[1].answers[0];
  EXPECT_EQ(quoted.levels[0], "ours, \"new\"");
  EXPECT_TRUE(std::isnan(quoted.rt_ms));
  EXPECT_EQ(all.participants[1].answers[1].answer, "");
}

TEST_F(AnswersTest, OfAFileCutInALineAreRefused) {
  const std::string good = "P1,1,motion,4,900,0,,ours\n";
  EXPECT_EQ(complaint_of(good), "");
  expect_contains(complaint_of(good + "P1,2,motion,4,900,0,,our"), "P1.csv: is cut off in line 3");
  expect_contains(complaint_of(good + "P1,2,mot\n"),
                  "P1.csv: line 3 is cut off: it has 3 columns, the header 8");
  expect_contains(complaint_of(good + "P1,2,motion,4,900,0,,\"our\n"), "line 3 is cut off: a quote");
  expect_contains(complaint_of(good + "P1,2,motion,4,900,0,,ours,1\n"), "line 3 has 9 columns");
  add("P1.csv", "");
  expect_contains(complaint(), "P1.csv: is empty");
  expect_contains(complaint_of(""), "has no answers");
}

TEST_F(AnswersTest, OfOneParticipantInTwoFilesAreRefused) {
  add("P1.csv", kHeader + "P1,1,motion,4,900,0,,ours\n");
  add("copy.csv", kHeader + "P1,1,motion,5,900,0,,ours\n");
  expect_contains(complaint(), "copy.csv: line 2 is of participant \"P1\", whose answers are in ");
}

TEST_F(AnswersTest, OfTwoParticipantsInOneFileAreRefused) {
  expect_contains(complaint_of("P1,1,motion,4,900,0,,ours\nP2,1,motion,4,900,0,,ours\n"),
                  "P1.csv: line 3 is of participant \"P2\" in the file of \"P1\"");
}

TEST_F(AnswersTest, GivenTwiceAreRefused) {
  expect_contains(complaint_of("P1,1,motion,4,900,0,,ours\nP1,1,motion,5,900,0,,ours\n"),
                  "P1.csv: line 3 answers \"motion\" of trial 1 again, after line 2");
}

TEST_F(AnswersTest, WithNumbersThatAreNoneAreRefused) {
  expect_contains(complaint_of("P1,1,motion,4,fast,0,,ours\n"), "line 2: rt_ms \"fast\"");
  expect_contains(complaint_of("P1,1,motion,4,-3,0,,ours\n"), "line 2: rt_ms \"-3\"");
  expect_contains(complaint_of("P1,1,motion,4,9,1.5,,ours\n"), "line 2: replays \"1.5\"");
  expect_contains(complaint_of("P1,,motion,4,9,1,,ours\n"), "line 2 names no trial");
}

TEST_F(AnswersTest, WithOtherColumnsAreRefused) {
  add("P1.csv", "participant,trial,answer\nP1,1,4\n");
  expect_contains(complaint(), "P1.csv: column 3 should be \"question\", but is \"answer\"");
  add("P1.csv", kHeader + "P1,1,motion,4,900,0,,ours\n");
  add("P2.csv",
      "participant,trial,question,answer,rt_ms,replays,shown_at,engine\nP2,1,motion,4,900,0,,ours\n");
  expect_contains(complaint(), "P2.csv: line 1 has other factors than ");
  add("P2.csv", "participant,trial,question,answer,rt_ms,replays,shown_at,a,a\nP2,1,motion,4,900,0,,x,y\n");
  expect_contains(complaint(), "P2.csv: the factor \"a\" is there twice");
}

TEST_F(AnswersTest, AreLookedForInAFolder) {
  expect_contains(complaint(), "has no .csv files of answers");
  expect_contains(failure_of([&] { read_answers(scratch_.path("none")); }), "is not a folder of answers");
}

TEST(CsvCell, ComesBack) {
  for (const std::string text : {"plain", "a,b", "say \"no\"", "", "\"", ",\","}) {
    EXPECT_EQ(csv_cells(csv_cell(text) + "," + csv_cell("next")), (std::vector<std::string>{text, "next"}));
  }
  EXPECT_THROW(csv_cells("\"open"), std::invalid_argument);
}

}  // namespace
}  // namespace understudy::app
