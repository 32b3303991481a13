#include "app/studio/previews.hpp"

#include <algorithm>
#include <utility>

#include "render/gl/program.hpp"
#include "ui/viewport/scene_builder.hpp"

namespace understudy::app {
namespace gl = render::gl;
namespace {

constexpr size_t kKept = 64;    // pictures
constexpr size_t kWaiting = 4;  // what was asked for before is no longer looked at

}  // namespace

Previews::Previews() = default;
Previews::~Previews() = default;

const FilePreview& Previews::of(const std::vector<std::string>& paths, render::PixelSize size, bool dark,
                                const std::string& up) {
  std::string key =
      std::to_string(size.width) + "x" + std::to_string(size.height) + (dark ? "d\n" : "l\n") + up + '\n';
  for (const std::string& path : paths) key += path + '\n';
  const auto [at, is_new] = pictures_.try_emplace(key);
  at->second.used = ++uses_;
  if (is_new) {
    const auto held = worker_.lock();
    to_read_.push_back({key, size, dark, paths, up, {}});
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
    for (const std::string& path : reading->paths)
      reading->contents.push_back(preview_content(path, reading->up));
    const auto held = worker_.lock();
    to_draw_.push_back(std::move(*reading));
  };
}

void Previews::draw(const Reading& reading) {
  Picture& picture = pictures_[reading.key];
  render::Scene scene;
  float x = 0;
  for (const PreviewContent& content : reading.contents) {
    if (!content.text.empty())
      picture.preview.text += (picture.preview.text.empty() ? "" : "; ") + content.text;
    Points shown = content.joints ? Points(*content.joints) : content.mesh.vertices;
    if (shown.rows() == 0) continue;
    const float left = shown.col(0).minCoeff(), width = shown.col(0).maxCoeff() - left;
    shown.col(0).array() += x - left;
    x += width + 0.15f;
    if (content.joints) {
      scene.skeletons.push_back(render::skeleton_view(Joints(shown)));
    } else {
      Mesh mesh = content.mesh;
      mesh.vertices = shown;
      render::add(scene, mesh);
    }
  }
  if (scene.meshes.empty() && scene.clouds.empty() && scene.skeletons.empty()) return;
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
