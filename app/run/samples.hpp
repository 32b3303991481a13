// The bundled samples, made by the program itself.
#pragma once

#include <string>

namespace understudy::app {

/// Writes into `folder` (made when absent): scan/ (a dance captured at 30 frames/s, binary PLY), walk/ (a
/// shorter walk of another person), animal/ (one on four legs walks), target_adult.glb and target_child.glb
/// (T-poses), poses/, reference.json and reference.png (2D poses), README.md with checksums. The same bytes
/// each time on one machine. Throws Error naming what cannot be written.
void write_samples(const std::string& folder);

}  // namespace understudy::app
