// Lit smooth surfaces.
#pragma once

#include "render/gl/array_cache.hpp"
#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {

const std::string kMeshVertex = std::string(kFrameGlsl) + R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_color;
layout(location = 3) in float a_ambient;
out vec3 v_position, v_normal, v_color;
out float v_ambient;
void main() {
  v_position = a_position;
  v_normal = a_normal;
  v_color = a_color;
  v_ambient = a_ambient;
  gl_Position = u_projection * (u_view * vec4(a_position, 1.0));
}
)";

const std::string kMeshFragment = std::string(kFrameGlsl) + kShadeGlsl + R"(
uniform float u_opacity, u_occlusion;
uniform int u_two_sided, u_edges;
in vec3 v_position, v_normal, v_color;
in float v_ambient;
out vec4 o_color;
void main() {
  if (u_edges != 0) {
    o_color = vec4(0.04, 0.045, 0.05, 1.0) * (0.36 * u_opacity);
    return;
  }
  vec3 n = u_two_sided != 0 && !gl_FrontFacing ? -v_normal : v_normal;
  o_color = vec4(shade(v_color, n, v_position, 1.0 - u_occlusion * (1.0 - v_ambient)), u_opacity);
  if (u_opacity < 1.0) {  // a see-through body is clearer where it is seen face on and denser at its outline
    float edge = 1.0 - abs(dot(normalize(n + vec3(0.0, 1e-6, 0.0)), towards_eye(v_position)));
    o_color.a = mix(u_opacity, 1.0, 0.75 * edge * edge);
    o_color.rgb *= o_color.a;
  }
}
)";

/// Opaque ones, and see-through ones by their front layer alone.
class MeshPass {
 public:
  /// `arrays` outlives the pass.
  explicit MeshPass(gl::ArrayCache& arrays) : arrays_(arrays) {}

  /// Throws Error when faces name vertices that are not there, or normals, colours or ambient values are of
  /// another number. Every pass that draws the mesh relies on it: a driver may crash on such faces.
  static void check(const MeshView& view) {
    if (view.faces->rows() > 0)
      US_CHECK(view.faces->minCoeff() >= 0 && view.faces->maxCoeff() < view.vertices->rows(),
               "a face of the mesh to draw names a vertex that is not among its ", view.vertices->rows());
    check_rows("normals", view.normals->rows(), view.vertices->rows());
    check_rows("colours", view.colors->rows(), view.vertices->rows());
    check_rows("ambient values", view.ambient->rows(), view.vertices->rows());
  }

  /// The view has passed check(). occlusion: how much its ambient values count, 0..1.
  void draw(const MeshView& view, float occlusion) {
    if (view.faces->rows() == 0) return;
    const gl::ProgramScope program(program_.id());
    const gl::VertexArrayScope array(array_.name());
    const gl::CapabilityScope cull(GL_CULL_FACE, !view.two_sided);
    bind(view);
    opacity_.set(view.opacity);
    occlusion_.set(occlusion);
    two_sided_.set(view.two_sided ? 1 : 0);
    const auto draw = [&] {
      gl::api().DrawElements(GL_TRIANGLES, static_cast<GLsizei>(view.faces->size()), GL_UNSIGNED_INT,
                             nullptr);
    };
    edges_.set(0);
    draw_front_layer(view.opacity, draw);
    if (view.wireframe) draw_edges(draw);
  }

 private:
  /// A little nearer than the faces, which hide those behind.
  template <class Draw>
  void draw_edges(const Draw& draw) {
    const gl::BlendScope blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const gl::DepthFuncScope depth(GL_LEQUAL);
    const gl::DepthMaskScope keeps(false);
    const gl::EdgesScope edges(-1, -4);
    edges_.set(1);
    draw();
  }

  void bind(const MeshView& view) {
    gl::use_attribute(0, arrays_.of(view.vertices), 3);
    gl::use_attribute(
        1,
        arrays_.of(view.normals->rows() > 0 ? view.normals
                                            : SharedPoints(vertex_normals(view.vertices, view.faces))),
        3);
    if (view.colors->rows() > 0)
      gl::use_attribute(2, arrays_.of(view.colors), 3);
    else
      gl::use_constant_attribute(2, view.color);
    if (view.ambient->rows() > 0)
      gl::use_attribute(3, arrays_.of(view.ambient), 1);
    else
      gl::use_constant_attribute(3, Vec3::Ones());
    gl::api().BindBuffer(GL_ELEMENT_ARRAY_BUFFER, arrays_.of(view.faces).name());
  }

  gl::ArrayCache& arrays_;
  gl::Program program_{"mesh", kMeshVertex, kMeshFragment};
  gl::Uniform<float> opacity_{program_, "u_opacity"}, occlusion_{program_, "u_occlusion"};
  gl::Uniform<int> two_sided_{program_, "u_two_sided"}, edges_{program_, "u_edges"};
  gl::VertexArray array_;
};

}  // namespace understudy::render
