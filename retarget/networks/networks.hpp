// The way to the networks without LibTorch: its code lives in a plug-in (libunderstudy_networks.so) that is
// loaded on first use. So the program starts without LibTorch, and OpenBLAS and OpenMP, which read their
// settings when they are loaded, get the right ones first.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

struct NetworkOptions {
  std::string weights;                      ///< folder of the weights; empty: the program's own
  std::string engine = "copy";              ///< motion transfer: "copy" or "paper"
  bool offsets = true;                      ///< pose-corrective offsets (paper 1, eq. 3) on or off
  bool near = true;                         ///< of "dense": limbs and head are looked at again from near
  std::string extractor = "dense";          ///< "dense" or "paper"
  std::string engine_file, extractor_file;  ///< weights in place of the folder's; empty: the folder's
};

/// The three networks with trained weights. Throws Error when weights are missing or of another version.
Networks load_networks(const NetworkOptions& options);
/// A deformer alone (weights and offsets), for oracle evaluations.
std::unique_ptr<Deformer> load_deformer(const NetworkOptions& options);

/// The folder of weights that would be used; empty when there is none.
std::string weights_folder(const NetworkOptions& options);

/// What the plug-in found: BLAS library and kernel, threads chosen and why. Lines for `doctor`.
struct RuntimeReport {
  std::string torch_version, blas, blas_core;
  int threads = 0;
  std::string threads_why;
  bool slow_blas = false;  ///< the reference BLAS, 30 times slower
};
RuntimeReport runtime_report();

/// `understudy train ...`: everything after `train`. Returns the exit code; throws Error.
struct TrainOptions {
  std::string network;    ///< "skeleton", "part", "motion" or "deformation"
  std::string data, out;  ///< the data folder, the weights file
  std::string curve;      ///< learning curve CSV; empty: out + ".csv"
  double minutes = 0;     ///< stop after this long; 0: no limit
  int64_t samples = 0;    ///< stop after this many in total; 0: no limit
  int threads = 0;        ///< 0: the network's own
  int batch = 0;          ///< 0: the network's own
  uint64_t seed = 1;
  std::string form = "dense";  ///< skeleton only: "dense" or "paper"
  std::string poses =
      "all";  ///< skeleton only: "all", or "rest": people in T-pose, for the joints of targets
  std::string rotation = "6d";      ///< motion only: what the network says of rotations, "6d" or "quaternion"
  bool rotation_loss = true;        ///< motion only: L_rot of paper 1, eq. 2
  int context = 0;                  ///< motion only: frames of a sequence; 0: the paper's 30
  std::string device = "cpu";       ///< "cpu" or "cuda"
  std::string init;                 ///< weights to start from
  double keep = 0;                  ///< share of those in what is written; skeleton and part only
  std::function<bool()> cancelled;  ///< asked between steps; the checkpoint is written before it stops
};
int train(const TrainOptions& options);

}  // namespace understudy::nn
