# The views: scenes from the session, panes, tools of the mouse.
us_module(viewport SOURCES
  ui/viewport/panes.cpp ui/viewport/surface_values.cpp ui/viewport/target_look.cpp ui/viewport/scene_builder.cpp
  ui/viewport/navigation.cpp ui/viewport/overlay.cpp
  ui/panels/panel.cpp
  PUBLIC understudy_session understudy_gui)
