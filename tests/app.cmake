us_test(app_test SOURCES
  tests/app/program.cpp tests/app/latency_test.cpp tests/app/judge_test.cpp tests/app/case_folder_test.cpp
  tests/app/source_test.cpp tests/app/preview_test.cpp tests/app/report_test.cpp
  LIBS understudy_app understudy_npz LABELS fast)
