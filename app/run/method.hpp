// How a motion is brought to a target: the networks, and the switches of an ablation.
#pragma once

#include <string>

#include "retarget/base/fields.hpp"
#include "retarget/pipeline/motion_style.hpp"
#include "retarget/pipeline/performer.hpp"

namespace understudy::app {

struct Method {
  std::string engine = "copy";      ///< motion transfer, see engines()
  std::string extractor = "dense";  ///< skeleton extraction, see extractors()
  bool part_refiner = true;         ///< with "dense": limbs and head are refined on part crops
  bool offsets = true;              ///< pose-corrective offsets
  bool repair_swaps = true, smooth_joints = true, fix_lengths = true;  ///< of JointFilterOptions
  bool lock_feet = true;                                               ///< standing feet do not slide
  bool hand_contacts = true;                                           ///< hand contacts are kept
  RootMode path = RootMode::Scaled;                                    ///< across the floor
  float stride = 1, hip_height = 0, arm_reach = 0;                     ///< of the target, see kProportions
  bool predict = false;  ///< frames that cannot be used go on from those before, for half a second
  StyleChoice style{};   ///< how it is performed
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
     "Length of the steps and of a scaled path: 1 follows the leg lengths, 2 doubles it",
     "\u00d7 %.2f"},
    {"hip_height",
     &Method::hip_height,
     {-0.5f, 0.5f},
     "Hip height",
     "Raises the pelvis by this many metres, as far as the legs reach; negative values lower it. The feet "
     "stay in place",
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
  visit(MemberName("part_refiner", "near"), method.part_refiner);
  visit("offsets", method.offsets);
  visit("repair_swaps", method.repair_swaps);
  visit("smooth_joints", method.smooth_joints);
  visit("fix_lengths", method.fix_lengths);
  visit("lock_feet", method.lock_feet);
  visit(MemberName("hand_contacts", "keep_contacts"), method.hand_contacts);
  visit(MemberName("path", "root"), method.path, kRootNames);
  for (const Proportion& one : kProportions) visit(one.name, method.*one.value, one.range);
  visit("predict", method.predict);
  visit("style", method.style);
}

/// What the other settings do, on the screen.
constexpr const char* kOffsetsExplanation =
    "Corrects the skin by millimetres where joints bend, so that elbows and knees keep their shape";
constexpr const char* kPredictExplanation =
    "Frames that cannot be used go on as those before went, for half a second, instead of repeating the "
    "last; "
    "they stay marked";
constexpr const char* kPathExplanation = "How far the target walks for each metre that the source walks";

/// What can be switched off, by the same name in documents, commands and options ("--no-repair-swaps").
struct MethodSwitch {
  const char* name;
  bool Method::*on;
  const char *label, *explanation;  ///< on the screen
  const char *old_word, *old_name;  ///< what older commands and older options called it
};
constexpr MethodSwitch kSwitches[] = {
    {"repair_swaps", &Method::repair_swaps, "Repair swaps",
     "Corrects limbs whose left and right were swapped", "swaps", "swap_repair"},
    {"smooth_joints", &Method::smooth_joints, "Smooth joints", "Smooths noise in the extracted joints",
     "smooth", "smoothing"},
    {"fix_lengths", &Method::fix_lengths, "Fix lengths", "Keeps bones at one length", "lengths",
     "fixed_lengths"},
    {"lock_feet", &Method::lock_feet, "Lock feet", "Keeps standing feet from sliding", "feet", "foot_lock"},
    {"hand_contacts", &Method::hand_contacts, "Hand contacts",
     "Hands that touch the body do so on the target, too", "contacts", "hand_contacts"},
    {"part_refiner", &Method::part_refiner, "Part refiner",
     "Refines limbs and head from close crops of the scan", "near", "near"}};

/// The options of the pipeline, networks apart.
RetargetOptions retarget_options(const Method& method);

/// The same text for methods that extract the same skeletons from a scan.
std::string extraction_key(const Method& method);
/// The same for methods of the same networks: what else differs needs none to be bound again.
std::string networks_key(const Method& method);

}  // namespace understudy::app
