#include "ui/panels/panels.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"

namespace understudy::ui {

// Each in the file of its name.
using DrawPanel = void(const app::Session&, PanelContext&);
DrawPanel draw_inspector, draw_layers, draw_edit, draw_metrics, draw_study, draw_timeline, draw_log,
    draw_bad_frames, draw_motion_map, draw_bones;

const std::vector<Panel>& panels() {
  using Dock = Panel::Dock;
  static const std::vector<Panel> kPanels = {
      {"inspector", "Inspector", "Alt+1", Dock::Side, false,
       "What is open: the source, the takes, and how the current take is made.", draw_inspector},
      {"layers", "Layers", "Alt+2", Dock::Side, false,
       "What the views draw and what colours it. Nothing here changes the result.", draw_layers},
      {"edit", "Edit", "Alt+3", Dock::Side, false,
       "Corrects the scan, the skeleton found in it, the result and the target. All of it can be undone.",
       draw_edit},
      {"metrics", "Metrics", "Alt+4", Dock::Side, false,
       "How good the current take is, over time and as a whole, and how long each stage took.", draw_metrics},
      {"study", "Study", "Alt+5", Dock::Side, false,
       "A perceptual study: which methods are compared on which motions and targets, what people are asked, "
       "and in which order they see the clips.",
       draw_study},
      {"motion_map", "Map", "Alt+6", Dock::Side, false,
       "The steps of many motions, or their other movements, by their likeness: what is alike lies near to "
       "each "
       "other. The targets perform what the pointer rests on. A click takes it as the source, a click "
       "between "
       "figures what lies between them.",
       draw_motion_map},
      {"bones", "Bones", "Alt+7", Dock::Side, false,
       "A skeleton of its own for whatever moves in the scans: an animal, a machine, a person with skirt and "
       "tail. A click on a bone, here or in the view, chooses it.",
       draw_bones},
      {"timeline", "Timeline", "Alt+T", Dock::Timeline, true,
       "The frames and the edits made at them. Thin bars show when the left and the right foot are held on "
       "the floor. Red frames cannot be trusted: rest the pointer on one to read why.",
       draw_timeline},
      {"log", "Log", "Alt+L", Dock::Below, false, "All messages since the start, the newest last.", draw_log},
      {"bad_frames", "Bad frames", "Alt+B", Dock::Below, false,
       "The frames that cannot be trusted, and why. A click goes there.", draw_bad_frames},
  };
  return kPanels;
}

const Panel& panel_of(const std::string& name) {
  for (const Panel& panel : panels())
    if (name == panel.name) return panel;
  throw Error("there is no panel " + name);
}

const Panel& shown_tab(const app::Session& session) {
  const Panel* first = nullptr;
  for (const Panel& panel : panels()) {
    if (panel.dock != Panel::Dock::Side) continue;
    if (first == nullptr) first = &panel;
    const auto flag = session.settings.panels.find(panel.name);
    if (flag != session.settings.panels.end() && flag->second) return panel;
  }
  return *first;
}

}  // namespace understudy::ui
