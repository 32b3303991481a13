us_test(app_test SOURCES
  tests/app/program.cpp tests/app/latency_test.cpp tests/app/judge_test.cpp tests/app/case_folder_test.cpp
  LIBS understudy_app understudy_npz LABELS fast)
