#include "tests/fuzz/promises.hpp"

#include <cstdio>
#include <cstdlib>

namespace understudy::fuzz {

void must(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

void check_mesh(const Mesh& mesh) {
  must(mesh.faces.size() == 0 || (mesh.faces.minCoeff() >= 0 && mesh.faces.maxCoeff() < mesh.vertices.rows()),
       "faces name vertices");
  must(mesh.colors.rows() == 0 || mesh.colors.rows() == mesh.vertices.rows(), "colours fit");
}

}  // namespace understudy::fuzz
