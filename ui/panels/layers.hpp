// The layers of the views that can be shown and hidden, for the panel Layers and the views' own menu.
#pragma once

#include <string>
#include <vector>

#include "ui/panels/panel.hpp"

namespace understudy::ui {

struct LayerSwitch {
  std::string name;  ///< of the command view.layer
  std::string label, explanation;
  bool on = false;
};

/// Those of the source, or of the takes; a scan without faces has fewer.
std::vector<LayerSwitch> layer_switches(const app::Session& session, bool source);

}  // namespace understudy::ui
