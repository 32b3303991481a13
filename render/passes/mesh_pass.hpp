// Lit smooth surfaces.
#pragma once

#include "render/gl/array_cache.hpp"
#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

class MeshPass {
 public:
  /// `arrays` outlives the pass.
  explicit MeshPass(gl::ArrayCache& arrays);
  /// The view has passed check(). occlusion: how much its ambient values count, 0..1.
  void draw(const MeshView& view, float occlusion);

 private:
  void bind(const MeshView& view);

  gl::ArrayCache& arrays_;
  gl::Program program_;
  gl::Uniform<float> opacity_{program_, "u_opacity"}, occlusion_{program_, "u_occlusion"};
  gl::Uniform<int> two_sided_{program_, "u_two_sided"};
  gl::VertexArray array_;
};

/// Throws Error when faces name vertices that are not there, or normals, colours or ambient values are of
/// another number. Every pass that draws the mesh relies on it: a driver may crash on such faces.
void check(const MeshView& view);

/// Throws Error unless an optional array is empty or has one row for each vertex.
void check_rows(const char* what, Eigen::Index rows, Eigen::Index vertices);

}  // namespace understudy::render
