// How a motion is brought to a target: the networks, and the switches of an ablation.
#pragma once

#include <string>

#include "retarget/base/fields.hpp"
#include "retarget/pipeline/performer.hpp"

namespace understudy::app {

struct Method {
  std::string engine = "copy";      ///< motion transfer, see engines()
  std::string extractor = "dense";  ///< skeleton extraction, see extractors()
  bool near = true;                 ///< with "dense": limbs and head are refined on part crops
  bool offsets = true;              ///< pose-corrective offsets
  bool repair_swaps = true, smooth_joints = true, fix_lengths = true;  ///< of JointFilterOptions
  bool lock_feet = true;                                               ///< standing feet do not slide
  bool keep_contacts = true;                                           ///< hand contacts are kept
  RootMode root = RootMode::Scaled;
};
template <class V, class S>
FieldsOf<S, Method> fields(V& visit, S& method) {
  visit("engine", method.engine);
  visit("extractor", method.extractor);
  visit("near", method.near);
  visit("offsets", method.offsets);
  visit("repair_swaps", method.repair_swaps);
  visit("smooth_joints", method.smooth_joints);
  visit("fix_lengths", method.fix_lengths);
  visit("lock_feet", method.lock_feet);
  visit("keep_contacts", method.keep_contacts);
  visit("root", method.root, kRootNames);
}

/// What the other settings do, on the screen.
constexpr const char* kOffsetsExplanation =
    "Corrects the skin by millimetres where joints bend, so that elbows and knees keep their shape";
constexpr const char* kPathExplanation = "How far the target walks for each metre that the source walks";

/// What follows the extractor and can be switched off.
struct FilterSwitch {
  const char* name;  ///< in commands
  bool Method::*on;
  const char *label, *explanation;  ///< on the screen
};
constexpr FilterSwitch kFilterSwitches[] = {
    {"swaps", &Method::repair_swaps, "Repair swaps", "Corrects limbs whose left and right were swapped"},
    {"smooth", &Method::smooth_joints, "Smooth joints", "Smooths noise in the extracted joints"},
    {"lengths", &Method::fix_lengths, "Fix lengths", "Keeps bones at one length"},
    {"feet", &Method::lock_feet, "Lock feet", "Keeps standing feet from sliding"},
    {"contacts", &Method::keep_contacts, "Hand contacts",
     "Hands that touch the body do so on the target, too"},
    {"near", &Method::near, "Part refiner", "Refines limbs and head from close crops of the scan"}};

/// The options of the pipeline, networks apart.
RetargetOptions retarget_options(const Method& method);

/// The same text for methods that extract the same skeletons from a scan.
std::string extraction_key(const Method& method);

}  // namespace understudy::app
