// What the studio gets from the program, with a window or without one.
#pragma once

#include <string>

#include "app/run/bone_search.hpp"
#include "app/session/studio.hpp"
#include "render/context/context.hpp"

namespace understudy::app {

/// The trained networks, loaded when a frame is first made, and the bundled samples. weights: their folder;
/// empty: beside the program.
StudioServices studio_services(const std::string& weights);
/// Loads what codes movements, with the weights in that folder.
std::function<std::shared_ptr<MotionCoder>()> coder_loader(const std::string& weights);
/// Loads what finds the keypoints of a kind of bodies, with the weights in that folder.
KeypointsLoader keypoints_loader(const std::string& weights);
/// By its name on the command line: any, egl, osmesa, null.
render::ContextKind context_kind(const std::string& name);

}  // namespace understudy::app
