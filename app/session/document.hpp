// The open document: what is saved, undone and redone. Plain data; paths absolute in memory, relative in the
// file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/run/source.hpp"
#include "app/run/target_file.hpp"
#include "retarget/editing/pose_edits.hpp"
#include "retarget/editing/scan_edits.hpp"
#include "retarget/editing/skeleton_edits.hpp"
#include "retarget/editing/target_edits.hpp"
#include "retarget/pipeline/retargeter.hpp"

namespace understudy::app {

/// How a take is made: the networks, and the switches of an ablation.
struct Method {
  std::string engine = "copy";      ///< motion transfer: "copy" or "paper"
  std::string extractor = "dense";  ///< skeleton extraction: "dense" or "paper"
  bool offsets = true;              ///< pose-corrective offsets
  bool repair_swaps = true, smooth_joints = true, fix_lengths = true;  ///< of JointFilterOptions
  bool lock_feet = true;                                               ///< feet that stand do not slide
  RootMode root = RootMode::Scaled;
};

/// What the user changed of a target.
struct TargetEdits {
  std::vector<JointMove> joints;
  std::shared_ptr<const WeightRows>
      weights;  ///< null: none; shared, so that a copy of a document costs nothing
};

/// One target that performs the source, in one way. Two takes of one target compare two methods.
struct Take {
  std::string name;  ///< shown; from the file's name
  TargetOptions target;
  Method method;
  TargetEdits target_edits;
  PoseEdits pose_edits;
};

struct Document {
  SourceOptions source;  ///< path empty: none yet
  std::string truth;     ///< truth.npz of a case; empty: none
  ScanEdits scan_edits;
  std::vector<SkeletonEdit> skeleton_edits;
  std::vector<Take> takes;
};

/// Whether both would give the same result and are saved as the same text.
bool same(const Document& a, const Document& b);
/// The same of its parts: what has to be done again after a change.
bool same(const SourceOptions& a, const SourceOptions& b);  ///< `quiet` is no matter
bool same(const ScanEdits& a, const ScanEdits& b);
bool same(const SkeletonEdit& a, const SkeletonEdit& b);
bool same(const std::vector<SkeletonEdit>& a, const std::vector<SkeletonEdit>& b);
bool same(const Take& a, const Take& b);
bool same(const TargetOptions& a, const TargetOptions& b);
bool same(const Method& a, const Method& b);
bool same(const TargetEdits& a, const TargetEdits& b);
bool same(const PoseEdits& a, const PoseEdits& b);

}  // namespace understudy::app
