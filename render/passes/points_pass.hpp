// Points as lit round discs with true depth: flat ones along their normals, or small balls where there are
// none.
#pragma once

#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

class PointsPass {
 public:
  PointsPass();
  /// Throws Error when normals or colours are of another number than the points.
  void draw(const PointsView& view);

 private:
  gl::Program program_;
  gl::Uniform<float> radius_{program_, "u_radius"};
  gl::Uniform<int> has_normals_{program_, "u_has_normals"};
  gl::VertexArray array_;
  gl::Buffer positions_, normals_, colors_;
};

}  // namespace understudy::render
