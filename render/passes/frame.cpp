#include "render/passes/frame.hpp"

#include <Eigen/Dense>

#include "render/gl/program.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

/// The std140 layout of `Frame`.
struct FrameData {
  Mat4 view, projection, unprojection;
  Eigen::Vector4f eye, key_direction, fill_direction, key, fill, sky, floor, size;
};

Eigen::Vector4f four(const Vec3& v, float w = 0) {
  return {v.x(), v.y(), v.z(), w};
}

}  // namespace

const char* const kFrameGlsl = R"(
layout(std140) uniform Frame {
  mat4 u_view;
  mat4 u_projection;
  mat4 u_unprojection;    // the projection's inverse
  vec4 u_eye;             // perspective: position and 1; orthographic: the direction back to the viewer and 0
  vec4 u_key_direction;   // in the world, towards the light; w: shine
  vec4 u_fill_direction;
  vec4 u_key;
  vec4 u_fill;
  vec4 u_sky;
  vec4 u_floor;
  vec4 u_size;            // width, height in pixels and their inverses
};
vec3 towards_eye(vec3 position) { return normalize(u_eye.xyz - u_eye.w * position); }
)";

// Products and roots in place of powers throughout: software OpenGL draws twice as fast without pow.
const char* const kShadeGlsl = R"(
vec3 to_linear(vec3 c) { return c * c; }
vec3 to_srgb(vec3 c) { return sqrt(clamp(c, 0.0, 1.0)); }
vec3 shade(vec3 color, vec3 normal, vec3 position, float ambient) {
  vec3 n = normalize(normal + vec3(0.0, 1e-6, 0.0));
  vec3 v = towards_eye(position);
  // The key light wraps a little round the terminator, as light from a large soft box does.
  float key = max(0.0, (dot(n, u_key_direction.xyz) + 0.15) / 1.15);
  float fill = max(0.0, (dot(n, u_fill_direction.xyz) + 0.4) / 1.4);
  vec3 around = mix(u_floor.rgb, u_sky.rgb, 0.5 + 0.5 * n.y);
  // Occluded places turn a little warm rather than grey, as light bounces between skin; they lose less of the
  // key light, which is small and may well reach them.
  vec3 open = 1.0 - (1.0 - ambient) * vec3(0.92, 1.0, 1.04);
  vec3 light = u_key.rgb * key * (0.4 + 0.6 * ambient) + (u_fill.rgb * fill + around) * open;
  float away = 1.0 - max(0.0, dot(n, v));
  float mirror = max(0.0, dot(n, normalize(v + u_key_direction.xyz)));
  mirror *= mirror; mirror *= mirror; mirror *= mirror; mirror *= mirror; mirror *= mirror;  // to the 32nd
  float rim = away * away * away * away * (0.5 + 0.5 * n.y) * ambient;
  return to_srgb(to_linear(color) * light + u_key_direction.w * (mirror * key * u_key.rgb + 1.2 * rim * u_sky.rgb));
}
)";

const char* const kCoverGlsl = R"(
out vec2 v_place;
void main() {
  v_place = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  gl_Position = vec4(2.0 * v_place - 1.0, 1.0, 1.0);
}
)";

void check_rows(const char* what, Eigen::Index rows, Eigen::Index points) {
  US_CHECK(rows == 0 || rows == points, rows, " ", what, " for ", points, " points to draw");
}

void FrameBlock::set(const Camera& camera, const LightView& light, PixelSize size) {
  // Lights turn with the camera about the vertical, so that the shown side is lit from every side alike; they
  // do not pitch with it: "above" stays above.
  size_ = size;
  Camera level = camera;
  level.pitch = 0;
  const Mat3 R = axes(level);
  FrameData data;
  data.view = view_matrix(camera);
  data.projection = projection_matrix(camera, size.aspect());
  data.unprojection = data.projection.inverse();
  data.eye = camera.orthographic ? four(axes(camera).col(2), 0) : four(eye(camera), 1);
  data.key_direction = four(R * light.key_direction.normalized(), light.shine);
  data.fill_direction = four(R * light.fill_direction.normalized());
  data.key = four(light.key);
  data.fill = four(light.fill);
  data.sky = four(light.sky);
  data.floor = four(light.floor);
  data.size << static_cast<float>(size.width), static_cast<float>(size.height),
      1.f / static_cast<float>(size.width), 1.f / static_cast<float>(size.height);
  gl::upload(buffer_, GL_UNIFORM_BUFFER, &data, sizeof data);
  gl::api().BindBufferBase(GL_UNIFORM_BUFFER, 0, buffer_.name());
}

}  // namespace understudy::render
