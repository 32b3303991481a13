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
  float stride = 1, hip_height = 0, arm_reach = 0;  ///< of the target, see kProportions
};

/// A setting of the target's proportions, by the same name in documents, commands and options.
struct Proportion {
  const char* name;
  float Method::*value;
  Within<float> range;
  const char *label, *explanation;  ///< on the screen and in help, without a full stop
  const char* format;               ///< of the number on the screen
};
constexpr Proportion kProportions[] = {
    {"stride",
     &Method::stride,
     {0.25f, 3},
     "Stride",
     "How long the steps and a scaled path are: 1 as the leg lengths give, 2 twice as long",
     "\u00d7 %.2f"},
    {"hip_height",
     &Method::hip_height,
     {-0.5f, 0.5f},
     "Hip height",
     "Metres by which the pelvis is raised, as far as the legs reach; below 0 lowered; the feet stay in "
     "place",
     "%.3f m"},
    {"arm_reach",
     &Method::arm_reach,
     {0, 1},
     "Arm reach",
     "0: arms turn as the source's do; 1: hands reach where the source's do, in arm lengths from the chest",
     "%.2f"}};

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
  for (const Proportion& one : kProportions) visit(one.name, method.*one.value, one.range);
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
/// The same for methods of the same networks: what else differs needs none to be bound again.
std::string networks_key(const Method& method);

}  // namespace understudy::app
