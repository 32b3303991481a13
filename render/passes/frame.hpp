// What every pass of one picture shares: the camera and the light, in one uniform block.
#pragma once

#include <string>

#include "render/camera.hpp"
#include "render/gl/object.hpp"
#include "render/gl/scopes.hpp"
#include "render/scene.hpp"

namespace understudy::render {

/// GLSL of the block `Frame`, for both stages.
extern const char* const kFrameGlsl;
/// GLSL of vec3 shade(vec3 srgb_color, vec3 world_normal, vec3 world_position, float ambient): lit, sRGB
/// again; ambient is the share of the light from all around that gets there. Wants kFrameGlsl.
extern const char* const kShadeGlsl;
/// Vertex stage of a triangle that covers the picture; gives vec2 v_place, 0..1 with y up.
extern const char* const kCoverGlsl;

/// Throws Error unless an optional array, `what`, is empty or has one row for each point.
void check_rows(const char* what, Eigen::Index rows, Eigen::Index points);

/// Calls draw() for what is opaque. Of what is not only the front layer is seen, after its depth was drawn
/// alone: inner surfaces do not shine through one another, discs that overlap do not add up.
template <class Draw>
void draw_front_layer(float opacity, const Draw& draw) {
  if (opacity >= 1) return draw();
  {
    const gl::ColorMaskScope colors(false);
    draw();
  }
  const gl::BlendScope blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  const gl::DepthFuncScope depth(GL_LEQUAL);
  draw();
}

/// The block's buffer.
class FrameBlock {
 public:
  /// Fills it and binds it to binding 0, where every Program looks.
  void set(const Camera& camera, const LightView& light, PixelSize size);
  PixelSize size() const { return size_; }

 private:
  PixelSize size_;
  gl::Buffer buffer_;
};

}  // namespace understudy::render
