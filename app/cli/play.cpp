#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <iterator>

#include "app/cli/commands.hpp"
#include "app/cli/studio.hpp"
#include "app/studio/application.hpp"
#include "app/studio/event_text.hpp"
#include "app/studio/script.hpp"
#include "retarget/base/file.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

struct PlayOptions {
  std::string script, out = ".", size = "1280x800", context = "any", state, weights, marks;
  float scale = 1;
  double timeout_s = 600;
};

OffscreenSurface::Options surface_options(const PlayOptions& options) {
  OffscreenSurface::Options surface;
  const render::PixelSize size = size_of(options.size);
  surface.width = size.width, surface.height = size.height;
  surface.content_scale = options.scale;
  surface.context = {context_kind(options.context), render::gl::DebugMode::Fatal};
  return surface;
}

std::string script_text(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  return read_file(path);
}

int play(const PlayOptions& options) {
  const std::string text = script_text(options.script);
  StudioServices services = studio_services(options.weights);
  if (!options.state.empty()) {
    fs::create_directories(options.state);
    services.settings_file = options.state + "/settings.json";
    services.autosave_folder = options.state;
  }
  auto surface = std::make_unique<OffscreenSurface>(surface_options(options));
  OffscreenSurface& seen = *surface;
  ApplicationOptions how;
  how.marks_file = options.marks;
  Application application(std::move(services), std::move(surface), how);
  ScriptOptions script_options;
  script_options.name = options.script;
  script_options.out = options.out;
  script_options.timeout_s = options.timeout_s;
  Script script(application, seen, script_options);
  script.play(text);
  script.check_no_error();
  application.studio().session().changed = false;  // what the script did not save is not wanted
  return 0;
}

}  // namespace

Action declare_play(CLI::App& command) {
  const auto options = std::make_shared<PlayOptions>();
  command.add_option("SCRIPT", options->script, "commands and input, a line each; - reads them from stdin")
      ->required();
  command.add_option("--out", options->out, "folder for pictures and paths that begin with out/");
  command.add_option("--size", options->size, "window size, WIDTHxHEIGHT");
  command.add_option("--scale", options->scale, "scale of text and controls")->check(CLI::Range(0.5, 4.0));
  command.add_option("--context", options->context, "OpenGL context: any, egl, osmesa, null (draws nothing)")
      ->check(CLI::IsMember({"any", "egl", "osmesa", "null"}));
  command.add_option("--state", options->state, "folder for settings and autosaves (default: none are kept)");
  command.add_option("--weights", options->weights, "folder of the weights (default: beside the program)");
  command.add_option("--timeout", options->timeout_s, "time limit of each wait, seconds")
      ->check(CLI::Range(1.0, 86400.0));
  command.add_option("--marks", options->marks, "writes the positions of all widgets to this file");
  return [options] { return play(*options); };
}

}  // namespace understudy::app
