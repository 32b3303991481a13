#include "app/studio/previews.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/run/source.hpp"
#include "app/run/target_file.hpp"
#include "app/session/document_file.hpp"
#include "render/gl/program.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/vertex_colors.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "ui/panels/panel.hpp"
#include "ui/viewport/scene_builder.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace gl = render::gl;
namespace {

constexpr uintmax_t kLargestFile = 256u << 20;  // bytes of a file that is read only to be looked at
constexpr size_t kKept = 64;                    // pictures
constexpr size_t kWaiting = 4;                  // what was asked for before is no longer looked at

std::string described(const Mesh& mesh) {
  return mesh.is_cloud()
             ? grouped(mesh.vertices.rows()) + " points"
             : grouped(mesh.vertices.rows()) + " vertices, " + grouped(mesh.faces.rows()) + " faces";
}

/// A value that a share of them lies below.
float quantile(Eigen::VectorXf values, float share) {
  const auto at = values.data() + static_cast<Eigen::Index>(share * static_cast<float>(values.size() - 1));
  std::nth_element(values.data(), at, values.data() + values.size());
  return *at;
}

/// Without the few points far from all others: a small picture is of what matters.
Mesh without_outliers(Mesh mesh) {
  if (!mesh.is_cloud() || mesh.vertices.rows() < 100) return mesh;
  std::vector<Eigen::Index> kept;
  Eigen::RowVector3f low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = quantile(mesh.vertices.col(axis), 0.02f),
    high[axis] = quantile(mesh.vertices.col(axis), 0.98f);
    const float room = 0.15f * (high[axis] - low[axis]);
    low[axis] -= room, high[axis] += room;
  }
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i)
    if ((mesh.vertices.row(i).array() >= low.array()).all() &&
        (mesh.vertices.row(i).array() <= high.array()).all())
      kept.push_back(i);
  const Points points = mesh.vertices(kept, Eigen::all);
  mesh.vertices = points;
  mesh.colors.resize(0, 3);
  return mesh;
}

/// On the floor, 1.7 high and round the y axis, whatever its units.
Mesh normalized(Mesh mesh) {
  if (mesh.is_cloud()) mesh.vertices = finite_points(mesh.vertices);
  if (mesh.vertices.rows() == 0) return mesh;
  US_CHECK(mesh.vertices.allFinite(), "has vertices that are not finite");
  mesh = without_outliers(std::move(mesh));
  const Eigen::RowVector3f low = mesh.vertices.colwise().minCoeff(),
                           high = mesh.vertices.colwise().maxCoeff();
  const float size = (high - low).maxCoeff();
  const Eigen::RowVector3f foot(0.5f * (low.x() + high.x()), low.y(), 0.5f * (low.z() + high.z()));
  mesh.vertices.rowwise() -= foot;
  if (size > 0) mesh.vertices *= 1.7f / size;
  return mesh;
}

}  // namespace

Previews::Previews() = default;
Previews::~Previews() = default;

const FilePreview& Previews::of(const std::vector<std::string>& paths, render::PixelSize size, bool dark) {
  std::string key = std::to_string(size.width) + "x" + std::to_string(size.height) + (dark ? "d\n" : "l\n");
  for (const std::string& path : paths) key += path + '\n';
  const auto [at, is_new] = pictures_.try_emplace(key);
  at->second.used = ++uses_;
  if (is_new) {
    const auto held = worker_.lock();
    to_read_.push_back({key, size, dark, paths, {}});
    while (to_read_.size() > kWaiting) {
      pictures_.erase(to_read_.front().key);  // asked for again when it is looked at again
      to_read_.pop_front();
    }
    worker_.wake();
  }
  return at->second.preview;
}

bool Previews::busy() const {
  const auto held = worker_.lock();
  return worker_.working() || !to_read_.empty() || !to_draw_.empty();
}

bool Previews::update() {
  Reading reading;
  {
    const auto held = worker_.lock();
    if (to_draw_.empty()) return false;
    reading = std::move(to_draw_.front());
    to_draw_.pop_front();
  }
  draw(reading);
  forget_oldest();
  return true;
}

Worker::Task Previews::next() {
  if (to_read_.empty()) return nullptr;
  const auto reading =
      std::make_shared<Reading>(std::move(to_read_.back()));  // the newest is what is looked at
  to_read_.pop_back();
  return [this, reading] {
    for (const std::string& path : reading->paths) reading->contents.push_back(read(path));
    const auto held = worker_.lock();
    to_draw_.push_back(std::move(*reading));
  };
}

Previews::Content Previews::read(const std::string& path) {
  Content content;
  try {
    const fs::path at(path);
    if (can_be(path, kDocument)) {
      const SavedDocument saved = read_document(path);
      if (!saved.document.source.path.empty()) content = read(saved.document.source.path);
      const size_t takes = saved.document.takes.size();
      content.text = std::to_string(takes) + (takes == 1 ? " target" : " targets") +
                     (content.text.empty() ? "" : "; " + content.text);
      return content;
    }
    if (!fs::is_directory(at)) {
      if (!can_be(path, kTarget | kScanSequence)) return content;
      if (fs::file_size(at) > kLargestFile) return {{}, "too large for a preview"};
    }
    if (!fs::is_directory(at) && can_be(path, kTarget)) {
      const Character character = read_target(path, {});
      MergedSurface surface = merged_surface(character, bind_pose(character).vertices);
      paint(surface, character);
      content.mesh = normalized(std::move(surface.mesh));
      content.text = described(content.mesh);
      return content;
    }
    SourceOptions options;
    options.path = fs::exists(at / "case.json") ? path + "/source" : path;
    options.quiet = true;
    const auto source = open_source(options);
    const auto frame = source->next();
    if (!frame) return content;
    content.mesh = normalized(frame->mesh);
    const auto count = source->count();
    content.text = (count ? grouped(*count) + " frames, " : "") + described(frame->mesh);
  } catch (const std::exception& error) {
    content.text = error.what();  // shown beside the file: it is only looked at
  }
  return content;
}

void Previews::draw(const Reading& reading) {
  Picture& picture = pictures_[reading.key];
  render::Scene scene;
  float x = 0;
  for (const Content& content : reading.contents) {
    if (!content.text.empty())
      picture.preview.text += (picture.preview.text.empty() ? "" : "; ") + content.text;
    if (content.mesh.vertices.rows() == 0) continue;
    Mesh mesh = content.mesh;
    const float left = mesh.vertices.col(0).minCoeff(), width = mesh.vertices.col(0).maxCoeff() - left;
    mesh.vertices.col(0).array() += x - left;
    x += width + 0.15f;
    render::add(scene, mesh);
  }
  if (scene.meshes.empty() && scene.clouds.empty()) return;
  scene.background = ui::background_of(reading.dark ? ui::ThemeKind::Dark : ui::ThemeKind::Light);
  scene.ground.visible = false;
  picture.texture = picture_of(scene, reading.size);
  picture.preview.texture = ui::texture_id(picture.texture->name());
  picture.preview.width = reading.size.width, picture.preview.height = reading.size.height;
}

/// A texture whose first row is the top one, as ImGui expects.
std::unique_ptr<gl::Texture> Previews::picture_of(const render::Scene& scene, render::PixelSize size) {
  if (!renderer_)
    renderer_ = std::make_unique<render::Renderer>(render::RendererOptions{4, render::Quality::Interactive});
  const gl::Texture drawn;
  auto flipped = std::make_unique<gl::Texture>();
  const gl::Framebuffer from, to;
  const int w = size.width, h = size.height;
  gl::attach(from, drawn, {w, h});
  gl::attach(to, *flipped, {w, h});
  render::Camera camera;
  camera.yaw = 0.35f, camera.pitch = 0.1f;
  camera = render::fitted(camera, render::all_points(scene), size.aspect(), 0.06f);
  renderer_->draw(scene, camera, {from.name(), size});
  gl::api().BindFramebuffer(GL_READ_FRAMEBUFFER, from.name());
  gl::api().BindFramebuffer(GL_DRAW_FRAMEBUFFER, to.name());
  gl::api().BlitFramebuffer(0, 0, w, h, 0, h, w, 0, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl::api().BindFramebuffer(GL_FRAMEBUFFER, 0);
  return flipped;
}

void Previews::forget_oldest() {
  while (pictures_.size() > kKept) {
    auto oldest = pictures_.begin();
    for (auto at = pictures_.begin(); at != pictures_.end(); ++at)
      if (at->second.used < oldest->second.used) oldest = at;
    pictures_.erase(oldest);
  }
}

}  // namespace understudy::app
