// The networks, for callers that do not link LibTorch: their code is a plug-in (libunderstudy_networks.so),
// loaded on first use. The program starts without LibTorch, and sets up OpenBLAS and OpenMP, which read their
// settings once, before they are loaded.
#pragma once

#include <string>
#include <vector>

#include "retarget/marionette/motion_dynamics.hpp"
#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/keypoint_finder.hpp"
#include "retarget/pipeline/keypoint_transfer.hpp"
#include "retarget/pipeline/lifter.hpp"
#include "retarget/pipeline/motion_coder.hpp"
#include "retarget/pipeline/motion_space.hpp"
#include "retarget/pipeline/motion_style.hpp"
#include "retarget/style/manner_file.hpp"
#include "retarget/style/style_judge.hpp"

namespace understudy::nn {

/// Sets what OpenBLAS and OpenMP read from the environment when they are loaded; what the user set stays, but
/// for more threads than any machine has. Call it first in main(): no other thread may run yet. Trainers
/// bring their own threads, each of which computes alone.
void prepare_environment(bool trains = false);

struct NetworkOptions {
  std::string weights;                      ///< folder of the weights; empty: the program's own
  std::string engine = "copy";              ///< one of engines()
  bool offsets = true;                      ///< pose-corrective offsets (paper 1, eq. 3) on or off
  bool near = true;                         ///< of "dense": refine limbs and head on crops of the scan
  std::string extractor = "dense";          ///< one of extractors()
  std::string engine_file, extractor_file;  ///< weights in place of the folder's; empty: the folder's
  StyleChoice style{};                      ///< how a motion is performed
};

/// The networks with trained weights, as many as asked for; which extractor has none for T-poses leaves that
/// one null. Throws Error when weights are missing or of another version.
Networks load_networks(const NetworkOptions& options, const NetworkParts& parts = NetworkParts::all());

/// What a style's file tells of itself, whatever its engine. Throws Error naming the file.
StyleNote style_note(const StyleChoice& style);

/// What fills gaps, with the weights in that folder: "space", or "paper" by load_motion_coder. Throws Error
/// for another name, and when they are missing or of another version.
std::unique_ptr<MotionSpace> load_motion_space(const std::string& folder, const std::string& name = "space");

/// What codes movements as points of a space, with the weights in that folder. Throws Error when they are
/// missing or of another version.
std::unique_ptr<MotionCoder> load_motion_coder(const std::string& folder);

/// The judges of style of a weights file. Throws Error naming it when it is missing, damaged, of another
/// network or of another version.
std::unique_ptr<StyleJudge> load_style_judge(const std::string& path);

/// What finds the keypoints of a kind of body, by one of rig_methods() that has weights, with those in that
/// folder. Throws Error for other methods, for a kind that there are none for, and naming the file when it is
/// damaged, of another network or of another version.
std::unique_ptr<KeypointFinder> load_keypoint_finder(const std::string& folder, const std::string& method,
                                                     const std::string& kind);

/// What reads lengths off 2D poses, with the weights in that folder (proportions.weights); it needs no
/// LibTorch. Throws Error naming the file when it is missing, damaged, of another network or of another
/// version.
std::unique_ptr<LengthReader> load_length_reader(const std::string& folder);

/// What makes one person's 2D poses another's. Weights are the folder's, or options.engine_file;
/// options.engine does not count. Throws Error for a name that is none of flat_engines(), and naming the file
/// when weights are missing, damaged, of another network or of another version.
std::unique_ptr<KeypointTransfer> load_keypoint_transfer(const NetworkOptions& options,
                                                         const FlatEngine& wanted);

/// What lifts 2D poses into space, with the weights in that folder (lifter.weights); it needs no LibTorch.
/// Throws Error as load_length_reader does.
std::unique_ptr<Lifter> load_lifter(const std::string& folder);

/// The dynamics of that rig's kind, begun with it. place: the folder with marionette_dynamics_KIND.weights,
/// or one such file. Throws Error when none is there, when the rig's bones are of none of their kinds, and
/// naming the file when it is damaged, of another network or of another version.
std::unique_ptr<MotionDynamics> load_motion_dynamics(const std::string& place, const Rig& rig);

/// The folder that weights are read from; empty when there is none.
std::string weights_folder(const NetworkOptions& options);

/// BLAS library and kernel, number of threads and the reason for it; `doctor` prints it.
struct RuntimeReport {
  std::string torch_version, blas, blas_core;
  int threads = 0;
  std::string threads_why;
  bool slow_blas = false;  ///< the reference BLAS, 30 times slower
};
RuntimeReport runtime_report();

}  // namespace understudy::nn
