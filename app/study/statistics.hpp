// Statistics of perceptual studies: within-subject analysis of variance, aligned ranks, Tukey's comparisons.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace understudy::app {

/// What every participant answered in every cell of a full factorial within-subject design: one value each
/// (repetitions are averaged before).
struct FactorialData {
  std::vector<int> levels;  ///< how many each factor has, at least 2
  Eigen::MatrixXd values;   ///< [participants, cells]; over the cells the last factor changes fastest
};

/// A set of factors: bit f is factor f. One bit is a main effect, several are an interaction.
using Effect = uint32_t;
/// Main effects first, then interactions of two, and so on; each group in the order of the factors, as R
/// lists them. At most 8 factors.
std::vector<Effect> all_effects(int factor_count);
/// Combinations of levels of the factors in an effect.
int level_count(const std::vector<int>& levels, Effect effect);

/// Ranks of all entries, from 1; equal ones share their mean rank. Values within 1e-8 / 2 of the same
/// multiple of 1e-8 are equal (ARTool's rule: alignment leaves rounding errors where ties were).
Eigen::MatrixXd average_ranks(const Eigen::MatrixXd& values);

/// The test of one effect. F and p are NaN where nothing varies; F is infinite and p 0 where participants
/// agree exactly.
struct EffectTest {
  double F = 0, df1 = 0, df2 = 0, p = 1;
  double eta2p = 0;  ///< partial eta squared: SS effect / (SS effect + SS error)
};

/// Analysis of variance of a within-subject design: the effect against its own interaction with the
/// participants, as R's aov(y ~ A*B + Error(participant/(A*B))). No sphericity correction.
/// Throws Error for fewer than two participants, a factor with one level, or a wrong number of cells.
EffectTest within_anova(const FactorialData& data, Effect effect);

/// Values stripped of every effect but one, then ranked over all participants and cells (aligned rank
/// transform: Wobbrock, Findlater, Gergle, Higgins, CHI 2011). Cells are those of the factors, not of the
/// participants, as in ARTool.
FactorialData aligned_ranks(const FactorialData& data, Effect effect);
/// within_anova() of the aligned ranks, of the effect that they were aligned for.
EffectTest art_anova(const FactorialData& data, Effect effect);

/// Two levels compared; for an interaction, two combinations of levels.
struct PairTest {
  int a = 0, b = 0;
  double difference = 0;  ///< mean of a - mean of b, of what was compared (values or ranks)
  double t = 0, df = 0;
  double p = 1;  ///< adjusted for all pairs by Tukey's studentised range; NaN where nothing varies
};

/// The combinations of levels of an effect as one factor, the others averaged away: [participants, levels].
FactorialData collapsed(const FactorialData& data, Effect effect);
/// All pairs of levels of a one-factor design, with the error of its repeated-measures ANOVA: Tukey's
/// honestly significant difference, as R's TukeyHSD(aov(y ~ condition + participant), "condition").
std::vector<PairTest> tukey_comparisons(const FactorialData& one_factor);
/// Contrasts after the aligned rank transform (ART-C: Elkin, Kay, Higgins, Wobbrock, UIST 2021): the effect's
/// factors become one, values are aligned for its levels and ranked, and its pairs compared as above.
std::vector<PairTest> art_contrasts(const FactorialData& data, Effect effect);

/// P(F' >= F) of the F distribution; NaN stays NaN.
double f_upper_tail(double F, double df1, double df2);
/// P(Q >= q) of the studentised range of k means with df degrees of freedom of the error: R's ptukey(q, k,
/// df, lower.tail = FALSE). By its double integral (Lund and Lund, AS 190, 1983), with Gauss-Legendre rules;
/// also small tails are right to six digits.
double studentised_range_upper_tail(double q, int k, double df);

/// Agreement between raters: intraclass correlation ICC(2,1) of Shrout and Fleiss (1979), two-way random
/// effects, absolute agreement, one rater. Raters are rows, rated things columns, [raters, things]; 1 is full
/// agreement, about 0 none. NaN where nothing varies.
double intraclass_correlation(const Eigen::MatrixXd& ratings);

/// A study that is simulated before anybody is asked: Likert answers with a known effect of the first factor.
struct SimulatedStudy {
  int participants = 30;
  std::vector<int> levels = {3};
  int repetitions = 1;
  std::vector<double> shifts;   ///< of the levels of the first factor, points of the scale; empty: no effect
  double participant_sd = 0.8;  ///< how much participants differ in their mean
  double habit_sd = 0.4;        ///< how much they differ in a cell, the same in each repetition
  double noise_sd = 1.2;        ///< of one answer
  double low = 1, high = 7;     ///< answers are rounded to whole points of this scale
};
/// One run of it, repetitions averaged.
FactorialData simulated_answers(const SimulatedStudy& study, uint64_t seed);
/// Share of simulations in which art_anova() finds the effect at this level: the power of the design where
/// there are shifts, the rate of false alarms where there are none.
double detection_rate(const SimulatedStudy& study, Effect effect, int simulations, uint64_t seed,
                      double level = 0.05);

}  // namespace understudy::app
