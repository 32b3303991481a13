// The floor: a grid that fades out, and soft shadows of what stands above it.
#pragma once

#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

/// How much of the sky each place of the floor has lost, as a small picture seen from above: everything
/// flattened onto the floor, darker the lower it is, then blurred.
class ShadowPass {
 public:
  ShadowPass();
  /// Makes the picture for this scene; returns where it lies on the floor: x, z of its corner, its side in
  /// metres.
  Vec3 draw(const Scene& scene);
  unsigned texture() const { return textures_[0].name(); }

 private:
  void draw_flattened(const Scene& scene, const Vec3& area);
  void blur(int from, int to, const Eigen::Vector2f& step);

  gl::Program flatten_, blur_;
  gl::Uniform<Vec3> area_{flatten_, "u_area"};
  gl::Uniform<float> height_{flatten_, "u_height"}, point_pixels_{flatten_, "u_point_pixels"};
  gl::Uniform<Eigen::Vector2f> step_{blur_, "u_step"};
  gl::Uniform<int> source_{blur_, "u_source"};
  gl::VertexArray array_, none_;
  gl::Buffer positions_, indices_;
  gl::Texture textures_[2];
  gl::Framebuffer framebuffers_[2];
};

class GroundPass {
 public:
  GroundPass();
  /// Blends the floor over what is there; drawn after everything opaque.
  void draw(const Scene& scene);

 private:
  ShadowPass shadow_pass_;
  gl::Program program_;
  gl::Uniform<Eigen::Vector4f> place_{program_, "u_place"};
  gl::Uniform<Vec3> line_{program_, "u_line"}, area_{program_, "u_area"};
  gl::Uniform<float> spacing_{program_, "u_spacing"}, strength_{program_, "u_strength"};
  gl::Uniform<int> shadow_{program_, "u_shadow"};
  gl::VertexArray none_;
};

}  // namespace understudy::render
