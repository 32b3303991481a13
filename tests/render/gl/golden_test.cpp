// Each pass against a stored picture, and proof that each picture would notice: the same scene with the pass
// turned off or around must differ from it. US_UPDATE_GOLDEN=1 writes the pictures anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "render/colors.hpp"
#include "retarget/geometry/ambient_occlusion.hpp"
#include "tests/render/content.hpp"
#include "tests/render/pictures.hpp"

namespace understudy::render {
namespace {

constexpr double kAlike = 0.01, kUnlike = 0.02;  // shares of pixels

std::string golden_path(const std::string& name) {
  return std::string(US_SOURCE_DIR "/tests/golden/") + name + ".png";
}

/// The pass draws what it drew when someone last looked.
void expect_golden(const std::string& name, const Scene& scene, Quality quality = Quality::Best) {
  const Image now = picture(scene, view_of(scene), {160, 160}, ContextKind::Any, quality);
  const char* update = std::getenv("US_UPDATE_GOLDEN");
  if (update != nullptr && std::string(update) == "1") write_png(golden_path(name), now);
  const double difference_now = difference(now, read_png(golden_path(name)));
  if (difference_now > kAlike) {
    write_png(name + "_now.png", now);
    ADD_FAILURE() << name << ": " << 100 * difference_now << " % of the pixels differ; see "
                  << std::filesystem::absolute(name + "_now.png");
  }
}

/// This scene, seen as `original` is, is not what the stored picture shows.
void expect_noticed(const std::string& name, const Scene& original, const Scene& broken,
                    Quality quality = Quality::Best) {
  const Image now = picture(broken, view_of(original), {160, 160}, ContextKind::Any, quality);
  EXPECT_GT(difference(now, read_png(golden_path(name))), kUnlike) << name;
}

Scene pear() {
  Scene scene;
  add(scene, make_pear());
  return scene;
}

TEST(GoldenMesh, IsAsItWas) {
  expect_golden("mesh", pear());
}

TEST(GoldenMesh, NoticesInvertedNormals) {
  Scene broken = pear();
  MeshView& mesh = broken.meshes[0];
  mesh.normals = -vertex_normals(mesh.vertices, mesh.faces);
  expect_noticed("mesh", pear(), broken);
}

TEST(GoldenMesh, NoticesTheMissingPass) {
  Scene broken = pear();
  broken.meshes.clear();
  expect_noticed("mesh", pear(), broken);
}

TEST(GoldenMesh, NoticesMissingBackground) {
  Scene broken = pear();
  broken.background = {Vec3::Zero(), Vec3::Zero()};
  expect_noticed("mesh", pear(), broken);
}

/// The far half of a pear: its inside is seen.
Scene shell() {
  Scene scene = pear();
  MeshView& mesh = scene.meshes[0];
  Eigen::Index kept = 0;
  Faces faces = mesh.faces;
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    if ((*mesh.vertices)(faces(f, 0), 2) < 0) faces.row(kept++) = Faces(faces.row(f));
  faces.conservativeResize(kept, 3);
  mesh.faces = faces;
  return scene;
}

TEST(GoldenTwoSided, IsAsItWas) {
  expect_golden("two_sided", shell());
}

TEST(GoldenTwoSided, NoticesOneSidedLight) {
  Scene broken = shell();
  broken.meshes[0].two_sided = false;
  expect_noticed("two_sided", shell(), broken);
}

Scene weighted() {
  Scene scene = pear();
  MeshView& mesh = scene.meshes[0];
  RowMatrix weights = RowMatrix::Zero(mesh.vertices->rows(), 22);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    const float at = std::clamp((*mesh.vertices)(v, 1) / 1.2f, 0.f, 1.f) * 20.99f;
    const int j = static_cast<int>(at);
    weights(v, j) = 1 - (at - static_cast<float>(j));
    weights(v, j + 1) = at - static_cast<float>(j);
  }
  mesh.colors = weight_colors(weights);
  return scene;
}

TEST(GoldenWeights, AreAsTheyWere) {
  expect_golden("weights", weighted());
}

TEST(GoldenWeights, NoticeMissingColours) {
  expect_noticed("weights", weighted(), pear());
}

Scene viridis_cloud() {
  Scene scene;
  Mesh cloud;
  Rng rng(2);
  cloud.vertices = sample_points(make_pear(), 2500, rng);
  cloud.colors = colors_along(viridis, cloud.vertices.col(1), 0, 1.2f);
  add(scene, cloud);
  return scene;
}

TEST(GoldenPoints, AreAsTheyWere) {
  expect_golden("points", viridis_cloud());
}

TEST(GoldenPoints, NoticeTheMissingPass) {
  Scene broken = viridis_cloud();
  broken.clouds.clear();
  expect_noticed("points", viridis_cloud(), broken);
}

TEST(GoldenPoints, NoticeMissingNormals) {
  Scene broken = viridis_cloud();
  broken.clouds[0].normals = {};
  expect_noticed("points", viridis_cloud(), broken);
}

TEST(GoldenPoints, NoticeAnotherRadius) {
  Scene broken = viridis_cloud();
  broken.clouds[0].radius *= 0.5f;
  expect_noticed("points", viridis_cloud(), broken);
}

Scene skeleton() {
  Scene scene;
  scene.skeletons.push_back(skeleton_view(make_joints()));
  scene.skeletons[0].x_ray = false;
  scene.skeletons[0].thickness = 1.6f;
  return scene;
}

TEST(GoldenSkeleton, IsAsItWas) {
  expect_golden("skeleton", skeleton());
}

TEST(GoldenSkeleton, NoticesExchangedSides) {
  Scene broken = skeleton();
  for (Side& side : broken.skeletons[0].sides)
    side = side == Side::Left ? Side::Right : side == Side::Right ? Side::Left : Side::Middle;
  expect_noticed("skeleton", skeleton(), broken);
}

TEST(GoldenSkeleton, NoticesTheMissingPass) {
  Scene broken = skeleton();
  broken.skeletons.clear();
  expect_noticed("skeleton", skeleton(), broken);
}

Scene x_ray() {
  Scene scene;
  add(scene, make_pear(40, 56, 1.75f));
  scene.skeletons.push_back(skeleton_view(make_joints()));
  return scene;
}

TEST(GoldenXRay, IsAsItWas) {
  expect_golden("x_ray", x_ray());
}

TEST(GoldenXRay, NoticesASkeletonThatIsHidden) {
  Scene broken = x_ray();
  broken.skeletons[0].x_ray = false;
  expect_noticed("x_ray", x_ray(), broken);
}

Scene ghost() {
  Scene scene = x_ray();
  scene.meshes[0].opacity = 0.35f;
  scene.skeletons[0].x_ray = false;
  return scene;
}

TEST(GoldenGhost, IsAsItWas) {
  expect_golden("ghost", ghost());
}

TEST(GoldenGhost, NoticesAnOpaqueBody) {
  Scene broken = ghost();
  broken.meshes[0].opacity = 1;
  expect_noticed("ghost", ghost(), broken);
}

Scene wired() {
  Scene scene = pear();
  scene.meshes[0].wireframe = true;
  return scene;
}

TEST(GoldenWireframe, IsAsItWas) {
  expect_golden("wireframe", wired());
}

TEST(GoldenWireframe, NoticesTheMissingEdges) {
  expect_noticed("wireframe", wired(), pear());
}

Scene floating() {  // high enough that grid and shadow are seen
  Scene scene = pear();
  scene.ground.spacing = 0.2f;
  scene.ground.shadow = 1;
  return scene;
}

TEST(GoldenGround, IsAsItWas) {
  expect_golden("ground", floating());
}

TEST(GoldenGround, NoticesTheMissingGrid) {
  Scene broken = floating();
  broken.ground.visible = false;
  expect_noticed("ground", floating(), broken);
}

TEST(GoldenGround, NoticesTheMissingShadow) {
  Scene broken = floating();
  broken.ground.shadow = 0;
  expect_noticed("ground", floating(), broken);
}

Scene creased() {  // three pears run into one another
  Scene scene;
  for (const float x : {-0.3f, 0.f, 0.3f}) {
    Mesh mesh = make_pear();
    mesh.vertices.col(0).array() += x;
    add(scene, mesh);
  }
  scene.occlusion = 1;
  return scene;
}

TEST(GoldenOcclusion, IsAsItWas) {
  expect_golden("occlusion", creased());
}

TEST(GoldenOcclusion, NoticesTheMissingPass) {
  Scene broken = creased();
  broken.occlusion = 0;
  expect_noticed("occlusion", creased(), broken);
}

/// Half a pear seen from its hollow side, with ambient light of its own and nothing from the depths.
Scene ambient() {
  Scene scene = shell();
  MeshView& mesh = scene.meshes[0];
  mesh.faces = mesh.faces->rowwise().reverse();  // the hollow side is the outside
  mesh.normals = vertex_normals(mesh.vertices, mesh.faces);
  mesh.ambient = ambient_occlusion(mesh.vertices, mesh.faces, mesh.normals);
  scene.occlusion = 1;
  return scene;
}

TEST(GoldenAmbient, IsAsItWas) {
  expect_golden("ambient", ambient(), Quality::Interactive);
}

TEST(GoldenAmbient, NoticesTheMissingTerm) {
  Scene broken = ambient();
  broken.meshes[0].ambient = {};
  expect_noticed("ambient", ambient(), broken, Quality::Interactive);
}

TEST(GoldenAmbient, NoticesInvertedNormals) {
  Scene broken = ambient();
  broken.meshes[0].normals = -*broken.meshes[0].normals;
  expect_noticed("ambient", ambient(), broken, Quality::Interactive);
}

Scene errors() {
  Scene scene = pear();
  MeshView& mesh = scene.meshes[0];
  mesh.colors = colors_along(error_color, mesh.vertices->col(1) * 0.05f, 0, 0.05f);
  return scene;
}

TEST(GoldenErrors, AreAsTheyWere) {
  expect_golden("errors", errors());
}

TEST(GoldenErrors, NoticeAnotherScale) {
  Scene broken = errors();
  broken.meshes[0].colors = colors_along(viridis, broken.meshes[0].vertices->col(1), 0, 1);
  expect_noticed("errors", errors(), broken);
}

TEST(GoldenErrors, NoticeInvertedNormals) {
  Scene broken = errors();
  MeshView& mesh = broken.meshes[0];
  mesh.normals = -vertex_normals(mesh.vertices, mesh.faces);
  expect_noticed("errors", errors(), broken);
}

/// A trail around a pear, partly behind it, and a box.
Scene lined() {
  Scene scene = pear();
  Points spiral(120, 3);
  for (int i = 0; i < 120; ++i) {
    const float t = static_cast<float>(i) / 119, angle = 12 * t;
    spiral.row(i) << 0.7f * std::cos(angle), 1.3f * t, 0.7f * std::sin(angle);
  }
  scene.lines.push_back(trail(spiral, kRightColor, 5));
  scene.lines.push_back(box(Vec3(-0.6f, 0, -0.5f), Vec3(0.6f, 1.25f, 0.5f), kLeftColor, 3));
  scene.lines[1].x_ray = true;
  return scene;
}

TEST(GoldenLines, AreAsTheyWere) {
  expect_golden("lines", lined());
}

TEST(GoldenLines, NoticeEachMissingLine) {
  for (const size_t which : {0, 1}) {
    Scene broken = lined();
    broken.lines.erase(broken.lines.begin() + static_cast<long>(which));
    expect_noticed("lines", lined(), broken);
  }
}

TEST(GoldenLines, NoticeThatNoneFades) {
  Scene broken = lined();
  broken.lines[0].opacities.setZero();
  expect_noticed("lines", lined(), broken);
}

TEST(GoldenLines, NoticeOtherWidths) {
  Scene broken = lined();
  for (auto& line : broken.lines) line.width = 1;
  expect_noticed("lines", lined(), broken);
}

Scene handled(GizmoView::Kind kind) {
  Scene scene = pear();
  GizmoView gizmo;
  gizmo.kind = kind;
  gizmo.position = Vec3(0, 0.6f, 0);
  gizmo.size = 0.42f;
  gizmo.hovered = GizmoHandle::AxisY;
  scene.gizmos.push_back(gizmo);
  return scene;
}

TEST(GoldenGizmo, IsAsItWas) {
  expect_golden("gizmo_move", handled(GizmoView::Kind::Move));
  expect_golden("gizmo_turn", handled(GizmoView::Kind::Turn));
}

TEST(GoldenGizmo, NoticesTheMissingOne) {
  expect_noticed("gizmo_move", handled(GizmoView::Kind::Move), pear());
  expect_noticed("gizmo_turn", handled(GizmoView::Kind::Turn), pear());
}

TEST(GoldenGizmo, NoticesTheOtherKind) {
  expect_noticed("gizmo_move", pear(), handled(GizmoView::Kind::Turn));
}

TEST(GoldenGizmo, NoticesAnExchangedAxis) {
  Scene broken = handled(GizmoView::Kind::Move);
  broken.gizmos[0].axes.col(0).swap(broken.gizmos[0].axes.col(1));
  expect_noticed("gizmo_move", broken, broken);
}

Scene cut_out() {
  Scene scene = ghost();
  scene.background.transparent = true;
  scene.ground.visible = true;
  return scene;
}

TEST(GoldenTransparent, IsAsItWas) {
  expect_golden("transparent", cut_out());
}

TEST(GoldenTransparent, HasAlphaWhereItShould) {
  Scene scene = pear();
  scene.background.transparent = true;
  scene.ground.visible = false;
  const Image image = picture(scene, view_of(scene));
  ASSERT_EQ(image.alpha.size(), 160u * 160u);
  EXPECT_EQ(image.alpha[0], 0);
  EXPECT_EQ(image.alpha[80 * 160 + 80], 255);
}

TEST(GoldenTransparent, NoticesTheBackground) {
  expect_noticed("transparent", cut_out(), ghost());
}

TEST(GoldenTransparent, NoticesTheMissingGround) {
  Scene broken = cut_out();
  broken.ground.visible = false;
  expect_noticed("transparent", cut_out(), broken);
}

}  // namespace
}  // namespace understudy::render
