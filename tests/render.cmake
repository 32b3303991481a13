us_test(render_test LABELS fast SOURCES
  ${PROJECT_SOURCE_DIR}/tests/render/gl_test.cpp ${PROJECT_SOURCE_DIR}/tests/render/camera_test.cpp
  ${PROJECT_SOURCE_DIR}/tests/render/image_test.cpp ${PROJECT_SOURCE_DIR}/tests/render/scene_test.cpp
  LIBS understudy_render)
us_test(render_gl_test LABELS gl TIMEOUT 300 SOURCES
  ${PROJECT_SOURCE_DIR}/tests/render/golden_test.cpp ${PROJECT_SOURCE_DIR}/tests/render/context_test.cpp
  ${PROJECT_SOURCE_DIR}/tests/render/contact_sheet_test.cpp
  LIBS understudy_render)
