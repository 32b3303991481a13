#include "render/passes/background_pass.hpp"

#include "render/gl/scopes.hpp"
#include "render/passes/frame.hpp"

namespace understudy::render {
namespace {

constexpr const char* kBackgroundFragment = R"(
uniform vec3 u_top, u_bottom;
in vec2 v_place;
out vec4 o_color;
void main() { o_color = vec4(mix(u_bottom, u_top, smoothstep(0.0, 1.0, v_place.y)), 1.0); }
)";

}  // namespace

BackgroundPass::BackgroundPass() : program_("background", kCoverGlsl, kBackgroundFragment) {}

void BackgroundPass::draw(const BackgroundView& view) {
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

}  // namespace understudy::render
