// Lines with a width in pixels and soft edges.
#pragma once

#include <vector>

#include "render/gl/program.hpp"
#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"

namespace understudy::render {

// Each line is a rectangle on the screen, half a pixel wider on each side for its soft rim.
const std::string kLinesVertex = std::string(kFrameGlsl) + R"(
layout(location = 0) in vec3 a_here;
layout(location = 1) in vec3 a_other;
layout(location = 2) in vec3 a_color;
layout(location = 3) in float a_opacity;
layout(location = 4) in vec2 a_corner;  // x: -1 here is the line's start, 1 its end; y: -1, 1 its sides
uniform float u_width, u_beyond;  // u_beyond: pixels it goes on past its ends
out vec4 v_color;
out float v_across;  // pixels from the line's middle
void main() {
  vec4 here = u_projection * (u_view * vec4(a_here, 1.0)), other = u_projection * (u_view * vec4(a_other, 1.0));
  const float nearest = 1e-3;  // what is behind the eye is cut off where the line passes it
  if (here.w < nearest && other.w > here.w) here = mix(here, other, (nearest - here.w) / (other.w - here.w));
  if (other.w < nearest && here.w > other.w) other = mix(other, here, (nearest - other.w) / (here.w - other.w));
  vec2 along = (other.xy / other.w - here.xy / here.w) * u_size.xy * 0.5 * -a_corner.x;
  along = dot(along, along) > 1e-8 ? normalize(along) : vec2(1.0, 0.0);
  v_across = a_corner.y * (0.5 * u_width + 0.5);
  vec2 pixels = vec2(-along.y, along.x) * v_across + along * a_corner.x * u_beyond;
  gl_Position = here + vec4(2.0 * pixels * u_size.zw * here.w, -1e-4 * here.w, 0.0);
  v_color = vec4(a_color * a_opacity, a_opacity);
}
)";
const std::string kLinesFragment = R"(
uniform float u_width;
in vec4 v_color;
in float v_across;
out vec4 o_color;
void main() { o_color = v_color * clamp(0.5 * u_width + 0.5 - abs(v_across), 0.0, 1.0); }
)";

class LinesPass {
 public:
  /// Blends over what is there, hidden by what is before it (depth test as the caller set it). Throws Error
  /// when colours or opacities are of another number than the points.
  void draw(const LinesView& view) {
    check_rows("colours", view.colors.rows(), view.positions.rows());
    check_rows("opacities", view.opacities.size(), view.positions.rows());
    const Corners corners = corners_of(view);
    if (corners.opacity.empty()) return;
    const gl::ProgramScope program(program_.id());
    const gl::VertexArrayScope array(array_.name());
    const gl::BlendScope blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const gl::DepthMaskScope depth(false);
    use(0, here_, corners.here, 3);
    use(1, other_, corners.other, 3);
    use(2, color_, corners.color, 3);
    use(3, opacity_, corners.opacity, 1);
    use(4, corner_, corners.corner, 2);
    width_.set(view.width);
    beyond_.set(view.connected ? 0.f : 0.5f);  // overlapping joints would show in see-through polylines
    gl::api().DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.opacity.size()));
  }

 private:
  /// The corners of all lines' triangles.
  struct Corners {
    std::vector<float> here, other, corner, color, opacity;

    void add(const LinesView& view, Eigen::Index from, Eigen::Index to) {
      constexpr int kEnds[] = {-1, 1, 1, -1, 1, -1}, kSides[] = {-1, -1, 1, -1, 1, 1};
      for (int k = 0; k < 6; ++k) {
        const Eigen::Index at = kEnds[k] < 0 ? from : to, far = kEnds[k] < 0 ? to : from;
        here.insert(here.end(), view.positions.data() + 3 * at, view.positions.data() + 3 * at + 3);
        other.insert(other.end(), view.positions.data() + 3 * far, view.positions.data() + 3 * far + 3);
        corner.push_back(static_cast<float>(kEnds[k]));
        corner.push_back(static_cast<float>(kSides[k]));
        const Vec3 rgb = view.colors.rows() > 0 ? Vec3(view.colors.row(at)) : view.color;
        color.insert(color.end(), rgb.data(), rgb.data() + 3);
        opacity.push_back(view.opacities.size() > 0 ? view.opacities[at] : view.opacity);
      }
    }
  };

  static Corners corners_of(const LinesView& view) {
    Corners corners;
    const Eigen::Index step = view.connected ? 1 : 2;
    for (Eigen::Index i = 0; i + 1 < view.positions.rows(); i += step)
      if (view.positions.row(i).allFinite() && view.positions.row(i + 1).allFinite())
        corners.add(view, i, i + 1);
    return corners;
  }

  static void use(unsigned index, const gl::Buffer& buffer, const std::vector<float>& values, int width) {
    gl::upload(buffer, GL_ARRAY_BUFFER, values.data(), values.size() * sizeof(float));
    gl::use_attribute(index, buffer, width);
  }

  gl::Program program_{"lines", kLinesVertex, kLinesFragment};
  gl::Uniform<float> width_{program_, "u_width"}, beyond_{program_, "u_beyond"};
  gl::VertexArray array_;
  gl::Buffer here_, other_, corner_, color_, opacity_;
};

}  // namespace understudy::render
