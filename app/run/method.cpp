#include "app/run/method.hpp"

namespace understudy::app {

RetargetOptions retarget_options(const Method& method) {
  RetargetOptions options;
  options.filter.repair_swaps = method.repair_swaps;
  options.filter.smooth = method.smooth_joints;
  options.filter.fix_lengths = method.fix_lengths;
  options.root.mode = method.path;
  options.lock_feet = method.lock_feet;
  options.keep_contacts = method.hand_contacts;
  options.root.stride = method.stride;
  options.root.hip_height_m = method.hip_height;
  options.arm_reach = method.arm_reach;
  options.predict = method.predict;
  return options;
}

std::string extraction_key(const Method& method) {
  return method.extractor + (method.part_refiner ? ", from near" : "");
}

std::string networks_key(const Method& method) {
  return key_of(method.engine, method.extractor, method.part_refiner, method.offsets);
}

}  // namespace understudy::app
