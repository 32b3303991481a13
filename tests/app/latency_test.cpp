#include "app/run/latency.hpp"

#include <gtest/gtest.h>

namespace understudy::app {
namespace {

TEST(Histogram, FindsMedianAndTail) {
  Histogram h;
  for (int i = 1; i <= 100; ++i) h.add(i);
  EXPECT_NEAR(h.quantile(0.5), 50, 0.5);
  EXPECT_NEAR(h.quantile(0.95), 95, 0.95);
  EXPECT_NEAR(h.quantile(1), 100, 1);
}

TEST(Histogram, IsZeroWhenEmpty) {
  EXPECT_EQ(Histogram().quantile(0.5), 0);
}

TEST(Histogram, TakesExtremes) {
  Histogram h;
  h.add(0);
  h.add(1e9);
  EXPECT_NEAR(h.quantile(0.5), 0.001, 1e-5);
  EXPECT_GT(h.quantile(1), 9e5);
}

TEST(Histogram, AddsAnother) {
  Histogram a, b;
  a.add(1);
  b.add(9);
  b.add(9);
  a.add(b);
  EXPECT_EQ(a.count(), 3);
  EXPECT_NEAR(a.quantile(0.5), 9, 0.1);
  EXPECT_DOUBLE_EQ(a.total_ms(), 19);
}

TEST(Latency, TellsEveryStage) {
  Latency latency;
  latency.add({1, 2, 3, 4, 10});
  EXPECT_NEAR(latency.quantile(2, 0.5), 3, 0.03);
  EXPECT_NE(latency.table().find("deform"), std::string::npos);
  EXPECT_NE(latency.table().find("1 frames, 100.0 frames/s"), std::string::npos);
}

}  // namespace
}  // namespace understudy::app
