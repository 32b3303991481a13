#include "render/passes/points_pass.hpp"

#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"
#include "render/passes/mesh_pass.hpp"

namespace understudy::render {
namespace {

const std::string kVertex = std::string(kFrameGlsl) + R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_color;
uniform float u_radius;
out vec3 v_center, v_normal, v_color;  // centre and normal in camera axes
out float v_pixels;
void main() {
  vec4 center = u_view * vec4(a_position, 1.0);
  v_center = center.xyz;
  v_normal = mat3(u_view) * a_normal;
  if (v_normal.z < 0.0) v_normal = -v_normal;  // either side of the surface will do: show the one we see
  v_color = a_color;
  gl_Position = u_projection * center;
  v_pixels = max(2.0, u_radius * u_projection[1][1] * u_size.y / gl_Position.w);
  gl_PointSize = v_pixels;
}
)";

const std::string kFragment = std::string(kFrameGlsl) + kShadeGlsl + R"(
uniform float u_radius;
uniform int u_has_normals;
in vec3 v_center, v_normal, v_color;
in float v_pixels;
out vec4 o_color;
void main() {
  vec2 d = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0);
  float r2 = dot(d, d);
  vec3 n = vec3(d, sqrt(max(0.0, 1.0 - r2)));
  float height = n.z;
  if (u_has_normals != 0 && dot(v_normal, v_normal) > 0.5) {
    n = normalize(v_normal);
    height = -dot(n.xy, d) / max(n.z, 0.35);  // of the disc's plane, in radii; edge-on discs keep some width
    r2 += height * height;
  }
  if (r2 > 1.0) discard;
  vec3 position = v_center + u_radius * vec3(d, height);
  vec4 clip = u_projection * vec4(position, 1.0);
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
  mat3 to_world = transpose(mat3(u_view));
  vec3 world = to_world * (position - u_view[3].xyz);
  float alpha = clamp((1.0 - sqrt(r2)) * 0.5 * v_pixels + 0.5, 0.0, 1.0);  // becomes MSAA coverage
  o_color = vec4(shade(v_color, to_world * n, world), alpha);
}
)";

}  // namespace

PointsPass::PointsPass() : program_("points", kVertex, kFragment) {}

void PointsPass::draw(const PointsView& view) {
  if (view.positions.rows() == 0) return;
  check_rows("normals", view.normals, view.positions.rows());
  check_rows("colours", view.colors, view.positions.rows());
  const auto bytes = [](const Points& array) { return static_cast<size_t>(array.size()) * sizeof(float); };
  const gl::ProgramScope program(program_.id());
  const gl::VertexArrayScope array(array_.name());
  const gl::CapabilityScope size(GL_PROGRAM_POINT_SIZE, true), coverage(GL_SAMPLE_ALPHA_TO_COVERAGE, true);
  gl::upload(positions_, GL_ARRAY_BUFFER, view.positions.data(), bytes(view.positions));
  gl::upload(normals_, GL_ARRAY_BUFFER, view.normals.data(), bytes(view.normals));
  gl::upload(colors_, GL_ARRAY_BUFFER, view.colors.data(), bytes(view.colors));
  gl::use_vec3_attribute(0, positions_);
  view.normals.rows() > 0 ? gl::use_vec3_attribute(1, normals_) : gl::use_constant_attribute(1, Vec3::Zero());
  view.colors.rows() > 0 ? gl::use_vec3_attribute(2, colors_) : gl::use_constant_attribute(2, view.color);
  radius_.set(view.radius);
  has_normals_.set(view.normals.rows() > 0 ? 1 : 0);
  gl::api().DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(view.positions.rows()));
}

}  // namespace understudy::render
