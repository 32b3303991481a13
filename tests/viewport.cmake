us_test(viewport_test LABELS fast SOURCES
  ${PROJECT_SOURCE_DIR}/tests/ui/viewport_scene_test.cpp ${PROJECT_SOURCE_DIR}/tests/ui/viewport_hand_test.cpp
  LIBS understudy_viewport ui_test_support)
us_test(viewport_gl_test LABELS gl SOURCES ${PROJECT_SOURCE_DIR}/tests/ui/viewport_picture_test.cpp
  LIBS understudy_viewport ui_test_support)
