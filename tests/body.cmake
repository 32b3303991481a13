us_test(builtin_test SOURCES
  tests/retarget/body/builtin_person_test.cpp tests/retarget/body/builtin_motion_test.cpp
  tests/retarget/body/capture_test.cpp tests/retarget/body/builtin_samples_test.cpp
  tests/retarget/body/costume_test.cpp
  LIBS understudy_builtin understudy_occlusions understudy_metrics understudy_formats LABELS fast TIMEOUT 300)
