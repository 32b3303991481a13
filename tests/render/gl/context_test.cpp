#include "render/context/context.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "render/gl/program.hpp"
#include "retarget/base/error.hpp"
#include "tests/render/content.hpp"
#include "tests/render/pictures.hpp"

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
  Scene scene = pear_and_skeleton();
  scene.meshes[0].wireframe = true;
  renderer.render_image(scene, view_of(scene), {64, 64});
  for (const GLenum capability :
       {GL_BLEND, GL_DEPTH_TEST, GL_PROGRAM_POINT_SIZE, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_POLYGON_OFFSET_LINE})
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
  Renderer smooth({4}), jagged({1, Quality::Best, false});
  EXPECT_NE(smooth.render_image(scene, view_of(scene), {64, 64}).pixels,
            jagged.render_image(scene, view_of(scene), {64, 64}).pixels);
}

/// Root mean square of what the pictures differ by, levels.
double rms(const Image& a, const Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) sum += std::pow(a.pixels[i] - b.pixels[i], 2);
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

/// How many different colours: jagged edges add few of their own.
size_t distinct_colors(const Image& image) {
  std::set<int> colors;
  for (size_t i = 0; i < image.pixels.size(); i += 3)
    colors.insert(image.pixels[i] << 16 | image.pixels[i + 1] << 8 | image.pixels[i + 2]);
  return colors.size();
}

TEST(Renderer, SmoothsOneSampleAfterwards) {
  const auto context = make_offscreen_context({ContextKind::Any, gl::DebugMode::Fatal});
  Scene scene;
  scene.ground.visible = false;
  scene.background = {Vec3::Zero(), Vec3::Zero()};
  scene.light.key = scene.light.fill = Vec3::Zero();
  scene.light.sky = scene.light.floor = Vec3::Ones();
  scene.light.shine = 0;
  add(scene, make_pear());
  scene.meshes[0].color = Vec3::Ones();  // white on black
  const Quality quick = Quality::Interactive;
  Renderer smooth({1, quick, true}), jagged({1, quick, false}), sampled({4, quick});
  const Image soft = smooth.render_image(scene, view_of(scene), {200, 200});
  const Image hard = jagged.render_image(scene, view_of(scene), {200, 200});
  EXPECT_LE(distinct_colors(hard), 3u);
  EXPECT_GE(distinct_colors(soft), 8u);
  const Image truth = sampled.render_image(scene, view_of(scene), {200, 200});
  EXPECT_LT(rms(soft, truth), 0.8 * rms(hard, truth));
}

TEST(Renderer, DrawsTheSameWhateverItDrewBefore) {
  const auto context = make_offscreen_context({ContextKind::Any, gl::DebugMode::Fatal});
  const Scene scene = pear_and_skeleton();
  Scene other = scene;
  other.background.top = Vec3::Zero();
  other.ground.spacing = 0.1f;
  Renderer used, fresh;
  for (int i = 0; i < 12; ++i) {  // other grounds, sizes and arrays, enough for buffers to change hands
    Scene moved = other;
    moved.meshes[0].vertices = Points(*other.meshes[0].vertices * (1 + 0.01f * static_cast<float>(i)));
    used.render_image(moved, view_of(moved), {64 + i % 2, 64});
  }
  EXPECT_EQ(used.render_image(scene, view_of(scene), {64, 64}).pixels,
            fresh.render_image(scene, view_of(scene), {64, 64}).pixels);
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
