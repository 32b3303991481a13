// The start screen in place of the views: samples, recent documents, what can be dropped.
// Marks: start.sample.K, start.recent.K (documents), start.recent_source.K, start.recent_target.K,
// start.open_source, start.open_target, start.open_document.
#pragma once

#include <string>
#include <vector>

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// A sample to try.
struct SampleCard {
  std::string title, caption;  ///< "A walk", "3D scans of a person, 60 frames"
  app::Arguments paths;        ///< of the command open
  ImTextureID picture = nullptr;
  std::vector<std::string> then{};  ///< commands after that, as lines of a script
  std::string up{};                 ///< which way is up in its scan; empty: as it is guessed
};

/// Fills the current window.
void draw_start(const app::Session& session, PanelContext& context, const std::vector<SampleCard>& samples);

}  // namespace understudy::ui
