#include "render/context/context.hpp"

#include <gtest/gtest.h>

#include "content.hpp"
#include "pictures.hpp"
#include "render/gl/program.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

Scene pear_and_skeleton() {
  Scene scene;
  add(scene, make_pear());
  scene.skeletons.push_back(skeleton_view(make_joints()));
  return scene;
}

class OffscreenContext : public testing::TestWithParam<ContextKind> {};

TEST_P(OffscreenContext, DrawsThePicture) {
  const Scene scene = pear_and_skeleton();
  const Image any = picture(scene, view_of(scene)),
              this_one = picture(scene, view_of(scene), {160, 160}, GetParam());
  EXPECT_LT(difference(any, this_one), 0.01);
  EXPECT_GT(difference(any, Image(160, 160)), 0.2);
}

TEST_P(OffscreenContext, MakesErrorsFatalWhenAsked) {
  const auto context = make_offscreen_context({GetParam(), gl::DebugMode::Fatal});
  gl::check_debug();
  gl::api().Enable(0xFFFF);
  EXPECT_THROW(gl::check_debug(), Error);
  gl::check_debug();  // told once
}

INSTANTIATE_TEST_SUITE_P(Kinds, OffscreenContext, testing::Values(ContextKind::Egl, ContextKind::Osmesa),
                         [](const auto& test) { return test.param == ContextKind::Egl ? "Egl" : "Osmesa"; });

TEST(Renderer, GivesTheSameBytesTwice) {
  const Scene scene = pear_and_skeleton();
  EXPECT_EQ(picture(scene, view_of(scene)).pixels, picture(scene, view_of(scene)).pixels);
}

TEST(Renderer, LeavesTheStateAsItWas) {
  const auto context = make_offscreen_context({ContextKind::Any, gl::DebugMode::Fatal});
  Renderer renderer;
  const Scene scene = pear_and_skeleton();
  renderer.render_image(scene, view_of(scene), {64, 64});
  for (const GLenum capability :
       {GL_BLEND, GL_DEPTH_TEST, GL_PROGRAM_POINT_SIZE, GL_SAMPLE_ALPHA_TO_COVERAGE})
    EXPECT_EQ(gl::api().IsEnabled(capability), GL_FALSE) << capability;
  for (const GLenum binding : {GL_CURRENT_PROGRAM, GL_VERTEX_ARRAY_BINDING, GL_DRAW_FRAMEBUFFER_BINDING}) {
    GLint bound = -1;
    gl::api().GetIntegerv(binding, &bound);
    EXPECT_EQ(bound, 0) << binding;
  }
}

TEST(Renderer, SmoothsEdgesByMultisampling) {
  const auto context = make_offscreen_context({ContextKind::Any, gl::DebugMode::Fatal});
  Scene scene = pear_and_skeleton();
  Renderer smooth({4}), jagged({1});
  EXPECT_NE(smooth.render_image(scene, view_of(scene), {64, 64}).pixels,
            jagged.render_image(scene, view_of(scene), {64, 64}).pixels);
}

TEST(Program, NamesAUniformThatIsNotThere) {
  const auto context = make_offscreen_context();
  const gl::Program program("plain", "void main() { gl_Position = vec4(0.0); }",
                            "out vec4 c; void main() { c = vec4(1.0); }");
  try {
    gl::Uniform<float> uniform(program, "u_absent");
    FAIL() << "no Error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("u_absent"), std::string::npos);
  }
}

TEST(Program, RepeatsTheCompilersWords) {
  const auto context = make_offscreen_context();
  EXPECT_THROW(gl::Program("broken", "void main() { gl_Position = nothing; }", "void main() {}"), Error);
}

}  // namespace
}  // namespace understudy::render
