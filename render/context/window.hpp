// A window with an OpenGL 3.3 core context, and what the user does to it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "render/context/context.hpp"
#include "render/context/input_event.hpp"

namespace understudy::render {

enum class CursorShape : int {
  Arrow,
  Text,
  Hand,
  Crosshair,
  ResizeHorizontal,
  ResizeVertical,
  ResizeAll,
  Hidden,
  Count
};

struct WindowOptions {
  std::string title = "Understudy";
  int width = 1280, height = 800;  ///< of the content, in the desktop's units
  gl::DebugMode debug = gl::DebugMode::Off;
  bool vsync = true;
  bool visible = true;
  bool full_screen = false;  ///< all of the main screen, whatever width and height say
  /// Mesa's software renderer in place of the graphics driver. Decided by the first window of a process.
  bool software = false;
};

/// One window. Make, use and destroy it on the main thread. Its context is current after making it.
class Window {
 public:
  using Handler = std::function<void(InputEvent)>;

  /// Throws Error with one sentence when there is no display, or when the driver has no OpenGL 3.3; that one
  /// offers the software renderer.
  explicit Window(const WindowOptions& options = {});
  ~Window();
  Window(Window&&) noexcept;
  Window& operator=(Window&&) noexcept;

  Context& context();
  /// Framebuffer size in pixels; 0 x 0 while minimised.
  std::pair<int, int> size() const;
  /// How large text and buttons should be: 1 usual, 2 on a screen of twice the density.
  float content_scale() const;
  /// Shows what was drawn into framebuffer 0.
  void swap();

  void set_title(const std::string& title);
  /// Size of the content in the desktop's units.
  void set_size(int width, int height);
  void set_cursor(CursorShape shape);
  std::string clipboard() const;  ///< empty when it holds no text
  void set_clipboard(const std::string& text);

  /// Gets the events, from poll() and wait() on this thread. Exceptions thrown by it come out of
  /// those two.
  void set_handler(Handler handler);
  /// Delivers what has happened since.
  void poll();
  /// The same, and sleeps until something happens, wake() is called or `seconds` have passed.
  void wait(double seconds);
  /// Ends a wait(); from any thread.
  static void wake();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace understudy::render
