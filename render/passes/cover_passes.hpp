// What covers the whole picture: the background, and smoothing afterwards.
#pragma once

#include "render/gl/program.hpp"
#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"

namespace understudy::render {

constexpr const char* kGradient = R"(
uniform vec3 u_top, u_bottom;
in vec2 v_place;
out vec4 o_color;
void main() { o_color = vec4(mix(u_bottom, u_top, smoothstep(0.0, 1.0, v_place.y)), 1.0); }
)";

// Lottes, "FXAA", 2009, in its short form: mixes pixels along the direction in which brightness changes
// least.
const std::string kSoften = R"(
uniform sampler2D u_source;
in vec2 v_place;
out vec4 o_color;
float brightness(vec4 c) { return dot(c.rgb, vec3(0.30, 0.59, 0.11)); }
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), last = textureSize(u_source, 0) - 1;
  vec4 middle = texelFetch(u_source, p, 0);
  float m = brightness(middle);
  float nw = brightness(texelFetch(u_source, clamp(p + ivec2(-1, 1), ivec2(0), last), 0));
  float ne = brightness(texelFetch(u_source, clamp(p + ivec2(1, 1), ivec2(0), last), 0));
  float sw = brightness(texelFetch(u_source, clamp(p + ivec2(-1, -1), ivec2(0), last), 0));
  float se = brightness(texelFetch(u_source, clamp(p + ivec2(1, -1), ivec2(0), last), 0));
  vec2 along = vec2(sw + se - nw - ne, ne + se - nw - sw);
  float least = min(m, min(min(nw, ne), min(sw, se))), most = max(m, max(max(nw, ne), max(sw, se)));
  float damping = max((nw + ne + sw + se) * 0.03125, 0.0078125);
  along = clamp(along / (min(abs(along.x), abs(along.y)) + damping), -6.0, 6.0) / vec2(last + 1);
  vec4 near = 0.5 * (texture(u_source, v_place - along / 6.0) + texture(u_source, v_place + along / 6.0));
  vec4 far = 0.5 * near + 0.25 * (texture(u_source, v_place - 0.5 * along) + texture(u_source, v_place + 0.5 * along));
  float b = brightness(far);
  o_color = most - least < 0.04 ? middle : b < least || b > most ? near : far;
}
)";

/// A soft vertical gradient behind everything.
class BackgroundPass {
 public:
  void draw(const BackgroundView& view) {
    if (view.transparent) {
      gl::api().ClearColor(0, 0, 0, 0);
      return gl::api().Clear(GL_COLOR_BUFFER_BIT);
    }
    const gl::CapabilityScope depth(GL_DEPTH_TEST, false);
    const gl::ProgramScope program(program_.id());
    const gl::VertexArrayScope array(none_.name());
    top_.set(view.top);
    bottom_.set(view.bottom);
    gl::api().DrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  gl::Program program_{"background", kCoverGlsl, kGradient};
  gl::Uniform<Vec3> top_{program_, "u_top"}, bottom_{program_, "u_bottom"};
  gl::VertexArray none_;  // core profiles draw nothing without one
};

/// Softens jagged edges of a picture with one sample a pixel.
class SmoothPass {
 public:
  /// Draws `texture` (filtered linearly), its edges smoothed, over the bound target, which is not the
  /// texture.
  void draw(unsigned texture) {
    const gl::CapabilityScope depth(GL_DEPTH_TEST, false);
    const gl::ProgramScope program(program_.id());
    const gl::VertexArrayScope array(none_.name());
    gl::api().ActiveTexture(GL_TEXTURE0);
    gl::api().BindTexture(GL_TEXTURE_2D, texture);
    source_.set(0);
    gl::api().DrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  gl::Program program_{"smoothing", kCoverGlsl, kSoften};
  gl::Uniform<int> source_{program_, "u_source"};
  gl::VertexArray none_;
};

}  // namespace understudy::render
