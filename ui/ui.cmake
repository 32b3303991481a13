# The interface. ImGui's own backends stay out: input and drawing go through the renderer's (see ui/gui).
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
pkg_check_modules(FREETYPE REQUIRED IMPORTED_TARGET freetype2)

us_module(gui SOURCES
  ui/theme.cpp ui/gui/ui.cpp ui/gui/fonts.cpp ui/gui/gui.cpp ui/gui/damage.cpp ui/gui/draw_pass.cpp
  ui/widgets/icons.cpp ui/widgets/controls.cpp ui/widgets/dialogs.cpp ui/widgets/lists.cpp
  ui/widgets/axis.cpp ui/widgets/plot.cpp ui/widgets/timeline_track.cpp
  ui/folder_listing.cpp ui/file_browser.cpp
  PUBLIC understudy_render PkgConfig::IMGUI PRIVATE understudy_formats PkgConfig::FREETYPE Threads::Threads)

include(ui/panels/panels.cmake OPTIONAL)
