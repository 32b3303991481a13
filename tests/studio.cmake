us_test(studio_input_test LABELS fast SOURCES tests/app/studio_input_test.cpp LIBS understudy_studio)
us_test(studio_script_test LABELS fast TIMEOUT 600 SOURCES tests/app/studio_script_test.cpp tests/app/program.cpp
  LIBS understudy_studio understudy_npz)

# These run the shipped program.
us_test(studio_program_test SOURCES tests/app/studio_program_test.cpp tests/app/program.cpp tests/app/sample_files.cpp
  LIBS understudy_studio understudy_builtin understudy_npz LABELS torch gl TIMEOUT 1500)
us_test(studio_window_test SOURCES tests/app/studio_window_test.cpp tests/app/program.cpp
  LIBS understudy_studio LABELS torch gl TIMEOUT 1500)
add_dependencies(studio_program_test understudy_all)
add_dependencies(studio_window_test understudy_all)
