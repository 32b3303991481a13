#include "render/passes/mesh_pass.hpp"

#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

const std::string kVertex = std::string(kFrameGlsl) + R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_color;
out vec3 v_position, v_normal, v_color;
void main() {
  v_position = a_position;
  v_normal = a_normal;
  v_color = a_color;
  gl_Position = u_projection * (u_view * vec4(a_position, 1.0));
}
)";

const std::string kFragment = std::string(kFrameGlsl) + kShadeGlsl + R"(
uniform float u_opacity;
uniform int u_two_sided;
in vec3 v_position, v_normal, v_color;
out vec4 o_color;
void main() {
  vec3 n = u_two_sided != 0 && !gl_FrontFacing ? -v_normal : v_normal;
  // A see-through body is clearer where it is seen face on and denser at its outline.
  float edge = 1.0 - abs(dot(normalize(n + vec3(0.0, 1e-6, 0.0)), towards_eye(v_position)));
  float alpha = u_opacity < 1.0 ? mix(u_opacity, 1.0, 0.75 * edge * edge) : 1.0;
  o_color = vec4(shade(v_color, n, v_position), alpha);
}
)";

}  // namespace

void check_rows(const char* what, const Points& optional, Eigen::Index vertices) {
  US_CHECK(optional.rows() == 0 || optional.rows() == vertices, optional.rows(), " ", what, " for ", vertices,
           " points to draw");
}

void check(const MeshView& view) {
  if (view.faces.rows() > 0)
    US_CHECK(view.faces.minCoeff() >= 0 && view.faces.maxCoeff() < view.vertices.rows(),
             "a face of the mesh to draw names a vertex that is not among its ", view.vertices.rows());
  check_rows("normals", view.normals, view.vertices.rows());
  check_rows("colours", view.colors, view.vertices.rows());
}

MeshPass::MeshPass() : program_("mesh", kVertex, kFragment) {}

void MeshPass::upload(const MeshView& view) {
  const auto bytes = [](const auto& array) { return static_cast<size_t>(array.size()) * sizeof(float); };
  const Points normals = view.normals.rows() > 0 ? view.normals : vertex_normals(view.vertices, view.faces);
  gl::upload(positions_, GL_ARRAY_BUFFER, view.vertices.data(), bytes(view.vertices));
  gl::upload(normals_, GL_ARRAY_BUFFER, normals.data(), bytes(normals));
  gl::upload(colors_, GL_ARRAY_BUFFER, view.colors.data(), bytes(view.colors));
  gl::use_vec3_attribute(0, positions_);
  gl::use_vec3_attribute(1, normals_);
  if (view.colors.rows() > 0)
    gl::use_vec3_attribute(2, colors_);
  else
    gl::use_constant_attribute(2, view.color);
  gl::upload(indices_, GL_ELEMENT_ARRAY_BUFFER, view.faces.data(), bytes(view.faces));
}

void MeshPass::draw(const MeshView& view) {
  if (view.faces.rows() == 0) return;
  const gl::ProgramScope program(program_.id());
  const gl::VertexArrayScope array(array_.name());
  upload(view);
  opacity_.set(view.opacity);
  two_sided_.set(view.two_sided ? 1 : 0);
  const auto draw = [&] {
    gl::api().DrawElements(GL_TRIANGLES, static_cast<GLsizei>(view.faces.size()), GL_UNSIGNED_INT, nullptr);
  };
  if (view.opacity >= 1) return draw();
  {  // the depth of the front layer first, so that inner surfaces do not shine through one another
    const gl::ColorMaskScope colors(false);
    draw();
  }
  const gl::BlendScope blend(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  const gl::DepthFuncScope depth(GL_LEQUAL);
  draw();
}

}  // namespace understudy::render
