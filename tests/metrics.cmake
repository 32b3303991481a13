us_test(metrics_test SOURCES
  tests/retarget/metrics/joint_metrics_test.cpp tests/retarget/metrics/surface_metrics_test.cpp
  tests/retarget/metrics/failures_test.cpp
  LIBS understudy_metrics LABELS fast)
