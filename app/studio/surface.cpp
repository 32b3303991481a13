#include "app/studio/surface.hpp"

#include <chrono>
#include <cstring>
#include <utility>

#include "render/gl/program.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace gl = render::gl;

OffscreenSurface::OffscreenSurface(const Options& options)
    : context_(render::make_offscreen_context(options.context)), content_scale_(options.content_scale) {
  resize(options.width, options.height);
}

void OffscreenSurface::push(render::InputEvent event) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(event));
  }
  pushed_.notify_one();
}

std::vector<render::InputEvent> OffscreenSurface::events(double seconds) {
  std::unique_lock lock(mutex_);
  if (seconds > 0)
    pushed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return !waiting_.empty(); });
  return std::exchange(waiting_, {});
}

/// Waits until it is drawn, as a screen would.
void OffscreenSurface::present() {
  gl::api().Finish();
}

void OffscreenSurface::resize(int width, int height) {
  US_CHECK(width >= 1 && width <= 16384 && height >= 1 && height <= 16384, "a picture of ", width, " x ",
           height, " pixels cannot be made: 1 to 16384 a side");
  if (width == width_ && height == height_) return;
  context_->make_current();
  color_ = std::make_unique<gl::Texture>();
  framebuffer_ = std::make_unique<gl::Framebuffer>();
  gl::attach(*framebuffer_, *color_, {width, height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST});
  gl::api().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_->name());
  US_CHECK(gl::api().CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
           "OpenGL cannot make a picture of ", width, " x ", height, " pixels");
  width_ = width, height_ = height;
}

render::Image OffscreenSurface::picture() {
  context_->make_current();
  gl::api().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_->name());
  gl::api().ReadBuffer(GL_COLOR_ATTACHMENT0);
  gl::api().PixelStorei(GL_PACK_ALIGNMENT, 1);
  const size_t row = 3 * static_cast<size_t>(width_);
  std::vector<uint8_t> upside_down(row * static_cast<size_t>(height_));
  gl::api().ReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  render::Image image(width_, height_);
  for (int y = 0; y < height_; ++y)
    std::memcpy(image.at(0, y), upside_down.data() + row * static_cast<size_t>(height_ - 1 - y), row);
  return image;
}

WindowSurface::WindowSurface(const render::WindowOptions& options) : window_(options) {
  window_.set_handler([this](render::InputEvent event) { waiting_.push_back(std::move(event)); });
}

render::RenderTarget WindowSurface::target() {
  const auto [width, height] = window_.size();
  return {0, {width, height}};
}

std::vector<render::InputEvent> WindowSurface::events(double seconds) {
  if (seconds > 0)
    window_.wait(seconds);
  else
    window_.poll();
  return std::exchange(waiting_, {});
}

void WindowSurface::set_title(const std::string& title) {
  if (title == title_) return;
  title_ = title;
  window_.set_title(title);
}

void WindowSurface::set_cursor(render::CursorShape shape) {
  if (shape == cursor_) return;
  cursor_ = shape;
  window_.set_cursor(shape);
}

}  // namespace understudy::app
