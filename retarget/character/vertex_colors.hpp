// What a character's materials, textures and vertex colours look like at its vertices.
#pragma once

#include "retarget/character/character.hpp"

namespace understudy {

/// Light as glTF's colours count it from the colours that pictures and scans hold, and back; 0..1.
float to_linear(float shown);
float to_shown(float linear);

/// Colours of the vertices of all parts, one part after the other, [V, 3] in 0..1 as screens show them: the
/// material's base colour times its texture, looked up at the vertex, times the vertex colour. Empty where
/// no vertex differs from another. A picture that cannot be decoded, or has more than 64 megapixels,
/// is left out with a warning.
Points vertex_colors(const Character& character);

/// The same on the merged surface: the mean where several corners are one vertex. Colours that it had go.
void paint(MergedSurface& surface, const Character& character);

}  // namespace understudy
