// The second body beside the found one, in what it performs.
#pragma once

#include "ui/viewport/bones_view.hpp"

namespace understudy::ui {

/// Adds its bones and its surface, as the layers have those of the found body; where that one is painted by
/// bone, in the colours of the bones that it performs. All is shifted by `aside`.
void add_second_body(const app::Session& session, int frame, const Vec3& aside, BonesMemory& memory,
                     render::Scene& scene);

}  // namespace understudy::ui
