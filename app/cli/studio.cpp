#include "app/cli/studio.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/studio/application.hpp"
#include "app/studio/event_text.hpp"
#include "app/studio/recorder.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy::app {

std::function<std::shared_ptr<MotionCoder>()> coder_loader(const std::string& weights) {
  return [weights]() -> std::shared_ptr<MotionCoder> {
    nn::NetworkOptions options;
    options.weights = weights;
    return nn::load_motion_coder(nn::weights_folder(options));
  };
}

KeypointsLoader keypoints_loader(const std::string& weights) {
  return [weights](const std::string& method, const std::string& kind) {
    nn::NetworkOptions options;
    options.weights = weights;
    return nn::load_keypoint_finder(nn::weights_folder(options), method, kind);
  };
}

StudioServices studio_services(const std::string& weights) {
  StudioServices services;
  services.motion_coder = coder_loader(weights);
  services.networks = [weights](const Method& method, const NetworkParts& parts) {
    return nn::load_networks(network_options({method, weights, {}, {}, {}}), parts);
  };
  services.motion_space = [weights]() -> std::shared_ptr<MotionSpace> {
    nn::NetworkOptions options;
    options.weights = weights;
    return nn::load_motion_space(nn::weights_folder(options));
  };
  services.lifter = [weights] {
    nn::NetworkOptions options;
    options.weights = weights;
    return nn::load_lifter(nn::weights_folder(options));
  };
  services.keypoints = keypoints_loader(weights);
  services.dynamics = [weights](const understudy::Rig& rig) {
    nn::NetworkOptions options;
    options.weights = weights;
    return nn::load_motion_dynamics(nn::weights_folder(options), rig);
  };
  services.lengths = [weights]() -> std::shared_ptr<const LengthReader> {
    nn::NetworkOptions options;
    options.weights = weights;
    return nn::load_length_reader(nn::weights_folder(options));
  };
  services.flat_engine = [weights](const FlatEngine& wanted) {
    nn::NetworkOptions options;
    options.weights = weights;
    return nn::load_keypoint_transfer(options, wanted);
  };
  services.weights = [weights] {
    nn::NetworkOptions options;
    options.weights = weights;
    return report_header(nn::weights_folder(options))["weights"].get<std::string>();
  };
  const std::string missing = failure_of([&] { services.samples = samples_folder(); });
  if (!missing.empty()) log::warn(missing);
  return services;
}

render::ContextKind context_kind(const std::string& name) {
  if (name == "egl") return render::ContextKind::Egl;
  if (name == "osmesa") return render::ContextKind::Osmesa;
  return name == "null" ? render::ContextKind::Null : render::ContextKind::Any;
}

namespace {

namespace fs = std::filesystem;

struct StudioOptions {
  std::vector<std::string> paths;
  std::string record, marks, weights, size;
  bool software = false, gl_debug = false;
};

/// Folders for what is remembered; without them nothing is. greets: a newcomer.
void add_memory(StudioServices& services, bool greets) {
  const std::string problem = failure_of([&] {
    fs::create_directories(config_folder());
    fs::create_directories(state_folder());
  });
  if (!problem.empty()) return log::warn("settings cannot be saved: " + problem);
  services.settings_file = config_folder() + "/settings.json";
  services.autosave_folder = state_folder();
  services.greets_newcomers = greets;
}

render::WindowOptions window_options(const StudioOptions& options, const StudioServices& services) {
  const Settings settings =
      services.settings_file.empty() ? Settings{} : read_settings(services.settings_file);
  render::WindowOptions window;
  window.width = settings.window_width, window.height = settings.window_height;
  window.software = options.software;
  if (options.gl_debug) window.debug = render::gl::DebugMode::Log;
  if (options.size.empty()) return window;
  const render::PixelSize size = size_of(options.size);
  window.width = size.width, window.height = size.height;
  US_CHECK(window.width >= 1 && window.height >= 1, "--size must be WIDTHxHEIGHT, not ", options.size);
  return window;
}

int studio(const StudioOptions& options) {
  StudioServices services = studio_services(options.weights);
  add_memory(services, options.record.empty());  // what is recorded is played without the cards
  auto surface = std::make_unique<WindowSurface>(window_options(options, services));
  ApplicationOptions how;
  how.marks_file = options.marks;
  how.remember_size = options.size.empty();
  Application application(std::move(services), std::move(surface), how);
  std::unique_ptr<Recorder> recorder;
  if (!options.record.empty()) recorder = std::make_unique<Recorder>(options.record, application);
  application.observe(recorder.get());
  if (!options.paths.empty()) {
    Arguments paths;
    for (const std::string& path : options.paths) paths.push_back(fs::absolute(path).string());
    if (recorder) recorder->opened("open", paths);
    application.studio().try_run("open", paths);
  }
  bool asked = false;
  while (!application.session().quit) {
    if (interrupted() && !asked) application.studio().try_run("app.quit");
    asked = interrupted();
    application.step();
  }
  return 0;
}

}  // namespace

Action declare_studio(CLI::App& command) {
  const auto options = std::make_shared<StudioOptions>();
  command.add_option("PATHS", options->paths, "what to open: scans, a target, a document, a case folder");
  command.add_option("--record", options->record, "records your actions as a script for `understudy play`");
  command.add_flag("--software", options->software, "draws without the graphics driver");
  command.add_option("--size", options->size, "window size, WIDTHxHEIGHT (default: as last time)");
  command.add_option("--weights", options->weights, "folder of the weights (default: beside the program)");
  command.add_option("--marks", options->marks, "writes the positions of all widgets to this file");
  command.add_flag("--gl-debug", options->gl_debug, "logs the graphics driver's debug messages");
  return [options] { return studio(*options); };
}

}  // namespace understudy::app
