// The widget that keys are about: Tab goes from one to the next, Enter and Space use it, a ring shows it.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "render/context/input_event.hpp"

struct ImGuiWindow;

namespace understudy::ui {

class Ui;

/// One per Ui. Shortcuts and ImGui's own keys stay as they are while the ring is not shown.
class Focus {
 public:
  /// The item just made, ImGui's last, can be reached by Tab, in the order of drawing; greyed out it cannot.
  /// Between begin_frame() and finish_frame(), on ImGui's thread.
  /// typed: typing begins as soon as it is reached.
  void add(const std::string& name, bool typed);
  /// The name of the item in the ring; "" where there is none.
  std::string name() const;
  /// Where it is; nothing without a ring.
  const ImVec4* place() const;
  /// In the next frame typing begins in the text field of that id; what is typed until then waits.
  void type_into(ImGuiID id) { wanted_text_ = id; }
  /// A dialog is about to open: what is typed or clicked waits until it is there and the text field that it
  /// asks for, if any, is typed into.
  void await_dialog();
  /// Takes the ring away: keys are for something else.
  void leave() { shown_ = false; }

  /// Before a frame: a key that is for the focus is taken. True when nobody else gets it.
  bool take(const render::InputEvent& event);
  /// Whether the focus moves in this frame: what is typed meanwhile waits.
  bool moving() const { return step_ != 0 || settling_ || awaiting_ > 0; }
  /// Whether a menu or a list is open: then ImGui's keys go through it.
  static bool in_menu();
  /// Whether Alt was pressed and let go by itself: the menus are wanted.
  bool alt_tapped() const { return alt_tapped_; }
  /// After ImGui::NewFrame.
  void begin_frame();
  /// Before ImGui::Render: moves on, draws the ring.
  void finish_frame(const Ui& ui);

 private:
  struct Stop {
    ImGuiID id = 0;
    std::string name;
    ImGuiWindow* window = nullptr;
    ImVec4 rect, clip;  ///< left, top, right, bottom
    bool typed = false;
  };
  const Stop* current() const;
  bool take_key(const render::InputEvent& event);
  void follow_alt(const render::InputEvent& event);
  void go();
  void follow_dialog();
  void draw_ring(const Ui& ui) const;

  std::vector<Stop> drawing_, finished_;
  ImGuiID id_ = 0;
  bool shown_ = false;
  int step_ = 0;  ///< by Tab, not yet done
  ImGuiID wanted_text_ = 0;
  int awaiting_ = 0;  ///< frames for which a dialog is still waited for
  int awaited_ = 0;   ///< the frame in which that began
  bool settling_ = false, cleared_ = false, closing_ = false;
  bool alt_alone_ = false, alt_tapped_ = false;
  bool by_keys_ = false;  ///< the last input was keys
  int popups_ = 0;
};

}  // namespace understudy::ui
