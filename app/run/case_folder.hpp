// A test case on disk: a source, a target, perhaps the truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/gap_plan.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/keypoints/proportions.hpp"
#include "retarget/metrics/hand_contact.hpp"
#include "retarget/metrics/rig_truth.hpp"
#include "retarget/metrics/scene_score.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::app {

/// What a case of the suite style is about.
struct StyleCase {
  std::string is, wanted;             ///< the manner of the source, and the one that it is to be taken to
  std::vector<std::string> contents;  ///< what is done, in a word and in a sentence; may be empty
  std::string subject;                ///< who moves; empty: nobody knows
  bool real() const { return is == wanted; }  ///< nothing is to be done: it is what others are compared with
};

/// What is true of 2D poses: source, target and truth are files of them.
struct FlatCase {
  BoneLengths source_lengths, target_lengths;  ///< pixels
};

struct Case {
  std::string name;
  double fps = 30;
  std::string source;              ///< path; empty: no scans, only gaps in the truth's motion
  std::string times = {};          ///< path of when each scan was taken (scan_times.hpp); empty: evenly
  std::string markers = {};        ///< path (markers.hpp), frame 0 at 0 s; empty: none
  std::string target;              ///< path; empty: only the extraction is evaluated
  std::string truth;               ///< path; empty: none
  std::vector<std::string> alone;  ///< paths: each person of a scene, scanned alone by the same sensors
  std::vector<std::string> tags;
  std::optional<GapPlan> gaps = {};     ///< frames are to be made: these alone are evaluated
  std::optional<StyleCase> style = {};  ///< how it is performed is evaluated, on its own bones
  std::optional<FlatCase> flat = {};    ///< 2D poses are performed by another person
  bool lifted = false;                  ///< 2D poses are performed in space
  std::string rig =
      {};  ///< path of a rig and its motion, between whose frames others are to be made; empty: none
  /// Of two bodies of a kind, the second of which shall perform what the first did (`target` are its scans
  /// then): paths of its own truth, and of what it does under the first one's true angles; empty: none.
  std::string target_truth = {}, performed_truth = {};
};

/// Some points of a surface, as linear blend skinning moves them.
struct SkinSample {
  Points rest{0, 3};                  ///< [N, 3] in T-pose, metres; N = 0: none
  RowMatrix weights{0, kJointCount};  ///< [N, 22]
};

/// The ground truth of a case; parts may be missing (empty).
struct Truth {
  int64_t frames = 0;
  int64_t vertex_count = 0;
  std::vector<float> vertices;  ///< [T, V, 3]
  std::vector<Joints> joints, source_joints;
  std::vector<Rotations> rotations;  ///< local
  std::optional<Joints> target_joints;
  SkinSample skin{};                  ///< of the body that the rotations are of: for true poses and made ones
  std::vector<HandGaps> source_gaps;  ///< [T, 2, 5] metres: what the source's hands touch
  std::vector<float> source_buried;   ///< [T] share of the source's hands and forearms inside its own body
  std::vector<SeenJoints> source_seen;  ///< which of the source's joints the scan shows
  std::vector<TruePeople> scene;  ///< of scans with several people and things; there source_joints is empty
  std::optional<RigTruth> rig{};  ///< of a body that need not be a person; then there is nothing else
  /// The vertices of one frame, [V, 3].
  Points frame_vertices(int64_t t) const;
};

/// The folders in `cases` that hold a case.json, by name; `cases` itself when it is one. Throws Error when
/// there is none.
std::vector<std::string> case_folders(const std::string& cases);
/// Where case.json has "frames" and no gaps, and numbers below that are missing in the source's folder, those
/// that are there are the known frames of one window. Throws Error naming the file.
Case read_case(const std::string& folder);
/// Throws Error naming the file and the array whose shape does not fit.
Truth read_truth(const std::string& path);

}  // namespace understudy::app
