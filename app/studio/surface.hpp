// Where the studio draws and gets its input: a window, or a picture in memory.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "render/context/context.hpp"
#include "render/context/input_event.hpp"
#include "render/context/window.hpp"
#include "render/gl/object.hpp"
#include "render/image.hpp"
#include "render/renderer.hpp"

namespace understudy::app {

/// Use from the thread that made it; its context is current from then on.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual render::Context& context() = 0;
  /// Where to draw; 0 x 0 while minimised.
  virtual render::RenderTarget target() = 0;
  /// How large text should be: 1 usual, 2 on a screen of twice the density.
  virtual float content_scale() const = 0;
  /// The input since the last call; sleeps up to `seconds` until there is some.
  virtual std::vector<render::InputEvent> events(double seconds) = 0;
  /// Shows what was drawn.
  virtual void present() = 0;
  /// The size of its content, in the desktop's units.
  virtual void resize(int width, int height) = 0;
  virtual void set_title(const std::string& title) = 0;
  virtual void set_cursor(render::CursorShape shape) = 0;
  virtual std::string clipboard() const = 0;
  virtual void set_clipboard(const std::string& text) = 0;
};

/// A picture in memory; push() gives it input. Throws Error when there is no OpenGL.
class OffscreenSurface final : public Surface {
 public:
  struct Options {
    int width = 1280, height = 800;
    float content_scale = 1;
    render::ContextOptions context;
  };
  explicit OffscreenSurface(const Options& options);

  /// From any thread.
  void push(render::InputEvent event);
  /// The last picture; black on a null context.
  render::Image picture();

  render::Context& context() override { return *context_; }
  render::RenderTarget target() override { return {framebuffer_->name(), {width_, height_}}; }
  float content_scale() const override { return content_scale_; }
  std::vector<render::InputEvent> events(double seconds) override;
  void present() override;
  void resize(int width, int height) override;
  void set_title(const std::string& title) override { title_ = title; }
  void set_cursor(render::CursorShape) override {}
  std::string clipboard() const override { return clipboard_; }
  void set_clipboard(const std::string& text) override { clipboard_ = text; }
  const std::string& title() const { return title_; }

 private:
  std::unique_ptr<render::Context> context_;
  std::unique_ptr<render::gl::Framebuffer> framebuffer_;
  std::unique_ptr<render::gl::Texture> color_;
  int width_ = 0, height_ = 0;
  float content_scale_ = 1;
  std::mutex mutex_;
  std::condition_variable pushed_;
  std::vector<render::InputEvent> waiting_;
  std::string title_, clipboard_;
};

/// A window on the desktop. Make it on the main thread. Throws Error as render::Window does.
class WindowSurface final : public Surface {
 public:
  explicit WindowSurface(const render::WindowOptions& options);

  render::Context& context() override { return window_.context(); }
  render::RenderTarget target() override;
  float content_scale() const override { return window_.content_scale(); }
  std::vector<render::InputEvent> events(double seconds) override;
  void present() override { window_.swap(); }
  void resize(int width, int height) override { window_.set_size(width, height); }
  void set_title(const std::string& title) override;
  void set_cursor(render::CursorShape shape) override;
  std::string clipboard() const override { return window_.clipboard(); }
  void set_clipboard(const std::string& text) override { window_.set_clipboard(text); }

 private:
  render::Window window_;
  std::vector<render::InputEvent> waiting_;
  std::string title_;
  render::CursorShape cursor_ = render::CursorShape::Arrow;
};

}  // namespace understudy::app
