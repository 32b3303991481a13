us_test(app_test SOURCES
  tests/app/program.cpp tests/app/latency_test.cpp tests/app/evaluator_test.cpp tests/app/case_folder_test.cpp
  tests/app/source_test.cpp tests/app/preview_test.cpp tests/app/report_test.cpp
  tests/retarget/motion/made_motion.cpp tests/retarget/character/characters.cpp
  LIBS understudy_app understudy_npz LABELS fast)

us_test(exports_test SOURCES tests/app/exports_test.cpp tests/retarget/character/characters.cpp
  LIBS understudy_run understudy_npz LABELS fast)

# These run the shipped program: each run loads LibTorch.
us_test(commands_test SOURCES
  tests/app/commands_test.cpp tests/app/program.cpp tests/app/sample_files.cpp tests/support/training_folder.cpp
  tests/retarget/motion/made_motion.cpp tests/retarget/character/characters.cpp
  LIBS understudy_character understudy_npz understudy_builtin understudy_body nlohmann_json::nlohmann_json LABELS torch gl TIMEOUT 600)
us_test(bad_input_test SOURCES
  tests/app/bad_input_test.cpp tests/app/program.cpp tests/app/sample_files.cpp
  LIBS understudy_npz understudy_builtin LABELS torch gl TIMEOUT 600)
us_test(low_poly_test SOURCES
  tests/app/low_poly_test.cpp tests/app/program.cpp tests/app/sample_files.cpp
  tests/retarget/motion/made_motion.cpp tests/retarget/character/characters.cpp
  LIBS understudy_character understudy_builtin understudy_body understudy_metrics LABELS torch TIMEOUT 600)
add_dependencies(low_poly_test understudy_all)
us_test(target_command_test SOURCES
  tests/app/target_command_test.cpp tests/app/program.cpp tests/app/sample_files.cpp
  tests/retarget/character/characters.cpp
  LIBS understudy_npz understudy_builtin understudy_body understudy_character LABELS torch gl TIMEOUT 600)
add_dependencies(target_command_test understudy_all)
add_dependencies(commands_test understudy_all)
add_dependencies(bad_input_test understudy_all)

us_test(example_test SOURCES tests/app/example_test.cpp tests/app/program.cpp tests/app/sample_files.cpp
  LIBS understudy_builtin LABELS torch)
add_executable(retarget_minimal tests/example/retarget_minimal.cpp)
target_link_libraries(retarget_minimal PRIVATE warnings understudy_formats understudy_pipeline understudy_networks)
add_dependencies(retarget_minimal networks_plugin)
add_dependencies(example_test retarget_minimal)

add_test(NAME layers COMMAND ${PROJECT_SOURCE_DIR}/tests/check_layers.sh)
add_test(NAME layers_are_enforced COMMAND ${PROJECT_SOURCE_DIR}/tests/check_layers_test.sh)
add_test(NAME build_script COMMAND ${PROJECT_SOURCE_DIR}/tests/build_script_test.sh)
set_tests_properties(layers layers_are_enforced build_script PROPERTIES LABELS fast)

us_test(measure_commands_test SOURCES
  tests/app/measure_commands_test.cpp tests/app/program.cpp tests/app/sample_files.cpp tests/support/training_folder.cpp
  LIBS understudy_npz understudy_builtin understudy_body nlohmann_json::nlohmann_json LABELS torch gl TIMEOUT 600)
add_dependencies(measure_commands_test understudy_all)
us_test(measure_test SOURCES tests/render/plot_test.cpp tests/app/case_maker_test.cpp tests/app/program.cpp tests/support/training_folder.cpp
  LIBS understudy_run understudy_render understudy_data_folder understudy_npz LABELS fast)
