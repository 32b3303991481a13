// What is drawn over the whole picture: the background, and a picture whose edges are softened.
#pragma once

#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

/// A soft vertical gradient behind everything.
class BackgroundPass {
 public:
  BackgroundPass();
  void draw(const BackgroundView& view);

 private:
  gl::Program program_;
  gl::Uniform<Vec3> top_{program_, "u_top"}, bottom_{program_, "u_bottom"};
  gl::VertexArray none_;  // core profiles draw nothing without one
};

/// Softens jagged edges of a picture with one sample a pixel.
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
