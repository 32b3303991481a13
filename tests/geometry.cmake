us_test(geometry_test LABELS fast SOURCES
  ${PROJECT_SOURCE_DIR}/tests/retarget/base/fields_test.cpp
  ${PROJECT_SOURCE_DIR}/tests/retarget/geometry/cloud_normals_test.cpp
  ${PROJECT_SOURCE_DIR}/tests/retarget/geometry/ambient_occlusion_test.cpp
  LIBS understudy_core)
