# The studio with its face: a window, or a picture in memory that scripts drive.
us_module(studio SOURCES
  app/studio/application.cpp app/studio/event_text.cpp app/studio/facts.cpp app/studio/key_chord.cpp
  app/studio/picture_commands.cpp app/studio/previews.cpp app/studio/recorder.cpp
  app/studio/script.cpp app/studio/surface.cpp app/studio/window_commands.cpp
  PUBLIC understudy_session understudy_panels understudy_viewport)
