#include "retarget/motion_space/motion_space_table.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/body/data_folder.hpp"
#include "retarget/motion_space/nearest_space.hpp"
#include "retarget/motion_space/plain_space.hpp"

namespace understudy {
namespace {

template <std::unique_ptr<MotionSpace> (*make)()>
std::unique_ptr<MotionSpace> made(const std::string&) {
  return make();
}

std::unique_ptr<MotionSpace> make_nearest_space(const std::string& data) {
  std::vector<Clip> clips;
  for (const std::string& folder : read_split(data, "train").motion_folders)
    for (Clip& clip : read_clips(folder)) clips.push_back(std::move(clip));
  return std::make_unique<NearestSpace>(std::move(clips));
}

}  // namespace

const std::vector<MotionSpaceChoice>& motion_spaces() {
  static const std::vector<MotionSpaceChoice> all = {
      {"hold", "Hold", "the last known pose stays", nullptr, false, made<make_hold_space>},
      {"glide", "Glide", "the last known pose stays, and the body goes on as fast as it went", nullptr, false,
       made<make_glide_space>},
      {"coast", "Coast", "the body and each joint go on as fast as they went", nullptr, false,
       made<make_coast_space>},
      {"slerp", "Slerp", "each joint takes the shortest turn to the next known pose, the body a straight way",
       nullptr, false, made<make_slerp_space>},
      {"hermite", "Hermite curves", "smooth curves that keep the speed of the known poses", nullptr, false,
       made<make_hermite_space>},
      {"nearest", "Nearest", "the most similar of known motions, bent to what is known", nullptr, true,
       make_nearest_space},
      {"paper", "Fitted steps", "steps that a network knows are fitted to the known frames and bent to them",
       "motion_steps.weights"},
      {"space", "Learned", "the motion space's network corrects the smooth curves", "motion_space.weights"}};
  return all;
}

const MotionSpaceChoice& motion_space_named(const std::string& name) {
  for (const MotionSpaceChoice& choice : motion_spaces())
    if (name == choice.name) return choice;
  throw Error("there is no way to fill frames '" + name + "': " + motion_space_names());
}

std::string motion_space_names() {
  std::string names;
  for (const MotionSpaceChoice& choice : motion_spaces()) append_item(names, choice.name);
  return names;
}

std::string motion_space_help() {
  std::string help;
  for (const MotionSpaceChoice& choice : motion_spaces())
    append_item(help, std::string(choice.name) + ": " + choice.sentence, "; ");
  return help;
}

std::unique_ptr<MotionSpace> make_motion_space(const std::string& name, const std::string& data) {
  const MotionSpaceChoice& choice = motion_space_named(name);
  US_CHECK(!choice.needs_clips || !data.empty(), "'", name,
           "' looks for like motions in a data folder: --data names it");
  US_CHECK(choice.make, "'", name, "' has a network, which is loaded from its weights");
  return choice.make(data);
}

}  // namespace understudy
