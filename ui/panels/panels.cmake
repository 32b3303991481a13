# The panels: they read the session and ask for commands.
us_module(panels SOURCES
  ui/arrangement.cpp ui/workspace.cpp ui/panels/bindings.cpp ui/panels/dialogs.cpp ui/panels/edit.cpp ui/panels/export.cpp
  ui/panels/files.cpp ui/panels/inspector.cpp ui/panels/keys.cpp ui/panels/layers.cpp ui/panels/log.cpp
  ui/panels/menus.cpp ui/panels/metrics.cpp ui/panels/panel.cpp ui/panels/rig.cpp ui/panels/rows.cpp ui/panels/settings.cpp
  ui/panels/start.cpp ui/panels/status.cpp ui/panels/timeline.cpp ui/panels/top_bar.cpp
  PUBLIC understudy_gui understudy_session)
