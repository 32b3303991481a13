// The floor: a grid that fades out, and soft shadows of what stands above it. Both are drawn before all else.
#pragma once

#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

class GroundPass {
 public:
  GroundPass();
  /// Changes with the camera and the view only. center: the middle of the visible part, its height ignored.
  void draw_grid(const GroundView& view, const Vec3& center);
  void draw_shadow(const Scene& scene);

 private:
  gl::Program grid_, shadow_;
  gl::Uniform<Eigen::Vector4f> grid_place_{grid_, "u_place"}, shadow_place_{shadow_, "u_place"};
  gl::Uniform<Vec3> line_{grid_, "u_line"};
  gl::Uniform<float> spacing_{grid_, "u_spacing"}, strength_{shadow_, "u_strength"};
  gl::Uniform<int> sampler_{shadow_, "u_shadow"};
  gl::VertexArray none_;
  gl::Texture texture_;
};

}  // namespace understudy::render
