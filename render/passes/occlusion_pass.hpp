// Ambient occlusion from depth alone: creases and contacts lose light.
#pragma once

#include "render/gl/program.hpp"
#include "render/passes/frame.hpp"

namespace understudy::render {

class OcclusionPass {
 public:
  OcclusionPass();
  /// Darkens the bound target, `size` pixels, by what `depth_texture` (single-sampled, of the same size)
  /// shows. strength 0..1. Uses the FrameBlock that is bound.
  void draw(unsigned depth_texture, PixelSize size, float strength);

 private:
  void resize(PixelSize size);
  void estimate(unsigned depth_texture);
  void blur(int from, int to, const Eigen::Vector2f& step);

  gl::Program estimate_, blur_, apply_;
  gl::Uniform<int> estimate_depth_{estimate_, "u_depth"}, blur_source_{blur_, "u_source"};
  gl::Uniform<Eigen::Vector2f> blur_step_{blur_, "u_step"};
  gl::Uniform<int> apply_source_{apply_, "u_source"};
  gl::Uniform<float> apply_strength_{apply_, "u_strength"};
  gl::VertexArray none_;
  PixelSize small_;
  gl::Texture textures_[2];
  gl::Framebuffer framebuffers_[2];
};

}  // namespace understudy::render
