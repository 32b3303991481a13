// The fonts of the interface.
#pragma once

#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// Fills an empty atlas with Inter (else DejaVu Sans, else ImGui's own, with a warning in the log) and makes
/// its pixels. `scale` 1 to 3. Digits are all equally wide, so that numbers that change stay in place.
Fonts load_fonts(ImFontAtlas& atlas, float scale);

}  // namespace understudy::ui
