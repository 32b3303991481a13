// Lit smooth surfaces.
#pragma once

#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

class MeshPass {
 public:
  MeshPass();
  /// The view has passed check().
  void draw(const MeshView& view);

 private:
  void upload(const MeshView& view);

  gl::Program program_;
  gl::Uniform<float> opacity_{program_, "u_opacity"};
  gl::Uniform<int> two_sided_{program_, "u_two_sided"};
  gl::VertexArray array_;
  gl::Buffer positions_, normals_, colors_, indices_;
};

/// Throws Error when faces name vertices that are not there, or normals or colours are of another number.
/// Every pass that draws the mesh relies on it: a driver may crash on such faces.
void check(const MeshView& view);

/// Throws Error unless an optional array is empty or has one row for each vertex.
void check_rows(const char* what, const Points& optional, Eigen::Index vertices);

}  // namespace understudy::render
