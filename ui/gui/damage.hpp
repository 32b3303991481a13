// Where a frame of the interface differs from the one before: software OpenGL pays for every triangle, and
// often only a playhead and a number change.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// Adds a rectangle to a short list, merged with another where that wastes little.
void add_rect(std::vector<Rect>& rects, const Rect& rect);

/// Keeps a copy of a frame's triangles and compares the next one with it.
class Damage {
 public:
  /// Rectangles, in whole pixels, outside of which this frame looks as the last one given. Pictures that are
  /// not the atlas count as changed. The first time, and after forget(): the whole display.
  std::vector<Rect> update(const ImDrawData& data);
  void forget() { before_.clear(); }

 private:
  struct Triangle {
    ImDrawVert corners[3];
  };
  struct Command {
    Rect clip;
    ImTextureID texture = nullptr;
    std::vector<Triangle> triangles;
  };
  struct List {
    std::string owner;
    std::vector<Command> commands;
  };
  static List copy(const ImDrawList& list);
  static Rect bounds(const Triangle& triangle);
  static void add_all(std::vector<Rect>& rects, const List& list);
  static void add_all(std::vector<Rect>& rects, const Command& command);
  static void compare(std::vector<Rect>& rects, const Command& before, const Command& now);
  static void compare(std::vector<Rect>& rects, const List& before, const List& now);

  std::vector<List> before_;
  ImVec2 size_{0, 0};
};

}  // namespace understudy::ui
