# Pictures: OpenGL 3.3 core, drawn offscreen. EGL and OSMesa are loaded at run time, so nothing of GL is linked; GLFW
# does the same by itself.
pkg_check_modules(GLFW REQUIRED IMPORTED_TARGET glfw3)
pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavformat libavcodec libswscale libavutil)
us_module(render SOURCES
  render/gl/functions.cpp render/gl/program.cpp render/gl/debug.cpp render/gl/store.cpp
  render/context/context.cpp render/context/egl.cpp render/context/osmesa.cpp render/context/null.cpp
  render/context/input_event.cpp render/context/glfw.cpp
  render/camera.cpp render/plot.cpp render/colors.cpp render/image.cpp render/scene.cpp
  render/floor_shadow.cpp render/solids.cpp render/gizmo.cpp render/picking.cpp
  render/passes/frame.cpp render/passes/background_pass.cpp render/passes/mesh_pass.cpp
  render/passes/points_pass.cpp render/passes/skeleton_pass.cpp render/passes/ground_pass.cpp
  render/passes/occlusion_pass.cpp render/passes/lines_pass.cpp render/passes/smooth_pass.cpp render/renderer.cpp render/text.cpp render/contact_sheet.cpp render/video_writer.cpp
  PUBLIC understudy_core PRIVATE PNG::PNG PkgConfig::GLFW PkgConfig::LIBAV ${CMAKE_DL_LIBS})
