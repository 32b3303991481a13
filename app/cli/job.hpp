// One retargeting job: frames from a source onto a target, online, into files.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/cli/latency.hpp"
#include "app/cli/source.hpp"
#include "retarget/nn/networks.hpp"
#include "retarget/pipeline/retargeter.hpp"

namespace understudy::app {

struct TargetOptions {
  std::string path;
  std::vector<float> betas;  ///< of an SMPL-format body
  ImportOptions import;      ///< up is y unless told otherwise
};

struct JobOptions {
  SourceOptions source;
  TargetOptions target;
  nn::NetworkOptions networks;
  RetargetOptions retarget;
  std::string out;              ///< .glb, .gltf or .npz; empty: none
  std::string report;           ///< .json; empty: none
  std::string preview;          ///< .png; empty: none
  std::string skeletons;        ///< .png of up to 60 frames with the extracted skeleton in each; empty: none
  bool progress_lines = false;  ///< new lines of progress even on a terminal: another job writes there too
};

/// The target as the retargeter wants it: metres, y up. Says what it decided. Throws Error naming the file.
Mesh import_target(const TargetOptions& options);

/// A frame that has been read and performed.
struct PerformedFrame {
  ScanFrame scan;  ///< metres, y up
  RetargetedFrame result;
  Joints source_joints;  ///< of the source, repaired and smoothed; of the last good frame where flagged
  FrameTimes times;
};

/// Reads and performs one frame after the other, and takes their times.
class Performer {
 public:
  Performer(Source& source, const Mesh& target, Networks networks, const RetargetOptions& options = {});
  /// None at the end of the source.
  std::optional<PerformedFrame> next();
  /// The same with the skeleton of the source known beforehand.
  std::optional<PerformedFrame> next(const Joints& oracle);
  const Retargeter& retargeter() const { return retargeter_; }

 private:
  std::optional<PerformedFrame> next(const Extraction* oracle);

  Source& source_;
  Retargeter retargeter_;
  Joints last_seen_ = Joints::Zero();
};

/// Does the job and tells how it goes. Files appear whole at the end, or not at all. Throws Error.
void run_job(const JobOptions& options);

}  // namespace understudy::app
