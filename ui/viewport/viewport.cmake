# The views: scenes from the session, panes, tools of the mouse, pictures for files.
us_module(viewport SOURCES
  ui/viewport/panes.cpp ui/viewport/surface_values.cpp ui/viewport/target_look.cpp ui/viewport/scene_builder.cpp
  ui/viewport/same_picture.cpp ui/viewport/pane_pictures.cpp ui/viewport/pane.cpp ui/viewport/navigation.cpp
  ui/viewport/hand.cpp ui/viewport/overlay.cpp ui/viewport/views.cpp ui/viewport/picture.cpp
  PUBLIC understudy_panels understudy_session understudy_gui)
