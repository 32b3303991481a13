# The studio without its window. Its parts that know no thread first.
us_module(session SOURCES
  app/session/commands.cpp app/session/playback.cpp app/session/view.cpp app/session/session.cpp app/session/engine.cpp app/session/frame_figures.cpp app/session/refiner.cpp
  app/session/document.cpp app/session/frame_cache.cpp app/session/job_queue.cpp
  PUBLIC understudy_run understudy_editing nlohmann_json::nlohmann_json
  PRIVATE Threads::Threads)
