// Ambient occlusion from depth alone: creases and contacts lose light.
#pragma once

#include "render/gl/program.hpp"
#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {

// McGuire et al., "Scalable Ambient Obscurance", 2012, eq. 1, on normals from the depths around each pixel.
// Gives the light that is left, and the distance from the eye for the blur (0: background).
const std::string kEstimate = std::string(kFrameGlsl) + R"(
uniform sampler2D u_depth;
in vec2 v_place;
out vec4 o_color;
const float kRadius = 0.16, kBias = 0.006;  // metres
const int kSamples = 11;
vec3 position(vec2 place) {
  vec4 p = u_unprojection * (2.0 * vec4(place, textureLod(u_depth, place, 0.0).r, 1.0) - 1.0);
  return p.xyz / p.w;
}
vec3 steadier(vec3 a, vec3 b) { return abs(a.z) < abs(b.z) ? a : b; }
void main() {
  if (textureLod(u_depth, v_place, 0.0).r >= 1.0) { o_color = vec4(1.0, 0.0, 0.0, 1.0); return; }
  vec3 p = position(v_place);
  vec2 dx = vec2(u_size.z, 0.0), dy = vec2(0.0, u_size.w);
  vec3 along = steadier(position(v_place + dx) - p, p - position(v_place - dx));
  vec3 up = steadier(position(v_place + dy) - p, p - position(v_place - dy));
  vec3 n = normalize(cross(along, up));
  float w = u_eye.w > 0.5 ? -p.z : 1.0;
  float pixels = clamp(kRadius * u_projection[1][1] * 0.5 * u_size.y / w, 3.0, 0.12 * u_size.y);
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  float sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    float r = (float(i) + 0.5) / float(kSamples), angle = turn + float(i) * 2.3999632;
    vec3 v = position(v_place + r * pixels * vec2(cos(angle), sin(angle)) * u_size.zw) - p;
    float vv = dot(v, v), near = max(0.0, kRadius * kRadius - vv);
    sum += near * near * near * max(0.0, (dot(v, n) - kBias) / (vv + 1e-4));
  }
  float left = max(0.0, 1.0 - 5.0 * sum / (pow(kRadius, 6.0) * float(kSamples)) * 0.22);
  o_color = vec4(left, clamp(w / 32.0, 0.004, 1.0), 0.0, 1.0);
}
)";

const std::string kBlur = R"(
uniform sampler2D u_source;
uniform vec2 u_step;
in vec2 v_place;
out vec4 o_color;
void main() {
  vec2 here = texture(u_source, v_place).rg;
  if (here.g == 0.0) { o_color = vec4(here, 0.0, 1.0); return; }
  float sum = here.r, weights = 1.0;
  for (int i = -4; i <= 4; ++i) {
    if (i == 0) continue;
    vec2 there = texture(u_source, v_place + float(i) * u_step).rg;
    float weight = there.g == 0.0 ? 0.0 : exp(-float(i * i) / 9.0);
    sum += weight * there.r;
    weights += weight;
  }
  o_color = vec4(sum / weights, here.g, 0.0, 1.0);
}
)";

// Multiplies; occluded places turn a little warm rather than grey, as light bounces between skin.
const std::string kApply = R"(
uniform sampler2D u_source;
uniform float u_strength;
in vec2 v_place;
out vec4 o_color;
void main() {
  vec2 light = texture(u_source, v_place).rg;
  if (light.g == 0.0) discard;
  float dark = u_strength * (1.0 - light.r);
  o_color = vec4(1.0 - dark * vec3(0.92, 1.0, 1.04), 1.0);
}
)";

constexpr int kSharpPixels = 300000;  // larger pictures are estimated at half their size

class OcclusionPass {
 public:
  /// Darkens the bound target, `size` pixels, by what `depth_texture` (single-sampled, of the same size)
  /// shows. strength 0..1. Uses the FrameBlock that is bound.
  void draw(unsigned depth_texture, PixelSize size, float strength) {
    const gl::CapabilityScope depth(GL_DEPTH_TEST, false);
    const gl::VertexArrayScope array(none_.name());
    gl::api().ActiveTexture(GL_TEXTURE0);
    resize(size);
    estimate(depth_texture);
    blur(0, 1, {1.f / static_cast<float>(small_.width), 0});
    blur(1, 0, {0, 1.f / static_cast<float>(small_.height)});
    const gl::ProgramScope program(apply_.id());
    const gl::BlendScope multiply(GL_DST_COLOR, GL_ZERO);
    gl::api().BindTexture(GL_TEXTURE_2D, textures_[0].name());
    apply_source_.set(0);
    apply_strength_.set(strength);
    gl::api().DrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  void resize(PixelSize size) {
    const int divisor = size.width * size.height > kSharpPixels ? 2 : 1;
    const PixelSize small{(size.width + divisor - 1) / divisor, (size.height + divisor - 1) / divisor};
    if (small.width == small_.width && small.height == small_.height) return;
    small_ = small;
    for (int i = 0; i < 2; ++i) {
      gl::attach(framebuffers_[i], textures_[i], {small.width, small.height, GL_RG8, GL_RG});
      const gl::TargetScope target(framebuffers_[i].name(), small.width, small.height);
      US_CHECK(gl::api().CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
               "OpenGL makes no framebuffer for occlusion");
    }
  }

  void estimate(unsigned depth_texture) {
    const gl::TargetScope target(framebuffers_[0].name(), small_.width, small_.height);
    const gl::ProgramScope program(estimate_.id());
    gl::api().BindTexture(GL_TEXTURE_2D, depth_texture);
    estimate_depth_.set(0);
    gl::api().DrawArrays(GL_TRIANGLES, 0, 3);
  }

  void blur(int from, int to, const Eigen::Vector2f& step) {
    const gl::TargetScope target(framebuffers_[to].name(), small_.width, small_.height);
    const gl::ProgramScope program(blur_.id());
    gl::api().BindTexture(GL_TEXTURE_2D, textures_[from].name());
    blur_source_.set(0);
    blur_step_.set(step);
    gl::api().DrawArrays(GL_TRIANGLES, 0, 3);
  }

  gl::Program estimate_{"occlusion", kCoverGlsl, kEstimate}, blur_{"occlusion blur", kCoverGlsl, kBlur},
      apply_{"occlusion applying", kCoverGlsl, kApply};
  gl::Uniform<int> estimate_depth_{estimate_, "u_depth"}, blur_source_{blur_, "u_source"};
  gl::Uniform<Eigen::Vector2f> blur_step_{blur_, "u_step"};
  gl::Uniform<int> apply_source_{apply_, "u_source"};
  gl::Uniform<float> apply_strength_{apply_, "u_strength"};
  gl::VertexArray none_;
  PixelSize small_;
  gl::Texture textures_[2];
  gl::Framebuffer framebuffers_[2];
};

}  // namespace understudy::render
