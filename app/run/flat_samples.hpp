// The bundled sample of 2D poses: a dancer, somebody who walks by, and a reference to dance in its place.
#pragma once

#include <string>

namespace understudy::app {

/// Writes into `folder`, which is there: poses/ (an OpenPose folder, 30 frames/s, 1024 x 768: a woman dances
/// for 3 s, a man walks by behind her; as a good detector sees them), reference.json (ControlNet's: a girl of
/// six in one picture, 1024 x 768) and reference.png, the picture. Throws Error naming what cannot be
/// written.
void write_flat_samples(const std::string& folder);

}  // namespace understudy::app
