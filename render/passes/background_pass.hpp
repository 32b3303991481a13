// A soft vertical gradient behind everything.
#pragma once

#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

class BackgroundPass {
 public:
  BackgroundPass();
  void draw(const BackgroundView& view);

 private:
  gl::Program program_;
  gl::Uniform<Vec3> top_{program_, "u_top"}, bottom_{program_, "u_bottom"};
  gl::VertexArray none_;  // core profiles draw nothing without one
};

}  // namespace understudy::render
