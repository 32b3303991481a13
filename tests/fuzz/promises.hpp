// What no reader may let through; the fuzzer takes an abort for a find.
#pragma once

#include "retarget/geometry/mesh.hpp"

namespace understudy::fuzz {

void must(bool holds, const char* what);
void check_mesh(const Mesh& mesh);

}  // namespace understudy::fuzz
