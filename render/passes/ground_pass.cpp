#include "render/passes/ground_pass.hpp"

#include <algorithm>

#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

constexpr int kSide = 160;        // pixels of the shadow picture
constexpr float kMargin = 0.45f;  // metres of free floor around what casts it

// Red: what is within a hand of the floor, the contact. Green: all of the body, fading with height.
const std::string kFlattenVertex = R"(
layout(location = 0) in vec3 a_position;
uniform vec3 u_area;  // x, z of the corner, side
uniform float u_height, u_point_pixels;
out vec2 v_dark;
void main() {
  float h = max(0.0, a_position.y - u_height);
  v_dark = vec2(exp(-h / 0.07), 0.75 * exp(-h / 0.9));
  gl_Position = vec4((a_position.xz - u_area.xy) / u_area.z * 2.0 - 1.0, 0.0, 1.0);
  gl_PointSize = u_point_pixels;
}
)";
const std::string kFlattenFragment = R"(
in vec2 v_dark;
out vec4 o_color;
void main() { o_color = vec4(v_dark, 0.0, 1.0); }
)";

const std::string kBlurFragment = R"(
uniform sampler2D u_source;
uniform vec2 u_step;
in vec2 v_place;
out vec4 o_color;
void main() {
  vec2 sum = vec2(0.0);
  float weights = 0.0;
  for (int i = -5; i <= 5; ++i) {
    float w = exp(-float(i * i) / 9.0);
    sum += w * vec2(texture(u_source, v_place + float(i) * u_step).r, texture(u_source, v_place + 2.2 * float(i) * u_step).g);
    weights += w;
  }
  o_color = vec4(sum / weights, 0.0, 1.0);
}
)";

const std::string kGroundVertex = std::string(kFrameGlsl) + R"(
uniform vec4 u_place;  // centre, radius
out vec3 v_position;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  v_position = u_place.xyz + u_place.w * vec3(corner.x, 0.0, corner.y);
  gl_Position = u_projection * (u_view * vec4(v_position, 1.0));
}
)";
const std::string kGroundFragment = std::string(kFrameGlsl) + R"(
uniform vec4 u_place;
uniform vec3 u_line, u_area;
uniform float u_spacing, u_strength;
uniform sampler2D u_shadow;
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
  vec2 place = (v_position.xz - u_area.xy) / u_area.z;
  vec2 dark = texture(u_shadow, place).rg;
  vec2 inside = smoothstep(vec2(0.0), vec2(0.06), place) * smoothstep(vec2(0.0), vec2(0.06), 1.0 - place);
  float shadow = u_strength * inside.x * inside.y * (1.0 - (1.0 - 0.75 * dark.r) * (1.0 - 0.75 * dark.g));
  // The shadow lies over the lines: premultiplied, shadow's colour is a dark blue-grey.
  vec3 color = mix(u_line * line, vec3(0.13, 0.14, 0.17), shadow);
  o_color = vec4(color, line + shadow - line * shadow);
}
)";

/// The floor below the scene: corner x, z and side of a square around everything, with a margin.
Vec3 area_below(const Points& points) {
  if (points.rows() == 0) return Vec3(-1, -1, 2);
  const Eigen::RowVector3f low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const float side = std::max(high.x() - low.x(), high.z() - low.z()) + 2 * kMargin;
  return Vec3((low.x() + high.x() - side) / 2, (low.z() + high.z() - side) / 2, side);
}

/// Clamped, filtered, no mipmaps.
void set_up_texture(const gl::Texture& texture) {
  gl::api().BindTexture(GL_TEXTURE_2D, texture.name());
  gl::api().TexImage2D(GL_TEXTURE_2D, 0, GL_RG8, kSide, kSide, 0, GL_RG, GL_UNSIGNED_BYTE, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl::api().TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl::api().TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

}  // namespace

ShadowPass::ShadowPass()
    : flatten_("flattening", kFlattenVertex, kFlattenFragment),
      blur_("shadow blur", kCoverGlsl, kBlurFragment) {
  for (int i = 0; i < 2; ++i) {
    set_up_texture(textures_[i]);
    const gl::TargetScope target(framebuffers_[i].name(), kSide, kSide);
    gl::api().FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures_[i].name(),
                                   0);
    US_CHECK(gl::api().CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
             "OpenGL makes no framebuffer for shadows");
  }
}

Vec3 ShadowPass::draw(const Scene& scene) {
  const Vec3 area = area_below(all_points(scene));
  const gl::CapabilityScope depth(GL_DEPTH_TEST, false);
  draw_flattened(scene, area);
  blur(0, 1, {1.f / kSide, 0});
  blur(1, 0, {0, 1.f / kSide});
  return area;
}

void ShadowPass::draw_flattened(const Scene& scene, const Vec3& area) {
  const gl::TargetScope target(framebuffers_[0].name(), kSide, kSide);
  gl::api().ClearColor(0, 0, 0, 0);
  gl::api().Clear(GL_COLOR_BUFFER_BIT);
  const gl::ProgramScope program(flatten_.id());
  const gl::VertexArrayScope array(array_.name());
  const gl::BlendScope darkest(GL_ONE, GL_ONE, GL_MAX);
  const gl::CapabilityScope size(GL_PROGRAM_POINT_SIZE, true);
  area_.set(area);
  height_.set(scene.ground.height);
  const auto bytes = [](const auto& values) { return static_cast<size_t>(values.size()) * sizeof(float); };
  for (const auto& mesh : scene.meshes) {
    gl::upload(positions_, GL_ARRAY_BUFFER, mesh.vertices.data(), bytes(mesh.vertices));
    gl::use_vec3_attribute(0, positions_);
    gl::upload(indices_, GL_ELEMENT_ARRAY_BUFFER, mesh.faces.data(), bytes(mesh.faces));
    point_pixels_.set(1.f);
    gl::api().DrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.faces.size()), GL_UNSIGNED_INT, nullptr);
  }
  for (const auto& cloud : scene.clouds) {
    gl::upload(positions_, GL_ARRAY_BUFFER, cloud.positions.data(), bytes(cloud.positions));
    gl::use_vec3_attribute(0, positions_);
    point_pixels_.set(std::max(2.f, 4 * cloud.radius * kSide / area.z()));
    gl::api().DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(cloud.positions.rows()));
  }
}

void ShadowPass::blur(int from, int to, const Eigen::Vector2f& step) {
  const gl::TargetScope target(framebuffers_[to].name(), kSide, kSide);
  const gl::ProgramScope program(blur_.id());
  const gl::VertexArrayScope array(none_.name());
  gl::api().ActiveTexture(GL_TEXTURE0);
  gl::api().BindTexture(GL_TEXTURE_2D, textures_[from].name());
  source_.set(0);
  step_.set(step);
  gl::api().DrawArrays(GL_TRIANGLES, 0, 3);
}

GroundPass::GroundPass() : program_("ground", kGroundVertex, kGroundFragment) {}

void GroundPass::draw(const Scene& scene) {
  const GroundView& view = scene.ground;
  if (!view.visible) return;
  const Vec3 area = shadow_pass_.draw(scene);
  const gl::ProgramScope program(program_.id());
  const gl::VertexArrayScope array(none_.name());
  const gl::BlendScope blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  const gl::DepthMaskScope depth(false);
  gl::api().ActiveTexture(GL_TEXTURE0);
  gl::api().BindTexture(GL_TEXTURE_2D, shadow_pass_.texture());
  place_.set({area.x() + area.z() / 2, view.height, area.y() + area.z() / 2, view.radius + area.z() / 2});
  line_.set(view.line);
  area_.set(area);
  spacing_.set(view.spacing);
  strength_.set(view.shadow);
  shadow_.set(0);
  gl::api().DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace understudy::render
