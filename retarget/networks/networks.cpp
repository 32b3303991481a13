#include "retarget/networks/networks.hpp"

#include <dlfcn.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/program_files.hpp"
#include "retarget/base/text.hpp"
#include "retarget/marionette/dynamics_rows.hpp"
#include "retarget/motion_space/paper_space.hpp"
#include "retarget/networks/code_transfer.hpp"
#include "retarget/networks/dense_extractor.hpp"
#include "retarget/networks/length_reader.hpp"
#include "retarget/networks/lifter_network.hpp"
#include "retarget/networks/network_deformer.hpp"
#include "retarget/networks/plugin_api.hpp"
#include "retarget/networks/train_options.hpp"
#include "retarget/networks/weights_layout.hpp"
#include "retarget/pipeline/method_table.hpp"
#include "retarget/pose2d/lift_transfer.hpp"
#include "retarget/pose2d/limb_transfer.hpp"
#include "retarget/style/load_style.hpp"
#include "retarget/style/skeleton_style.hpp"
#include "retarget/style/words_style.hpp"

namespace understudy::nn {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPluginFile = "libunderstudy_networks.so";

/// One core is left to whatever else needs it (a window drawn in software): measured, two inference threads
/// gain little on an idle machine and lose much on a busy one.
int inference_threads() {
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return std::clamp(cores / 2, 1, 4);
}

void sink(log::Level level, const std::string& message) {
  level == log::Level::Warning ? log::warn(message) : log::info(message);
}

/// The plug-in needs addresses for LibTorch, OpenBLAS's buffers and stacks of threads; with too few it asks
/// for them for ever and nothing fails. Tried with `understudy retarget` on the samples under ulimit -v: one
/// thread works in 1.3 GB, not in 1.0; two threads never end in 1.3; four reserve 1.7 while loading.
/// The rest of 3 GB is for scans.
void check_address_space() {
  struct rlimit space {};
  constexpr rlim_t kLeast = rlim_t{3} << 30;
  US_CHECK(::getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur >= kLeast,
           "the networks need 3 GB of address space, this process may have ", space.rlim_cur >> 20,
           " MB (ulimit -v)");
}

std::string plugin_path() {
  if (const char* forced = std::getenv("UNDERSTUDY_PLUGIN")) return forced;
  const fs::path here = program_folder();
  for (const fs::path& folder : {here, here.parent_path(), here.parent_path() / "lib/understudy"})
    if (fs::exists(folder / kPluginFile)) return (folder / kPluginFile).string();
  throw Error(std::string(kPluginFile) + " is neither beside the program nor in ../lib/understudy");
}

const PluginApi& plugin() {
  static const PluginApi& api = []() -> const PluginApi& {
    check_address_space();
    const std::string path = plugin_path();
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw Error(path + ": cannot be loaded (" + dlerror() + ")");
    const auto entry =
        reinterpret_cast<decltype(&understudy_networks_plugin)>(dlsym(library, "understudy_networks_plugin"));
    US_CHECK(entry, path, ": not a networks plug-in");
    US_CHECK(entry()->version == kPluginVersion, path, ": a networks plug-in of version ", entry()->version,
             ", not ", kPluginVersion);
    entry()->send_log_to(sink);
    return *entry();
  }();
  return api;
}

/// Null where the folder has none: weights of one's own need no second look.
std::unique_ptr<PartRefiner> load_parts(const std::string& folder) {
  const std::string path = folder + "/part.weights";
  if (!fs::exists(path)) {
    log::warn_once(path + ": is missing; limbs and head are not refined");
    return nullptr;
  }
  return load_part_refiner(path);
}

std::unique_ptr<SkeletonExtractor> load_dense(const NetworkOptions& options, const std::string& folder) {
  const std::string file = folder + "/" + extractor_named(options.extractor).weights;
  return load_dense_extractor(options.extractor_file.empty() ? file : options.extractor_file,
                              options.near ? load_parts(folder) : nullptr);
}

/// One that is figures, or a network's words.
std::shared_ptr<MotionStyle> load_any_style(const StyleChoice& choice) {
  if (!is_words_file(choice.file)) return load_style(choice);
  auto style = std::make_shared<SkeletonStyle>(
      std::make_unique<WordsStyle>(plugin().load_words(style_file(choice))), choice.strength);
  style->set_rights(style_note(choice).rights());
  return style;
}

/// Makes one of flat_engines(); weights: its file, empty where it has none.
struct FlatMaker {
  const char* name;
  std::unique_ptr<KeypointTransfer> (*make)(const FlatEngine& wanted, const NetworkOptions& options,
                                            const std::string& weights);
};
constexpr FlatMaker kFlatMakers[] = {
    {"limbs",
     [](const FlatEngine& wanted, const NetworkOptions&, const std::string&)
         -> std::unique_ptr<KeypointTransfer> { return std::make_unique<LimbTransfer>(wanted.touches); }},
    {"paper", [](const FlatEngine&, const NetworkOptions&,
                 const std::string& weights) { return load_code_transfer(weights); }},
    {"lift",
     [](const FlatEngine& wanted, const NetworkOptions& options,
        const std::string& weights) -> std::unique_ptr<KeypointTransfer> {
       return std::make_unique<LiftTransfer>(
           load_network_lifter(weights, load_length_reader(weights_folder(options))), wanted.touches,
           static_cast<float>(1 / wanted.fps));
     }}};

/// The engine's own file, or the one of that name in the folder.
std::string weights_of(const NetworkOptions& options, const char* name) {
  return options.engine_file.empty() ? weights_folder(options) + "/" + name : options.engine_file;
}

/// At most this many threads of OpenMP: more only cost memory, and a hundred thousand of them the process.
void clamp_threads() {
  const char* const wanted = std::getenv("OMP_NUM_THREADS");
  const long most = std::max(64l, 4l * std::thread::hardware_concurrency());
  if (wanted == nullptr || std::strtol(wanted, nullptr, 10) <= most) return;
  log::warn("OMP_NUM_THREADS=" + std::string(wanted) +
            " is more than this machine can use: " + std::to_string(most) + " are taken");
  setenv("OMP_NUM_THREADS", std::to_string(most).c_str(), 1);
}

}  // namespace

void prepare_environment(bool trains) {
  // OpenBLAS 0.3.21 does not know processors newer than itself and falls back to kernels five times slower.
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl"))
    setenv("OPENBLAS_CORETYPE", "SkylakeX", 0);
  else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    setenv("OPENBLAS_CORETYPE", "Haswell", 0);
#endif
  // Waiting threads that spin take the cores from whoever draws or compiles.
  setenv("OMP_WAIT_POLICY", "PASSIVE", 0);
  setenv("OMP_NUM_THREADS", std::to_string(trains ? 1 : inference_threads()).c_str(), 0);
  clamp_threads();
  for (const char* variable : {"UNDERSTUDY_WEIGHTS", "UNDERSTUDY_PLUGIN"})
    if (const char* path = std::getenv(variable); path && *path != '\0')
      setenv(variable, fs::absolute(path).c_str(), 1);
}

std::string weights_folder(const NetworkOptions& options) {
  if (!options.weights.empty()) return options.weights;
  if (const char* forced = std::getenv("UNDERSTUDY_WEIGHTS")) return forced;
  return program_files("weights").string();
}

Networks load_networks(const NetworkOptions& options, const NetworkParts& parts) {
  const std::string folder = weights_folder(options);
  US_CHECK(!folder.empty(),
           "the trained weights are missing: no folder assets/weights beside the program or above "
           "it, nor ../share/understudy/weights");
  const bool dense = options.extractor == "dense";
  const MethodChoice& engine = engine_named(options.engine);
  // The plug-in is for what needs LibTorch.
  const NetworkParts left{parts.extractor && !dense, false, parts.transfer && !engine.make, false, false};
  Networks networks;
  if (left.extractor || left.transfer) networks = plugin().load(options, folder, left);
  if (parts.extractor && dense) networks.extractor = load_dense(options, folder);
  if (parts.rest_extractor && dense && options.extractor_file.empty())
    networks.rest_extractor = load_dense_extractor(folder + "/skeleton_rest.weights");
  if (parts.transfer && engine.make) networks.transfer = engine.make();
  if (parts.deformer)
    networks.deformer = load_network_deformer(folder + "/deformation.weights", options.offsets);
  if (parts.style && options.style.any()) networks.style = load_any_style(options.style);
  return networks;
}

StyleNote style_note(const StyleChoice& style) {
  const std::string file = style_file(style);
  if (!is_words_file(file)) return read_manner(file).note;
  const std::string bytes = read_file(file);
  const StoredWeights stored = parse_weights(bytes, file);
  const auto text = [&](const char* key) {
    const auto found = stored.texts.find(key);
    return found == stored.texts.end() ? std::string() : found->second;
  };
  US_CHECK(!text("licence").empty(), file, ": has no licence");
  return {file_name(file), text("label"),       "Words translated by a network",
          text("licence"), text("attribution"), text("made_from")};
}

std::unique_ptr<MotionSpace> load_motion_space(const std::string& folder, const std::string& name) {
  if (name == "paper") return std::make_unique<PaperSpace>(load_motion_coder(folder));
  US_CHECK(name == "space", "no network fills frames as '", name, "' does");
  return plugin().load_motion_space(folder + "/motion_space.weights");
}

std::unique_ptr<MotionCoder> load_motion_coder(const std::string& folder) {
  return plugin().load_motion_coder(folder + "/motion_steps.weights");
}

std::unique_ptr<KeypointFinder> load_keypoint_finder(const std::string& folder, const std::string& method,
                                                     const std::string& kind) {
  const MethodChoice& choice = rig_method_named(method);
  US_CHECK(choice.weights, "'", method, "' looks at the scans alone: there is no network of it");
  US_CHECK(std::find(kBodyKinds.begin(), kBodyKinds.end(), kind) != kBodyKinds.end(), "'", method,
           "' knows the kinds ", joined_once({kBodyKinds.begin(), kBodyKinds.end()}), ", not '", kind, "'");
  return plugin().load_keypoints(folder + "/" + choice.weights + "_" + kind + ".weights", method);
}

std::unique_ptr<StyleJudge> load_style_judge(const std::string& path) {
  return plugin().load_style_judge(path);
}

std::unique_ptr<LengthReader> load_length_reader(const std::string& folder) {
  return load_network_length_reader(folder + "/proportions.weights");
}

std::unique_ptr<KeypointTransfer> load_keypoint_transfer(const NetworkOptions& options,
                                                         const FlatEngine& wanted) {
  const MethodChoice& engine = flat_engine_named(wanted.name);
  US_CHECK(engine.weights || options.engine_file.empty(), options.engine_file, ": the engine '", wanted.name,
           "' has no network, so no weights");
  for (const FlatMaker& one : kFlatMakers)
    if (wanted.name == one.name)
      return one.make(wanted, options, engine.weights ? weights_of(options, engine.weights) : "");
  throw Error("nothing makes the engine '" + wanted.name + "'");
}

std::unique_ptr<Lifter> load_lifter(const std::string& folder) {
  return load_network_lifter(folder + "/lifter.weights", load_length_reader(folder));
}

std::unique_ptr<MotionDynamics> load_motion_dynamics(const std::string& place, const Rig& rig) {
  std::vector<std::string> files = {place};
  if (fs::is_directory(place)) {
    files.clear();
    for (const char* kind : kBodyKinds) files.push_back(place + "/marionette_dynamics_" + kind + ".weights");
  }
  std::string kinds;
  for (const std::string& file : files) {
    if (!fs::exists(file)) continue;
    const std::string bytes = read_file(file);
    const StoredWeights stored = parse_weights(bytes, file);
    const auto text = [&](const char* key) {
      const auto found = stored.texts.find(key);
      return found == stored.texts.end() ? std::string() : found->second;
    };
    kinds += (kinds.empty() ? "" : ", ") + text("kind");
    if (text("bones") != bones_of(rig)) continue;
    auto dynamics = plugin().load_dynamics(file);
    dynamics->begin(rig);
    return dynamics;
  }
  US_CHECK(!kinds.empty(), place, ": has no weights of how bodies move (marionette_dynamics_person.weights)");
  throw Error(rig.name + ": its bones are not those of the kinds that a network knows (" + kinds +
              "); --engine match needs no network");
}

RuntimeReport runtime_report() {
  RuntimeReport report = plugin().report();
  const auto cores = std::thread::hardware_concurrency();
  report.threads_why = std::to_string(report.threads) + " of " + std::to_string(cores) +
                       " cores: the rest stays free for drawing (OMP_NUM_THREADS changes it)";
  return report;
}

int train(const AnyTrainOptions& options) {
  const std::clock_t before = std::clock();  // of all threads
  const int result = plugin().train(options);
  const auto network = std::visit([](const auto& own) { return own.kNetwork; }, options);
  log::info(detail::join("train ", network, ": ", (std::clock() - before) / CLOCKS_PER_SEC,
                         " core-seconds in this run"));
  return result;
}

}  // namespace understudy::nn
