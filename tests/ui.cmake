# The fixture that every test of the interface shares.
add_library(ui_test_support STATIC
  ${PROJECT_SOURCE_DIR}/tests/ui/support/ui_test.cpp ${PROJECT_SOURCE_DIR}/tests/ui/support/pictures.cpp)
target_include_directories(ui_test_support PUBLIC ${PROJECT_SOURCE_DIR}/tests/ui)
target_link_libraries(ui_test_support PUBLIC understudy_gui GTest::gtest PRIVATE warnings)

us_test(gui_test LABELS fast SOURCES ${PROJECT_SOURCE_DIR}/tests/ui/gui_test.cpp LIBS ui_test_support)
us_test(widgets_test LABELS fast SOURCES ${PROJECT_SOURCE_DIR}/tests/ui/widgets_test.cpp LIBS ui_test_support)
us_test(file_browser_test LABELS fast SOURCES ${PROJECT_SOURCE_DIR}/tests/ui/file_browser_test.cpp
  LIBS ui_test_support)
us_test(gallery_test LABELS gl SOURCES
  ${PROJECT_SOURCE_DIR}/tests/ui/gallery_test.cpp ${PROJECT_SOURCE_DIR}/tests/ui/support/gallery.cpp
  LIBS ui_test_support)
