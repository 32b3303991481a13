// Lines with a width in pixels and soft edges.
#pragma once

#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

class LinesPass {
 public:
  LinesPass();
  /// Blends over what is there, hidden by what is before it (depth test as the caller set it). Throws Error
  /// when colours or opacities are of another number than the points.
  void draw(const LinesView& view);

 private:
  gl::Program program_;
  gl::Uniform<float> width_{program_, "u_width"}, beyond_{program_, "u_beyond"};
  gl::VertexArray array_;
  gl::Buffer here_, other_, corner_, color_, opacity_;
};

}  // namespace understudy::render
