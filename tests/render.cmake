us_test(render_test LABELS fast SOURCES
  ${PROJECT_SOURCE_DIR}/tests/render/gl_test.cpp ${PROJECT_SOURCE_DIR}/tests/render/camera_test.cpp
  ${PROJECT_SOURCE_DIR}/tests/render/image_test.cpp ${PROJECT_SOURCE_DIR}/tests/render/scene_test.cpp
  ${PROJECT_SOURCE_DIR}/tests/render/picking_test.cpp
  LIBS understudy_render)
us_test(render_gl_test LABELS gl TIMEOUT 300 SOURCES
  ${PROJECT_SOURCE_DIR}/tests/render/golden_test.cpp ${PROJECT_SOURCE_DIR}/tests/render/context_test.cpp
  ${PROJECT_SOURCE_DIR}/tests/render/contact_sheet_test.cpp
  LIBS understudy_render)
us_test(video_test LABELS fast SOURCES ${PROJECT_SOURCE_DIR}/tests/render/video_test.cpp
  LIBS understudy_render PkgConfig::LIBAV)
us_test(window_test LABELS gl SOURCES ${PROJECT_SOURCE_DIR}/tests/render/window_test.cpp LIBS understudy_render)
# Prints what drawing costs; not a test.
add_executable(render_bench ${PROJECT_SOURCE_DIR}/tests/benchmarks/render_bench.cpp)
target_link_libraries(render_bench PRIVATE warnings understudy_render)
set_target_properties(render_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
