us_test(editing_test LABELS fast SOURCES
  tests/retarget/editing/scan_edits_test.cpp
  tests/retarget/editing/skeleton_edits_test.cpp
  tests/retarget/editing/leg_ik_test.cpp
  tests/retarget/editing/pose_edits_test.cpp
  tests/retarget/editing/target_edits_test.cpp
  LIBS understudy_editing understudy_builtin understudy_metrics)
