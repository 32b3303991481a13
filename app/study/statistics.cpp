#include "app/study/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"

namespace understudy::app {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kMostFactors = 8;

bool has(Effect effect, size_t factor) {
  return (effect >> factor & 1u) != 0;
}

void check(const FactorialData& data, Effect effect) {
  US_CHECK(data.values.rows() >= 2, "statistics need at least two participants, here is ",
           data.values.rows());
  Eigen::Index cells = 1;
  for (const int levels : data.levels) {
    US_CHECK(levels >= 2, "a factor needs at least two levels to compare");
    cells *= levels;
  }
  US_CHECK(cells == data.values.cols(), "the design has ", cells, " cells, the data ", data.values.cols());
  US_CHECK(effect > 0 && effect < 1u << data.levels.size(), "there is no effect ", effect);
}

/// Along one factor: every value becomes the mean over its levels, or what is left without that mean.
void split(Eigen::MatrixXd& values, int levels, Eigen::Index stride, bool keep_mean) {
  for (Eigen::Index block = 0; block < values.cols(); block += stride * levels)
    for (Eigen::Index first = block; first < block + stride; ++first) {
      Eigen::VectorXd mean = Eigen::VectorXd::Zero(values.rows());
      for (int k = 0; k < levels; ++k) mean += values.col(first + k * stride);
      mean /= levels;
      for (int k = 0; k < levels; ++k) {
        auto column = values.col(first + k * stride);
        if (keep_mean) {
          column = mean;
        } else {
          column -= mean;
        }
      }
    }
}

/// The part of each row that belongs to an effect: deviations over its factors, means over the others.
Eigen::MatrixXd component(Eigen::MatrixXd values, const std::vector<int>& levels, Effect effect) {
  Eigen::Index stride = values.cols();
  for (size_t f = 0; f < levels.size(); ++f) {
    stride /= levels[f];
    split(values, levels[f], stride, !has(effect, f));
  }
  return values;
}

/// Means of the cells, but over all levels of the factors that are not in the effect.
Eigen::MatrixXd means_over_others(Eigen::MatrixXd values, const std::vector<int>& levels, Effect effect) {
  Eigen::Index stride = values.cols();
  for (size_t f = 0; f < levels.size(); ++f) {
    stride /= levels[f];
    if (!has(effect, f)) split(values, levels[f], stride, true);
  }
  return values;
}

/// What is left of the cells' means, plus the estimate of what is looked at; ranked.
FactorialData ranked(const FactorialData& data, const Eigen::RowVectorXd& estimate) {
  const Eigen::RowVectorXd shift = estimate - data.values.colwise().mean();
  return {data.levels, average_ranks(data.values.rowwise() + shift)};
}

double normal_tail(double z) {  // P(Z >= z)
  return 0.5 * std::erfc(z * M_SQRT1_2);
}

/// Gauss-Legendre over equal panels of [low, high].
template <class Function>
double integral(Function f, double low, double high, int panels) {
  using Rule = boost::math::quadrature::gauss<double, 20>;
  const double width = (high - low) / panels;
  double sum = 0;
  for (int i = 0; i < panels; ++i) sum += Rule::integrate(f, low + i * width, low + (i + 1) * width);
  return sum;
}

/// P(range of k standard normal values >= w). With z the largest of them,
/// k * integral of phi(z) * (Phi(z)^(k-1) - (Phi(z) - Phi(z - w))^(k-1)), written so that tails keep digits.
double range_upper_tail(double w, int k) {
  const auto integrand = [&](double u) {
    const double z = w / 2 + u;
    const double below = normal_tail(-z), far = normal_tail(w - z);
    const double density = std::exp(-z * z / 2) / std::sqrt(2 * M_PI);
    const double share = std::min(far / below, 1.0);  // of a value below the largest: below it by w or more
    if (!(below > 0)) return 0.0;
    if (share >= 1) return density * std::pow(below, k - 1);
    return density * std::pow(below, k - 1) * -std::expm1((k - 1) * std::log1p(-share));
  };
  return std::min(k * integral(integrand, -9, 9, 4), 1.0);
}

}  // namespace

std::vector<Effect> all_effects(int factor_count) {
  US_CHECK(factor_count >= 1 && factor_count <= kMostFactors, "an analysis has 1 to ", kMostFactors,
           " factors, here are ", factor_count);
  std::vector<Effect> effects(size_t{1} << factor_count);
  std::iota(effects.begin(), effects.end(), 0u);
  effects.erase(effects.begin());
  const auto first_differs = [](Effect a, Effect b) {  // whose lowest factor that the other lacks comes first
    const Effect difference = a ^ b;
    return (a & difference & (~difference + 1)) != 0;
  };
  std::sort(effects.begin(), effects.end(), [&](Effect a, Effect b) {
    const int count_a = __builtin_popcount(a), count_b = __builtin_popcount(b);
    return count_a != count_b ? count_a < count_b : a != b && first_differs(a, b);
  });
  return effects;
}

int level_count(const std::vector<int>& levels, Effect effect) {
  int count = 1;
  for (size_t f = 0; f < levels.size(); ++f)
    if (has(effect, f)) count *= levels[f];
  return count;
}

Eigen::MatrixXd average_ranks(const Eigen::MatrixXd& values) {
  const Eigen::ArrayXXd keys = (values.array() * 1e8).round();
  std::vector<Eigen::Index> order(static_cast<size_t>(values.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return keys.data()[a] < keys.data()[b]; });
  Eigen::MatrixXd ranks(values.rows(), values.cols());
  for (size_t begin = 0; begin < order.size();) {
    size_t end = begin + 1;
    while (end < order.size() && keys.data()[order[end]] == keys.data()[order[begin]]) ++end;
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);
    for (; begin < end; ++begin) ranks.data()[order[begin]] = rank;
  }
  return ranks;
}

EffectTest within_anova(const FactorialData& data, Effect effect) {
  check(data, effect);
  const auto n = static_cast<double>(data.values.rows());
  const Eigen::MatrixXd parts = component(data.values, data.levels, effect);  // [n, cells]
  const Eigen::RowVectorXd mean = parts.colwise().mean();
  const double tiny = 1e-20 * data.values.squaredNorm();  // below it: rounding of values that are equal
  const double ss_effect = n * mean.squaredNorm();
  const double ss_error = (parts.rowwise() - mean).squaredNorm();

  EffectTest test;
  test.df1 = 1;
  for (size_t f = 0; f < data.levels.size(); ++f)
    if (has(effect, f)) test.df1 *= data.levels[f] - 1;
  test.df2 = test.df1 * (n - 1);
  if (ss_error > tiny) {
    test.F = ss_effect / test.df1 / (ss_error / test.df2);
  } else {
    test.F = ss_effect > tiny ? std::numeric_limits<double>::infinity() : kNaN;
  }
  test.p = f_upper_tail(test.F, test.df1, test.df2);
  test.eta2p = std::isnan(test.F) ? kNaN : ss_effect / (ss_effect + ss_error);
  return test;
}

FactorialData aligned_ranks(const FactorialData& data, Effect effect) {
  check(data, effect);
  return ranked(data, component(data.values.colwise().mean(), data.levels, effect));
}

EffectTest art_anova(const FactorialData& data, Effect effect) {
  return within_anova(aligned_ranks(data, effect), effect);
}

FactorialData collapsed(const FactorialData& data, Effect effect) {
  check(data, effect);
  const Eigen::MatrixXd means = means_over_others(data.values, data.levels, effect);
  FactorialData one;
  one.levels = {level_count(data.levels, effect)};
  one.values.resize(means.rows(), one.levels[0]);
  Eigen::Index to = 0;
  for (Eigen::Index cell = 0; cell < means.cols(); ++cell) {
    bool first = true;  // of the cells that have the same mean: other factors at level 0
    Eigen::Index rest = cell;
    for (size_t f = data.levels.size(); f-- > 0; rest /= data.levels[f])
      first = first && (has(effect, f) || rest % data.levels[f] == 0);
    if (first) one.values.col(to++) = means.col(cell);
  }
  return one;
}

std::vector<PairTest> tukey_comparisons(const FactorialData& one_factor) {
  US_CHECK(one_factor.levels.size() == 1, "comparisons want one factor, here are ", one_factor.levels.size());
  check(one_factor, 1);
  const auto n = static_cast<double>(one_factor.values.rows());
  const int k = one_factor.levels[0];
  const double df = (n - 1) * (k - 1);
  const Eigen::MatrixXd parts = component(one_factor.values, one_factor.levels, 1);
  const Eigen::RowVectorXd mean = one_factor.values.colwise().mean();
  const double tiny = 1e-20 * one_factor.values.squaredNorm();
  const double ss_error = (parts.rowwise() - parts.colwise().mean()).squaredNorm();
  const double error = ss_error > tiny ? std::sqrt(2 * ss_error / df / n) : 0;  // of a difference

  std::vector<PairTest> all;
  for (int a = 0; a < k; ++a)
    for (int b = a + 1; b < k; ++b) {
      PairTest one{a, b, mean[a] - mean[b], 0, df, 1};
      const bool equal = std::abs(one.difference) <= std::sqrt(tiny / n);
      one.t = error == 0 && equal ? kNaN : one.difference / error;
      one.p = studentised_range_upper_tail(std::abs(one.t) * M_SQRT2, k, df);
      all.push_back(one);
    }
  return all;
}

std::vector<PairTest> art_contrasts(const FactorialData& data, Effect effect) {
  check(data, effect);
  return tukey_comparisons(
      collapsed(ranked(data, means_over_others(data.values.colwise().mean(), data.levels, effect)), effect));
}

double f_upper_tail(double F, double df1, double df2) {
  if (std::isnan(F)) return kNaN;
  if (std::isinf(F)) return 0;
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(df1, df2), F));
}

double studentised_range_upper_tail(double q, int k, double df) {
  US_CHECK(k >= 2 && df > 0, "a studentised range wants two means and degrees of freedom");
  if (std::isnan(q)) return kNaN;
  if (q <= 0) return 1;
  if (std::isinf(q)) return 0;
  // s: the error's estimate over its true value. The integrand is s's density times a tail that falls about
  // as exp(-(q s)^2 / 4): it lies between the peak of both together and that of the density alone.
  const double log_scale = std::log(2.0) + df / 2 * std::log(df / 2) - std::lgamma(df / 2);
  const double steep = df + q * q / 2;
  const double peak = std::sqrt(std::max(df - 1, 0.0) / steep), width = 1 / std::sqrt(2 * steep);
  const double density_end = std::sqrt(std::max(df - 1, 0.0) / df) + 10 / std::sqrt(2 * df);
  const double low = std::max(peak - 10 * width, 0.0);
  const double high = std::min(density_end, peak + 14 * width + 6 / q);
  const auto integrand = [&](double s) {
    if (s <= 0) return 0.0;
    return std::exp(log_scale + (df - 1) * std::log(s) - df * s * s / 2) * range_upper_tail(q * s, k);
  };
  return std::min(integral(integrand, low, high, 6), 1.0);
}

double intraclass_correlation(const Eigen::MatrixXd& ratings) {
  const auto raters = static_cast<double>(ratings.rows()), things = static_cast<double>(ratings.cols());
  US_CHECK(raters >= 2 && things >= 2, "agreement needs two raters and two things that they rate");
  const double mean = ratings.mean();
  const Eigen::RowVectorXd of_things = ratings.colwise().mean();
  const Eigen::VectorXd of_raters = ratings.rowwise().mean();
  const double ss_things = raters * (of_things.array() - mean).square().sum();
  const double ss_raters = things * (of_raters.array() - mean).square().sum();
  const double ss_error = (ratings.array() - mean).square().sum() - ss_things - ss_raters;
  const double ms_things = ss_things / (things - 1), ms_raters = ss_raters / (raters - 1);
  const double ms_error = ss_error / ((things - 1) * (raters - 1));
  const double all = ms_things + (raters - 1) * ms_error + raters * (ms_raters - ms_error) / things;
  return all > 1e-20 * ratings.squaredNorm() ? (ms_things - ms_error) / all : kNaN;
}

FactorialData simulated_answers(const SimulatedStudy& study, uint64_t seed) {
  US_CHECK(!study.levels.empty() && study.repetitions >= 1,
           "a simulated study needs factors and repetitions");
  US_CHECK(study.shifts.empty() || static_cast<int>(study.shifts.size()) == study.levels[0],
           "a simulated study has ", study.levels[0], " levels of the first factor and ", study.shifts.size(),
           " shifts");
  US_CHECK(study.levels.size() <= kMostFactors, "a simulated study has at most ", kMostFactors, " factors");
  double answers = static_cast<double>(study.participants) * study.repetitions;
  for (const int levels : study.levels) answers *= levels;
  US_CHECK(answers <= 1e7, "a simulated study has at most ten million answers, this one ", answers);
  Rng rng(seed);
  FactorialData data;
  data.levels = study.levels;
  const int cells = level_count(study.levels, (1u << study.levels.size()) - 1);
  data.values.resize(study.participants, cells);
  const double middle = 0.5 * (study.low + study.high);
  for (int i = 0; i < study.participants; ++i) {
    const double own = middle + study.participant_sd * rng.normal();
    for (int cell = 0; cell < cells; ++cell) {
      const double shift = study.shifts.empty() ? 0 : study.shifts[cell / (cells / study.levels[0])];
      const double usual = own + shift + study.habit_sd * rng.normal();
      double sum = 0;
      for (int r = 0; r < study.repetitions; ++r)
        sum += std::clamp(std::round(usual + study.noise_sd * rng.normal()), study.low, study.high);
      data.values(i, cell) = sum / study.repetitions;
    }
  }
  return data;
}

double detection_rate(const SimulatedStudy& study, Effect effect, int simulations, uint64_t seed,
                      double level) {
  Rng seeds(seed);
  int found = 0;
  for (int i = 0; i < simulations; ++i)
    if (art_anova(simulated_answers(study, seeds.next()), effect).p < level) ++found;
  return static_cast<double>(found) / simulations;
}

}  // namespace understudy::app
