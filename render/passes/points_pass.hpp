// Points as lit round discs, tilted along their normals, or small balls where there are none.
#pragma once

#include "render/gl/array_cache.hpp"
#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"

namespace understudy::render {

// A disc is lit once, as a whole; its tilt makes it an ellipse on the screen. All of it has its centre's
// depth: writing a depth of its own would cost twice as much as all the rest.
const std::string kDiscVertex = std::string(kFrameGlsl) + kShadeGlsl + R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_color;
uniform float u_radius;
flat out vec3 v_color;
flat out vec3 v_tilt;  // slope of the disc across the screen; its size in pixels
void main() {
  gl_Position = u_projection * (u_view * vec4(a_position, 1.0));
  vec3 n = mat3(u_view) * a_normal, seen = mat3(u_view) * towards_eye(a_position);
  float side = dot(n, seen) < 0.0 ? -1.0 : 1.0;  // either side of the surface will do: show the one we see
  bool known = dot(n, n) > 0.5;
  n = known ? side * n : seen;
  v_tilt.xy = n.xy / max(n.z, 0.35);  // edge-on discs keep some width
  v_tilt.z = max(2.0, u_radius * u_projection[1][1] * u_size.y / gl_Position.w);
  v_color = shade(a_color, known ? side * a_normal : towards_eye(a_position), a_position, 1.0);
  gl_PointSize = v_tilt.z;
}
)";
const std::string kDiscFragment = R"(
uniform float u_smooth;  // 1: the rim's alpha becomes coverage
uniform float u_opacity;
flat in vec3 v_color;
flat in vec3 v_tilt;
out vec4 o_color;
void main() {
  vec2 d = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0);
  float height = dot(v_tilt.xy, d), r2 = dot(d, d) + height * height;
  if (r2 > 1.0) discard;
  o_color = vec4(v_color, u_smooth > 0.5 ? clamp((1.0 - r2) * 0.25 * v_tilt.z + 0.5, 0.0, 1.0) : 1.0);
  if (u_opacity < 1.0) o_color *= u_opacity;
}
)";

// Without normals each point is a small ball.
const std::string kBallVertex = std::string(kFrameGlsl) + R"(
layout(location = 0) in vec3 a_position;
layout(location = 2) in vec3 a_color;
uniform float u_radius;
flat out vec3 v_color, v_position;
flat out float v_pixels;
void main() {
  gl_Position = u_projection * (u_view * vec4(a_position, 1.0));
  v_color = a_color;
  v_position = a_position;
  v_pixels = max(2.0, u_radius * u_projection[1][1] * u_size.y / gl_Position.w);
  gl_PointSize = v_pixels;
}
)";
const std::string kBallFragment = std::string(kFrameGlsl) + kShadeGlsl + R"(
uniform float u_smooth, u_opacity;
flat in vec3 v_color, v_position;
flat in float v_pixels;
out vec4 o_color;
void main() {
  vec2 d = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0);
  float r2 = dot(d, d);
  if (r2 > 1.0) discard;
  vec3 n = vec3(d, sqrt(1.0 - r2)) * mat3(u_view);  // transposed: to the world
  o_color = vec4(shade(v_color, n, v_position, 1.0),
                 u_smooth > 0.5 ? clamp((1.0 - r2) * 0.25 * v_pixels + 0.5, 0.0, 1.0) : 1.0);
  if (u_opacity < 1.0) o_color *= u_opacity;
}
)";

class PointsPass {
 public:
  /// `arrays` outlives the pass.
  explicit PointsPass(gl::ArrayCache& arrays) : arrays_(arrays) {}

  /// Throws Error when normals or colours are of another number than the points. multisampled: of the target
  /// that is bound.
  void draw(const PointsView& view, bool multisampled) {
    const Eigen::Index count = view.positions->rows();
    check_rows("normals", view.normals->rows(), count);
    check_rows("colours", view.colors->rows(), count);
    if (count == 0) return;
    const bool flat = view.normals->rows() > 0;
    const Kind& kind = flat ? discs_ : balls_;
    const gl::ProgramScope program(kind.program.id());
    const gl::VertexArrayScope array(kind.array.name());
    const bool covers = multisampled && view.opacity >= 1;
    const gl::CapabilityScope size(GL_PROGRAM_POINT_SIZE, true),
        coverage(GL_SAMPLE_ALPHA_TO_COVERAGE, covers), whole(GL_SAMPLE_ALPHA_TO_ONE, covers);
    gl::use_attribute(0, arrays_.of(view.positions), 3);
    if (flat) gl::use_attribute(1, arrays_.of(view.normals), 3);
    if (view.colors->rows() > 0)
      gl::use_attribute(2, arrays_.of(view.colors), 3);
    else
      gl::use_constant_attribute(2, view.color);
    kind.radius.set(view.radius);
    kind.smooth.set(covers ? 1.f : 0.f);
    kind.opacity.set(view.opacity);
    draw_front_layer(view.opacity, [&] { gl::api().DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count)); });
  }

 private:
  struct Kind {
    gl::Program program;
    gl::Uniform<float> radius{program, "u_radius"}, smooth{program, "u_smooth"},
        opacity{program, "u_opacity"};
    gl::VertexArray array{};
  };

  gl::ArrayCache& arrays_;
  Kind discs_{{"discs", kDiscVertex, kDiscFragment}}, balls_{{"balls", kBallVertex, kBallFragment}};
};

}  // namespace understudy::render
