// The functions that the networks plug-in offers to the program.
#pragma once

#include "retarget/base/log.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/networks/train_options.hpp"
#include "retarget/style/motion_words.hpp"

namespace understudy::nn {

constexpr int kPluginVersion = 18;

struct PluginApi {
  int version;
  /// Messages of the plug-in's own copy of the log go to this function of the program from now on.
  void (*send_log_to)(void (*sink)(log::Level, const std::string&));
  Networks (*load)(const NetworkOptions& options, const std::string& folder, const NetworkParts& parts);
  std::unique_ptr<MotionSpace> (*load_motion_space)(const std::string& path);
  std::unique_ptr<MotionCoder> (*load_motion_coder)(const std::string& path);
  std::unique_ptr<WordTranslator> (*load_words)(const std::string& path);
  std::unique_ptr<StyleJudge> (*load_style_judge)(const std::string& path);
  std::unique_ptr<KeypointFinder> (*load_keypoints)(const std::string& path, const std::string& method);
  std::unique_ptr<MotionDynamics> (*load_dynamics)(const std::string& path);
  RuntimeReport (*report)();
  int (*train)(const AnyTrainOptions& options);
};

}  // namespace understudy::nn

/// The plug-in's one exported name.
extern "C" const understudy::nn::PluginApi* understudy_networks_plugin();
