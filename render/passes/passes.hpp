// The passes that draw a picture: each has its shaders and its code in passes/NAME.cpp.
#pragma once

#include "render/gl/array_cache.hpp"
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

/// The floor: a grid that fades out, and soft shadows of what stands above it. Both are drawn before all else.
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

/// Lit smooth surfaces.
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

/// Ambient occlusion from depth alone: creases and contacts lose light.
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

/// Points as lit round discs, tilted along their normals, or small balls where there are none.
class PointsPass {
 public:
  /// `arrays` outlives the pass.
  explicit PointsPass(gl::ArrayCache& arrays);
  /// Throws Error when normals or colours are of another number than the points. multisampled: of the target
  /// that is bound.
  void draw(const PointsView& view, bool multisampled);

 private:
  struct Kind {
    Kind(const char* name, const std::string& vertex, const std::string& fragment);
    gl::Program program;
    gl::Uniform<float> radius{program, "u_radius"}, smooth{program, "u_smooth"};
  };

  gl::ArrayCache& arrays_;
  Kind discs_, balls_;
  gl::VertexArray disc_array_, ball_array_;
};

/// Lines with a width in pixels and soft edges.
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
