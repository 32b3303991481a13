// The text over a pane's picture: its name, the legend, names of joints, warnings.
#pragma once

#include <string>
#include <vector>

#include "ui/viewport/panes.hpp"
#include "ui/viewport/surface_values.hpp"

namespace understudy::ui {

struct Overlay {
  Rect rect;  ///< of the pane; all is kept inside
  std::string title, subtitle;
  bool title_right = false;  ///< at the top right: the right half of a wipe
  float right_taken = 0;     ///< pixels at the top right where something else is
  std::string hint;          ///< in the middle of an empty pane
  std::string warning;       ///< why the frame is flagged; empty: it is good
  Legend legend;
  struct Label {
    ImVec2 at;
    std::string text;
    bool strong = false;  ///< hovered or chosen: with a ring around the place
  };
  std::vector<Label> labels;  ///< of joints
  struct Handle {
    ImVec2 at;
    std::string name;  ///< its mark
    bool hovered = false;
  };
  std::vector<Handle> handles;  ///< of the crop box
  struct Tag {
    ImVec2 at;  ///< above the head
    std::string text;
    ImVec4 color;
    bool strong = false;  ///< who performs
    std::string name;     ///< its mark
  };
  std::vector<Tag> tags;  ///< of several people
  std::string tip;        ///< beside the pointer
  ImVec2 tip_at{0, 0};
  bool active = false;  ///< the pane that keys and panels are about, among several
};

/// Draws into the current window.
void draw_overlay(Ui& ui, const Overlay& overlay);

/// The size of a legend's categories in a column.
ImVec2 legend_size(Ui& ui, const Legend& legend);
/// Its categories in a column, beside the views. Marked "view.legend".
void draw_legend(Ui& ui, const Legend& legend, const Rect& rect);

/// The labels of a pane's joints: all where the layer shows them, hovered and selected ones always.
std::vector<Overlay::Label> joint_labels(const PaneView& view, const Joints& joints, bool all, int hovered,
                                         int selected);

}  // namespace understudy::ui
