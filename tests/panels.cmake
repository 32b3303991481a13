add_library(panels_test_support STATIC ${PROJECT_SOURCE_DIR}/tests/ui/support/panels_test.cpp)
target_link_libraries(panels_test_support PUBLIC ui_test_support understudy_panels PRIVATE warnings)

us_test(panels_test LABELS fast SOURCES
  ${PROJECT_SOURCE_DIR}/tests/ui/panels_edit_test.cpp ${PROJECT_SOURCE_DIR}/tests/ui/panels_inspector_test.cpp
  ${PROJECT_SOURCE_DIR}/tests/ui/panels_rig_test.cpp ${PROJECT_SOURCE_DIR}/tests/retarget/character/characters.cpp
  ${PROJECT_SOURCE_DIR}/tests/ui/panels_timeline_test.cpp ${PROJECT_SOURCE_DIR}/tests/ui/panels_workspace_test.cpp
  LIBS panels_test_support)
us_test(panels_picture_test LABELS gl SOURCES ${PROJECT_SOURCE_DIR}/tests/ui/panels_picture_test.cpp
  LIBS panels_test_support)
