us_test(metrics_test SOURCES
  tests/retarget/metrics/joint_metrics_test.cpp tests/retarget/metrics/surface_metrics_test.cpp
  tests/retarget/metrics/failures_test.cpp tests/retarget/metrics/bent_volume_test.cpp tests/retarget/metrics/windings_test.cpp
  LIBS understudy_metrics understudy_builtin LABELS fast)
