// One interface: ImGui's context, fonts and theme; input events go in, triangles come out.
#pragma once

#include <imgui.h>

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "render/context/input_event.hpp"
#include "render/context/window.hpp"
#include "render/renderer.hpp"
#include "ui/gui/ui.hpp"

namespace understudy::ui {

struct FrameInput {
  render::PixelSize size;  ///< of the framebuffer
  /// Of text and controls, 1 to 3, less where the display is too small for it; a change makes new letters.
  float scale = 1;
  float dt = 1.f / 60;  ///< seconds since the last frame
  ThemeKind theme = ThemeKind::Dark;
};

/// The clipboard. By default copied text stays inside the Gui.
struct Clipboard {
  std::function<std::string()> get;
  std::function<void(const std::string&)> set;
};

/// Draws nothing itself and needs no GL. Several may exist; begin_frame makes its own the current one until
/// another's. One thread at a time.
class Gui {
 public:
  explicit Gui(Clipboard clipboard = {});
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Starts a frame with the input since the last one. Spreads events that would hide each other (a press and
  /// its release) over several frames: see pending().
  void begin_frame(const FrameInput& input, const std::vector<render::InputEvent>& events = {});
  /// Ends it. The triangles are valid until the next begin_frame.
  const ImDrawData& end_frame();
  /// Ends a frame that something interrupted, wherever it stood; nothing is drawn.
  void abandon_frame();

  /// Whether events wait for the next frame: draw it soon.
  bool pending() const { return !queue_.empty(); }
  Ui& ui() { return ui_; }
  const Ui& ui() const { return ui_; }
  const Mark* find(const std::string& name) const { return ui_.find(name); }
  const std::vector<Mark>& marks() const { return ui_.marks(); }
  const ImFontAtlas& atlas() const { return *io().Fonts; }

  /// Whether the user is typing: then keys are no shortcuts.
  bool wants_text() const { return io().WantTextInput; }
  /// Where the last frame had the pointer, "640 400", and "down" behind it where its left button was.
  std::string pointer() const;
  /// The shape that the mouse pointer should have.
  render::CursorShape cursor() const;

 private:
  struct Changes;  // what this frame's events have done so far
  const ImGuiIO& io() const;
  ImGuiIO& io();
  void set_up_keys();
  void set_look(const FrameInput& input);
  bool fits(const render::InputEvent& event, const Changes& changes) const;
  void apply(const render::InputEvent& event, Changes& changes);
  void release_all();

  ImGuiContext* context_;
  Clipboard clipboard_;
  std::string copied_, pasted_;
  std::deque<render::InputEvent> queue_;
  Ui ui_;
};

/// Whether a key went down in this frame (or repeats, held). Whichever widget it is for.
bool key_pressed(render::Key key, bool repeat = true);

}  // namespace understudy::ui
