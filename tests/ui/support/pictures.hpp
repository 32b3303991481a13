// What a finished frame looks like, and which of its words are cut off.
#pragma once

#include <imgui.h>

#include <functional>
#include <vector>

#include "render/image.hpp"
#include "render/renderer.hpp"
#include "ui/gui/draw_pass.hpp"
#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// Where letters are drawn only in part, or reach out of the display: their rectangles.
std::vector<Rect> cut_letters(const ImDrawData& data, const ImFontAtlas& atlas);

/// A black picture after `draw` has drawn into it with the current context.
render::Image picture(render::PixelSize size, const std::function<void(const render::RenderTarget&)>& draw);
/// The frame on a black picture.
render::Image picture(DrawPass& pass, const ImDrawData& data, const ImFontAtlas& atlas,
                      render::PixelSize size);

}  // namespace understudy::ui
