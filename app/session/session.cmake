# The studio without its window. Its parts that know no thread first.
us_module(session SOURCES
  app/session/commands.cpp app/session/playback.cpp app/session/view.cpp app/session/follow.cpp app/session/session.cpp app/session/engine.cpp app/session/frame_figures.cpp app/session/refiner.cpp
  app/session/document.cpp app/session/frame_cache.cpp app/session/job_queue.cpp
  app/session/document_file.cpp app/session/document_json.cpp app/session/autosave.cpp app/session/history.cpp
  app/session/settings.cpp app/session/series.cpp app/session/whole_file.cpp
  app/session/studio.cpp app/session/studio_results.cpp app/session/command_sets.cpp
  app/session/document_commands.cpp app/session/source_commands.cpp app/session/take_commands.cpp
  app/session/playback_commands.cpp app/session/view_commands.cpp app/session/edit_commands.cpp
  app/session/export_commands.cpp app/session/program_commands.cpp app/session/take_export.cpp
  PUBLIC understudy_run understudy_editing nlohmann_json::nlohmann_json
  PRIVATE understudy_npz Threads::Threads)
