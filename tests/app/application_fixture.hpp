// The whole studio without a window, with stand-ins for the networks.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/studio/application.hpp"
#include "app/studio/script.hpp"
#include "retarget/base/error.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {

class ApplicationTest : public StudioTest {
 protected:
  void make(render::ContextKind kind = render::ContextKind::Null, render::PixelSize size = {1280, 800},
            float scale = 1) {
    script_.reset();
    application_.reset();
    OffscreenSurface::Options options;
    options.width = size.width, options.height = size.height;
    options.content_scale = scale;
    options.context = {kind, render::gl::DebugMode::Fatal};
    auto surface = std::make_unique<OffscreenSurface>(options);
    surface_ = surface.get();
    ApplicationOptions how;
    how.echo_log = false;
    how.marks_file = path("marks.txt");
    StudioServices all = services();
    all.samples = folder_.string();
    application_ = std::make_unique<Application>(all, std::move(surface), how);
    ScriptOptions script_options;
    script_options.name = "test.us";
    script_options.out = path("out");
    script_options.timeout_s = 60;
    script_ = std::make_unique<Script>(*application_, *surface_, script_options);
  }
  void play(const std::string& text) { script_->play(text); }
  /// What playing says; empty: nothing went wrong.
  std::string complaint(const std::string& text) {
    try {
      play(text);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  }
  const Session& session() const { return application_->session(); }

  OffscreenSurface* surface_ = nullptr;
  std::unique_ptr<Application> application_;
  std::unique_ptr<Script> script_;
};

/// Opens the dance and the target.
constexpr const char* kOpenBoth = "open samples/scan.npz samples/target.obj\nwait\n";

}  // namespace understudy::app
