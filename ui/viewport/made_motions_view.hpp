// The found body in motions that were made, as pale ghosts over it or beside it.
#pragma once

#include "app/session/made_motions.hpp"
#include "ui/viewport/bones_view.hpp"

namespace understudy::ui {

/// Adds one of them, shifted by `aside` too.
void add_made_motion(const DiscoveredRig& found, const app::ShownMotion& shown, const Vec3& aside,
                     BonesMemory& memory, render::Scene& scene);

}  // namespace understudy::ui
