// The icons, drawn as shapes: crisp at any scale, in any colour.
#pragma once

#include <imgui.h>

#include <string_view>

#include "ui/gui/ui.hpp"

namespace understudy::ui {

enum class Icon : int {
  // clang-format off
  Play, Pause, StepBack, StepForward, ToStart, ToEnd, Loop, Undo, Redo, Reset,
  Folder, File, Image, Video, Home, Clock, Copy, Trash,
  Warning, Check, Close, ChevronRight, ChevronDown, ChevronUp,
  Person, Skeleton, Mesh, Points, Brush, Camera, Chart, Select, Move, Layers, Menu, Lock,
  // clang-format on
  Count
};

/// Its name in lower case, words joined by "-": "step-back".
std::string_view icon_name(Icon icon);

/// Draws it in a square of `size` pixels whose top left corner is `at`.
void draw_icon(ImDrawList& list, Icon icon, const ImVec2& at, float size, ImU32 color);

/// An item as high as a line of text that shows the icon; for use beside text.
void icon_label(Ui& ui, Icon icon, const ImVec4& color);

}  // namespace understudy::ui
