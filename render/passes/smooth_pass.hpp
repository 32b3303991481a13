// Softens jagged edges of a picture with one sample a pixel.
#pragma once

#include "render/gl/program.hpp"

namespace understudy::render {

class SmoothPass {
 public:
  SmoothPass();
  /// Draws `texture` (filtered linearly), its edges smoothed, over the bound target, which is not the
  /// texture.
  void draw(unsigned texture);

 private:
  gl::Program program_;
  gl::Uniform<int> source_{program_, "u_source"};
  gl::VertexArray none_;
};

}  // namespace understudy::render
