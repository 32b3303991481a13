// GL owners, scopes and the renderer's bookkeeping, without a GPU.
#include <gtest/gtest.h>

#include <vector>

#include "render/context/context.hpp"
#include "render/gl/object.hpp"
#include "render/gl/scopes.hpp"
#include "render/renderer.hpp"
#include "retarget/base/error.hpp"
#include "tests/render/content.hpp"

namespace understudy::render {
namespace {

struct FakeTraits {
  static inline unsigned last = 0;
  static inline std::vector<unsigned> destroyed;
  static unsigned create() { return ++last; }
  static void destroy(unsigned name) { destroyed.push_back(name); }
};
using Fake = gl::Object<FakeTraits>;

class GlObject : public testing::Test {
 protected:
  void SetUp() override {
    FakeTraits::last = 0;
    FakeTraits::destroyed.clear();
  }
};

static_assert(!std::is_copy_constructible_v<Fake> && !std::is_copy_assignable_v<Fake>);
static_assert(std::is_nothrow_move_constructible_v<Fake> && std::is_nothrow_move_assignable_v<Fake>);

TEST_F(GlObject, DestroysItsNameOnce) {
  { const Fake object; }
  EXPECT_EQ(FakeTraits::destroyed, std::vector<unsigned>{1});
}

TEST_F(GlObject, MovedFromOwnsNothing) {
  {
    Fake first;
    const Fake second(std::move(first));
    EXPECT_EQ(first.name(), 0u);
    EXPECT_EQ(second.name(), 1u);
  }
  EXPECT_EQ(FakeTraits::destroyed, std::vector<unsigned>{1});
}

TEST_F(GlObject, MoveAssignmentLosesNeitherName) {
  {
    Fake first, second;
    first = std::move(second);
    EXPECT_EQ(first.name(), 2u);
  }
  EXPECT_EQ(FakeTraits::destroyed.size(), 2u);
}

TEST(GlApi, SaysSoWithoutAContext) {
  gl::set_api(nullptr);
  EXPECT_THROW(gl::api(), Error);
  EXPECT_THROW(Renderer(), Error);
}

TEST(GlFunctions, NameTheOneThatIsMissing) {
  try {
    gl::load_functions([](const char*) -> void* { return nullptr; });
    FAIL() << "no Error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("glActiveTexture"), std::string::npos);
  }
}

Scene everything() {
  Scene scene;
  add(scene, make_pear(12, 16));
  MeshView ghost = scene.meshes[0];
  ghost.opacity = 0.5f;
  scene.meshes.push_back(ghost);
  Mesh cloud;
  cloud.vertices = ghost.vertices;
  add(scene, cloud);
  scene.skeletons.push_back(skeleton_view(make_joints()));
  scene.lines.push_back(box(Vec3::Zero(), Vec3::Ones(), Vec3::Zero()));
  scene.gizmos.emplace_back();
  return scene;
}

TEST(NullRenderer, DrawsEverythingAndLeavesNoNames) {
  const auto context = make_offscreen_context({ContextKind::Null});
  {
    Renderer renderer;
    const Scene scene = everything();
    renderer.render_image(scene, view_of(scene), {32, 32});
    renderer.render_image(scene, view_of(scene), {48, 16});
    EXPECT_GT(null_counts().draws, 10);
    EXPECT_GT(null_counts().live_names, 10);
  }
  EXPECT_EQ(null_counts().live_names, 0);
}

TEST(NullRenderer, RefusesFacesThatNameNoVertex) {
  const auto context = make_offscreen_context({ContextKind::Null});
  Renderer renderer;
  const Scene scene = everything();
  for (const size_t which : {0, 1}) {  // the opaque and the see-through one
    Scene broken = scene;
    Faces faces = broken.meshes[which].faces;
    faces(3, 1) = static_cast<int>(broken.meshes[which].vertices->rows());
    broken.meshes[which].faces = faces;
    EXPECT_THROW(renderer.render_image(broken, Camera(), {32, 32}), Error);
    EXPECT_EQ(null_counts().draws, 0);
  }
}

TEST(NullRenderer, RefusesArraysOfOtherLengths) {
  const auto context = make_offscreen_context({ContextKind::Null});
  Renderer renderer;
  Scene colors = everything(), parents = everything();
  colors.clouds[0].colors = Points(Points::Zero(3, 3));
  parents.skeletons[0].parents.pop_back();
  EXPECT_THROW(renderer.render_image(colors, Camera(), {32, 32}), Error);
  EXPECT_THROW(renderer.render_image(parents, Camera(), {32, 32}), Error);
  EXPECT_THROW(renderer.render_image(Scene(), Camera(), {0, 32}), Error);
}

}  // namespace
}  // namespace understudy::render
