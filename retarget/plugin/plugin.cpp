// What the networks plug-in hands to the program: networks with trained weights, and their training.
#include <dlfcn.h>
#include <torch/torch.h>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/networks/plugin_api.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/pipeline/method_table.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::nn {
namespace {

std::unique_ptr<MotionTransfer> load_transfer(const NetworkOptions& options, const std::string& folder) {
  const std::string usual = folder + "/" + engine_named(options.engine).weights;
  const std::string file = options.engine_file.empty() ? usual : options.engine_file;
  if (options.engine == "paper") return load_paper_transfer(file);
  throw Error("the networks plug-in does not know the engine " + options.engine);
}

/// A name of the BLAS library that LibTorch uses, or null: only OpenBLAS has these.
template <class Function>
Function blas_symbol(const char* name) {
  void* blas = dlopen("libblas.so.3", RTLD_NOLOAD | RTLD_LAZY);
  if (!blas) return nullptr;
  const auto function = reinterpret_cast<Function>(dlsym(blas, name));
  dlclose(blas);  // only our count of it: LibTorch keeps it
  return function;
}

RuntimeReport report() {
  RuntimeReport found;
  found.torch_version = TORCH_VERSION;
  using Text = char* (*)();
  const auto config = blas_symbol<Text>("openblas_get_config");
  const auto core = blas_symbol<Text>("openblas_get_corename");
  found.slow_blas = config == nullptr;
  found.blas = config ? config() : "the reference BLAS";
  found.blas_core = core ? core() : "";
  found.threads = at::get_num_threads();
  return found;
}

void send_log_to(void (*sink)(log::Level, const std::string&)) {
  log::set_sink(sink);
}

std::unique_ptr<SkeletonExtractor> load_extractor(const NetworkOptions& options, const std::string& folder) {
  const std::string file = folder + "/" + extractor_named(options.extractor).weights;
  if (options.extractor != "paper")
    throw Error("the networks plug-in does not know the extractor " + options.extractor);
  return load_paper_extractor(options.extractor_file.empty() ? file : options.extractor_file);
}

Networks load(const NetworkOptions& options, const std::string& folder, const NetworkParts& parts) {
  if (report().slow_blas)
    log::warn_once("the slow reference BLAS is in use, some 30 times slower: install libopenblas0-openmp");
  Networks networks;
  if (parts.extractor) networks.extractor = load_extractor(options, folder);
  if (parts.transfer) networks.transfer = load_transfer(options, folder);
  return networks;
}

std::unique_ptr<KeypointFinder> load_keypoints(const std::string& path, const std::string& method) {
  if (method == "slots") return load_slots(path);
  if (method == "paper") return load_paper_keypoints(path);
  throw Error("the networks plug-in does not know keypoints by " + method);
}

int train_network(const AnyTrainOptions& any) {
  return std::visit([](const auto& options) { return training::train(options); }, any);
}

}  // namespace
}  // namespace understudy::nn

const understudy::nn::PluginApi* understudy_networks_plugin() {
  using namespace understudy::nn;
  static const PluginApi api{kPluginVersion,  send_log_to, load,         load_inbetween_space,
                             load_step_coder, load_words,  load_judges,  load_keypoints,
                             load_dynamics,   report,      train_network};
  return &api;
}
