#include "app/study/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

Eigen::MatrixXd row(std::initializer_list<double> values) {
  Eigen::MatrixXd all(1, static_cast<Eigen::Index>(values.size()));
  Eigen::Index at = 0;
  for (const double value : values) all(0, at++) = value;
  return all;
}

TEST(AverageRanks, EqualValuesShareTheirMeanRank) {
  EXPECT_EQ(average_ranks(row({3, 1, 3, 2, 3})), row({4, 1, 4, 2, 4}));
  EXPECT_EQ(average_ranks(row({0.1 + 0.2, 0.3, 0.3 + 1e-6})), row({1.5, 1.5, 3}));
}

TEST(AllEffects, ComeInTheOrderOfR) {
  EXPECT_EQ(all_effects(3), (std::vector<Effect>{1, 2, 4, 3, 5, 6, 7}));
  EXPECT_THROW(all_effects(0), Error);
  EXPECT_THROW(all_effects(9), Error);
}

TEST(StudentisedRange, AgreesWithRToSixDigits) {
  const std::string table = read_file(US_SOURCE_DIR "/tests/data/study/studentised_range.csv");
  TextCursor lines(table, "table");
  lines.line();
  int rows = 0;
  for (; !lines.at_end(); ++rows) {
    const auto cells = split(lines.line(), ',');
    ASSERT_EQ(cells.size(), 5u);
    const double q = std::stod(cells[0]), df = std::stod(cells[2]);
    const int k = std::stoi(cells[1]);
    const double p = studentised_range_upper_tail(q, k, df), integral = std::stod(cells[4]);
    EXPECT_NEAR(p, integral, 2e-7 * integral) << "q " << q << ", k " << k << ", df " << df;
    // R's ptukey is coarser: 1e-4 off at df 2, 1e-6 for 45 means.
    if (df >= 8) EXPECT_NEAR(p, std::stod(cells[3]), k <= 10 ? 5e-7 : 2e-6) << q << " " << k << " " << df;
  }
  EXPECT_EQ(rows, 350);
}

// The range of two means is the t distribution in another dress, and that is the F distribution with one
// degree of freedom: no other program is needed, and tails may be small.
TEST(StudentisedRange, OfTwoMeansIsTheTDistribution) {
  for (const double t : {0.01, 0.5, 2.0, 6.0, 12.0})
    for (const double df : {1.0, 2.0, 9.0, 58.0, 400.0, 50000.0}) {
      const double expected = f_upper_tail(t * t, 1, df);
      EXPECT_NEAR(studentised_range_upper_tail(t * std::sqrt(2.0), 2, df) / expected, 1, 1e-6)
          << "t " << t << ", df " << df;
    }
}

TEST(StudentisedRange, HasEnds) {
  EXPECT_EQ(studentised_range_upper_tail(0, 3, 10), 1);
  EXPECT_EQ(studentised_range_upper_tail(INFINITY, 3, 10), 0);
  EXPECT_TRUE(std::isnan(studentised_range_upper_tail(NAN, 3, 10)));
  EXPECT_NEAR(studentised_range_upper_tail(1e-6, 45, 10), 1, 1e-9);
  EXPECT_THROW(studentised_range_upper_tail(1, 1, 10), Error);
}

// Three participants, two conditions: differences 1, 2, 3. t = 2 / (1 / sqrt(3)), F = t^2 = 12.
TEST(WithinAnova, OfTwoConditionsIsThePairedT) {
  FactorialData data{{2}, Eigen::MatrixXd(3, 2)};
  data.values << 2, 1, 5, 3, 10, 7;
  const EffectTest test = within_anova(data, 1);
  EXPECT_NEAR(test.F, 12, 1e-12);
  EXPECT_EQ(test.df1, 1);
  EXPECT_EQ(test.df2, 2);
  EXPECT_NEAR(test.p, 0.07417990, 1e-8);
  EXPECT_NEAR(test.eta2p, 12.0 / 14, 1e-12);
  const auto pairs = tukey_comparisons(data);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_NEAR(pairs[0].t, std::sqrt(12.0), 1e-12);
  EXPECT_NEAR(pairs[0].p, test.p, 1e-9);
  EXPECT_NEAR(pairs[0].difference, 2, 1e-12);
}

TEST(WithinAnova, SaysSoWhereNothingVaries) {
  FactorialData data{{2, 2}, Eigen::MatrixXd::Constant(4, 4, 3.3)};
  EXPECT_TRUE(std::isnan(art_anova(data, 3).F));
  EXPECT_TRUE(std::isnan(art_anova(data, 3).p));
  EXPECT_TRUE(std::isnan(art_contrasts(data, 1)[0].p));
  data.values.leftCols(2).array() += 1;  // all agree exactly
  EXPECT_TRUE(std::isinf(within_anova(data, 1).F));
  EXPECT_EQ(within_anova(data, 1).p, 0);
  EXPECT_EQ(tukey_comparisons(collapsed(data, 1))[0].p, 0);
}

TEST(WithinAnova, RefusesWhatCannotBeTested) {
  const FactorialData one_participant{{2}, Eigen::MatrixXd::Zero(1, 2)};
  const FactorialData one_level{{1}, Eigen::MatrixXd::Zero(3, 1)};
  const FactorialData wrong_cells{{2, 3}, Eigen::MatrixXd::Zero(3, 5)};
  for (const auto& data : {one_participant, one_level, wrong_cells}) {
    EXPECT_THROW(within_anova(data, 1), Error);
    EXPECT_THROW(art_anova(data, 1), Error);
    EXPECT_THROW(art_contrasts(data, 1), Error);
  }
}

TEST(AlignedRanks, TakeTheOtherEffectsAway) {
  FactorialData data = simulated_answers({12, {3, 2}, 1, {}, 0.5, 0.3, 0.7}, 4);
  const EffectTest before = art_anova(data, 1);
  data.values.col(1).array() += 50;  // the second factor, hugely
  data.values.col(3).array() += 50;
  data.values.col(5).array() += 50;
  EXPECT_NEAR(art_anova(data, 1).F, before.F, 1e-9);
  EXPECT_LT(art_anova(data, 2).p, 1e-6);
}

// Shrout and Fleiss (1979), table 2: six targets, four judges. Their ICC(2,1) is .29.
TEST(IntraclassCorrelation, IsThatOfShroutAndFleiss) {
  Eigen::MatrixXd ratings(6, 4);
  ratings << 9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7;
  EXPECT_NEAR(intraclass_correlation(ratings.transpose()), 0.2898, 5e-5);
  EXPECT_TRUE(std::isnan(intraclass_correlation(Eigen::MatrixXd::Constant(3, 3, 4))));
}

class NullEffect : public testing::TestWithParam<uint64_t> {};

TEST_P(NullEffect, IsFoundInOneOfTwentySimulations) {
  const SimulatedStudy study{20, {3, 2}, 2, {}, 0.8, 0.4, 1.2};
  const double rate = detection_rate(study, 1, 2000, GetParam());
  EXPECT_GE(rate, 0.04);
  EXPECT_LE(rate, 0.06);
}
INSTANTIATE_TEST_SUITE_P(Seeds, NullEffect, testing::Values(1, 2, 3));

TEST(SimulatedStudy, HasBounds) {
  EXPECT_THROW(simulated_answers({30, {1000, 1000, 1000, 1000}, 1, {}}, 1), Error);
  EXPECT_THROW(simulated_answers({30, std::vector<int>(9, 2), 1, {}}, 1), Error);
  EXPECT_THROW(simulated_answers({30, {}, 1, {}}, 1), Error);
  EXPECT_THROW(simulated_answers({30, {3}, 1, {1, 2}}, 1), Error);
}

TEST(KnownEffect, IsFoundWithThirtyParticipants) {
  SimulatedStudy study{30, {3, 3}, 5, {0.6, -0.4, 0}, 0.8, 0.4, 1.2};
  const FactorialData answers = simulated_answers(study, 1);
  EXPECT_LT(art_anova(answers, 1).p, 1e-6);
  for (const PairTest& one : art_contrasts(answers, 1)) EXPECT_LT(one.p, 0.05) << one.a << one.b;
  EXPECT_GT(detection_rate(study, 1, 200, 1), 0.99);
  study.repetitions = 1;
  study.participants = 5;
  study.shifts = {0.2, -0.2, 0};
  EXPECT_LT(detection_rate(study, 1, 200, 1), 0.6);
}

}  // namespace
}  // namespace understudy::app
