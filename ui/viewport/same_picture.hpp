// Whether a picture must be drawn again.
#pragma once

#include "render/camera.hpp"
#include "render/scene.hpp"

namespace understudy::ui {

/// Whether both scenes give the same picture: shared arrays are compared by identity, the rest by value.
bool same_picture(const render::Scene& a, const render::Scene& b);
bool same_picture(const render::Camera& a, const render::Camera& b);

}  // namespace understudy::ui
