// The open document: what is saved, undone and redone. Plain data; paths absolute in memory, relative in the
// file.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/bone_search.hpp"
#include "app/run/method.hpp"
#include "app/run/motion_generator.hpp"
#include "app/run/source.hpp"
#include "app/run/target_file.hpp"
#include "app/session/flat_document.hpp"
#include "retarget/base/fields.hpp"
#include "retarget/discovery/bone_matching.hpp"
#include "retarget/editing/pose_edits.hpp"
#include "retarget/editing/scan_edits.hpp"
#include "retarget/editing/skeleton_edits.hpp"
#include "retarget/editing/target_edits.hpp"
#include "retarget/pose2d/face_marks.hpp"
#include "retarget/rig/rig_edits.hpp"

namespace understudy::app {

/// What the user changed of a target.
struct TargetEdits {
  std::vector<JointMove> joints;
  /// null: none; shared, so that a copy of a document costs nothing
  std::shared_ptr<const WeightRows> weights;
  std::vector<BoneTurn> rest_pose;  ///< how it stands where the source is in T-pose
  std::vector<FaceMove> face{};     ///< of pose pictures; one a mark
};
template <class V, class S>
FieldsOf<S, TargetEdits> fields(V& visit, S& edits) {
  visit("joints", edits.joints);
  visit("weights", edits.weights);
  visit("rest_pose", edits.rest_pose);
  visit("face", edits.face);
}

/// One target that performs the source, in one way. Two takes of one target compare two methods.
struct Take {
  std::string name;    ///< shown; from the file's name
  std::string person;  ///< who of the scans is performed, a number; empty: who the source's person is
  TargetOptions target;
  Method method;
  TargetEdits target_edits;
  PoseEdits pose_edits;
  std::optional<FlatTake> flat{};  ///< its target is a person in a picture; none: a character
};
template <class V, class S>
FieldsOf<S, Take> fields(V& visit, S& take) {
  visit("name", take.name);
  visit("person", take.person);
  visit("target", take.target);
  visit("method", take.method);
  visit("target_edits", take.target_edits);
  visit("pose_edits", take.pose_edits);
  visit("flat", take.flat);
}

/// Another body of the kind that performs what was found, as a recipe.
struct SecondBody {
  std::string path;  ///< a rig that was found before, one scan, or a folder of scans; empty: there is none
  std::vector<ChosenMatch> matches;  ///< put over those that are found
  std::string clip{};                ///< the kept one that it performs; empty: what was found
};
template <class V, class S>
FieldsOf<S, SecondBody> fields(V& visit, S& second) {
  visit("path", second.path, FilePath{});
  visit("matches", second.matches);
  visit("clip", second.clip);
}

/// A further motion of what was found, as a recipe: the same is made again.
struct MadeClip {
  std::string name;       ///< in the rig's file, where the found motion is kFoundClip
  GenerationOptions how;  ///< one motion, between frames of the source
};
template <class V, class S>
FieldsOf<S, MadeClip> fields(V& visit, S& clip) {
  visit("name", clip.name);
  visit("how", clip.how);
}
constexpr const char* kFoundClip = "motion";

/// The skeleton of its own that is found in the source's scans, as a recipe: the same is found again.
struct OwnBones {
  bool wanted = false;
  BoneSearch search;
  std::vector<RigEdit> edits;  ///< of what is found, one after the other
  SecondBody second{};
  std::vector<MadeClip> clips{};  ///< that were kept of those made
};
template <class V, class S>
FieldsOf<S, OwnBones> fields(V& visit, S& bones) {
  visit("wanted", bones.wanted);
  fields(visit, bones.search);
  visit("edits", bones.edits);
  visit("second", bones.second);
  visit("clips", bones.clips);
}

struct Document {
  SourceOptions source;  ///< path empty: none yet
  std::string truth;     ///< truth.npz of a case; empty: none
  ScanEdits scan_edits;
  std::vector<SkeletonEdit> skeleton_edits;
  std::optional<FlatSource> flat{};  ///< the source is 2D poses; none: it is not
  OwnBones bones;
  std::vector<Take> takes;
};
template <class V, class S>
FieldsOf<S, Document> fields(V& visit, S& document) {
  visit("source", document.source);
  visit("truth", document.truth, FilePath{});
  visit("scan_edits", document.scan_edits);
  visit("skeleton_edits", document.skeleton_edits);
  visit("flat", document.flat);
  visit("bones", document.bones);
  visit("takes", document.takes);
}

/// All that the document reads; some may be empty.
inline std::vector<std::string> files_read_by(const Document& document) {
  std::vector<std::string> files = {document.source.path,  document.source.motion,
                                    document.source.times, document.source.markers,
                                    document.truth,        document.bones.second.path};
  if (document.source.blend)
    for (const BlendPart& part : document.source.blend->parts) files.push_back(part.path);
  for (const Take& take : document.takes) {
    files.push_back(take.target.path);
    files.push_back(take.method.style.file);
  }
  return files;
}

/// Who of the scans is performed by a take, as SourceOptions::person.
inline const std::string& person_of(const Document& document, const Take& take) {
  return take.person.empty() ? document.source.person : take.person;
}
/// Whether that is somebody else than the source's own person.
inline bool performs_another(const Document& document, const Take& take) {
  return person_of(document, take) != document.source.person;
}
/// Whether any take is by a character: a source of 2D poses is lifted for it.
inline bool performs_in_space(const Document& document) {
  return std::any_of(document.takes.begin(), document.takes.end(),
                     [](const Take& take) { return !take.flat; });
}
/// The first take of the source's own person by a character, by which the source's skeletons are repaired and
/// smoothed; as many as there are takes: none.
inline size_t take_of_source(const Document& document) {
  const auto found = std::find_if(document.takes.begin(), document.takes.end(), [&](const Take& take) {
    return !take.flat && !performs_another(document, take);
  });
  return static_cast<size_t>(found - document.takes.begin());
}

}  // namespace understudy::app
