find_package(CLI11 REQUIRED)

# What command line and studio share.
us_module(run SOURCES
  app/run/breakdown.cpp app/run/case_folder.cpp app/run/case_maker.cpp app/run/exports.cpp app/run/file_figures.cpp app/run/interrupt.cpp app/run/evaluator.cpp app/run/latency.cpp app/run/performer.cpp
  app/run/report.cpp app/run/samples.cpp app/run/source.cpp app/run/target_file.cpp
  PUBLIC understudy_core understudy_metrics understudy_formats understudy_pipeline understudy_character nlohmann_json::nlohmann_json
  PRIVATE understudy_npz understudy_motion understudy_data_folder understudy_occlusions understudy_results ZLIB::ZLIB)

include(app/session/session.cmake)
include(app/studio/studio.cmake)

# What the subcommands share, apart from the program so that tests can link it.
us_module(app SOURCES
  app/cli/evaluation.cpp app/cli/job.cpp app/cli/machine.cpp app/cli/preview.cpp app/cli/progress.cpp app/cli/worst_frames.cpp
  PUBLIC understudy_run understudy_networks understudy_render
  PRIVATE understudy_baselines ${CMAKE_DL_LIBS})

add_executable(understudy app/main.cpp app/cli/commands.cpp app/cli/bench.cpp app/cli/bench_ui.cpp app/cli/cases.cpp app/cli/demo.cpp
  app/cli/doctor.cpp app/cli/eval.cpp app/cli/export.cpp app/cli/import_worker.cpp app/cli/measure.cpp app/cli/play.cpp app/cli/report.cpp app/cli/report_page.cpp app/cli/report_rows.cpp app/cli/retarget.cpp app/cli/sample.cpp app/cli/source_options.cpp app/cli/studio.cpp app/cli/target_options.cpp
  app/cli/train.cpp)
target_include_directories(understudy PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(understudy PRIVATE warnings CLI11::CLI11 understudy_app understudy_studio understudy_builtin
  understudy_character understudy_assimp nlohmann_json::nlohmann_json)

# The program and what it loads at run time.
add_custom_target(understudy_all DEPENDS understudy networks_plugin)
