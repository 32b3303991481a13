// The floor: a grid that fades out, and soft shadows of what stands above it.
#pragma once

#include "render/floor_shadow.hpp"
#include "render/gl/program.hpp"
#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"

namespace understudy::render {

const std::string kGroundVertex = std::string(kFrameGlsl) + R"(
uniform vec4 u_place;  // centre, radius
out vec3 v_position;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  v_position = u_place.xyz + u_place.w * vec3(corner.x, 0.0, corner.y);
  gl_Position = u_projection * (u_view * vec4(v_position, 1.0));
}
)";
const std::string kGridFragment = std::string(kFrameGlsl) + R"(
uniform vec4 u_place;
uniform vec3 u_line;
uniform float u_spacing;
in vec3 v_position;
out vec4 o_color;
float lines(vec2 at, float spacing) {
  vec2 p = at / spacing, width = fwidth(p);
  vec2 distance = abs(fract(p - 0.5) - 0.5) / max(width, 1e-6);  // pixels from the nearest line
  vec2 one = clamp(1.1 - distance, 0.0, 1.0) * clamp(1.0 - 2.2 * width, 0.0, 1.0);  // too dense: fade, not moire
  return max(one.x, one.y);
}
void main() {
  float away = length(v_position.xz - u_place.xz) / u_place.w;
  float fade = 1.0 - smoothstep(0.30, 1.0, away);
  float line = fade * max(0.55 * lines(v_position.xz, u_spacing), 0.85 * lines(v_position.xz, 2.0 * u_spacing));
  o_color = vec4(u_line * line, line);
}
)";

// A dark blue-grey, premultiplied.
const std::string kShadowFragment = R"(
uniform vec4 u_place;
uniform float u_strength;
uniform sampler2D u_shadow;
in vec3 v_position;
out vec4 o_color;
void main() {
  vec2 place = (v_position.xz - u_place.xz) / u_place.w * 0.5 + 0.5;
  o_color = vec4(0.13, 0.14, 0.17, 1.0) * (u_strength * texture(u_shadow, place).r);
}
)";

/// Both are drawn before all else.
class GroundPass {
 public:
  /// Changes with the camera and the view only. center: the middle of the visible part, its height ignored.
  void draw_grid(const GroundView& view, const Vec3& center) {
    const gl::ProgramScope program(grid_.id());
    grid_place_.set({center.x(), view.height, center.z(), view.radius});
    line_.set(view.line);
    spacing_.set(view.spacing);
    draw_square();
  }

  void draw_shadow(const Scene& scene) {
    const FloorShadow shadow = floor_shadow(scene);
    const gl::ProgramScope program(shadow_.id());
    gl::api().ActiveTexture(GL_TEXTURE0);
    gl::api().PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    constexpr int kSide = FloorShadow::kSide;
    gl::set_image(texture_, {kSide, kSide, GL_R8, GL_RED, GL_UNSIGNED_BYTE, GL_LINEAR, shadow.dark.data()});
    const float half = shadow.area.z() / 2;
    shadow_place_.set({shadow.area.x() + half, scene.ground.height, shadow.area.y() + half, half});
    strength_.set(scene.ground.shadow);
    sampler_.set(0);
    draw_square();
  }

 private:
  void draw_square() {
    const gl::VertexArrayScope array(none_.name());
    const gl::BlendScope blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const gl::CapabilityScope depth(GL_DEPTH_TEST, false);
    gl::api().DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }

  gl::Program grid_{"grid", kGroundVertex, kGridFragment}, shadow_{"shadow", kGroundVertex, kShadowFragment};
  gl::Uniform<Eigen::Vector4f> grid_place_{grid_, "u_place"}, shadow_place_{shadow_, "u_place"};
  gl::Uniform<Vec3> line_{grid_, "u_line"};
  gl::Uniform<float> spacing_{grid_, "u_spacing"}, strength_{shadow_, "u_strength"};
  gl::Uniform<int> sampler_{shadow_, "u_shadow"};
  gl::VertexArray none_;
  gl::Texture texture_;
};

}  // namespace understudy::render
