#include "app/run/flat_cast.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy::app {

FlatCast::FlatCast(const SuiteOptions& options, float seconds)
    : split_(read_split(options.data, options.split)),
      body_(read_smpl_body(options.body.empty() ? split_.body : options.body)),
      head_(head_vertices(body_.shaped({}).vertices, body_.shaped({}).joints)) {
  US_CHECK(split_.betas.size() > 1, options.data, ": the split ", options.split,
           " has fewer than two people");
  for (const std::string& folder : split_.motion_folders)
    for (Clip& clip : read_clips(folder)) clips_.push_back(std::move(clip));
  float rate = 1;  // frames of the fastest clip a second
  for (const Clip& clip : clips_) rate = std::max(rate, static_cast<float>(clip.motion.fps));
  const auto shortest = static_cast<int>(rate * static_cast<float>(options.frames) / kFlatRate),
             least = static_cast<int>(rate * seconds);
  runs_ = good_runs(clips_, std::max(shortest, 1), std::max(shortest, least));
  US_CHECK(runs_.size() > 1, options.data, ": the split ", options.split, " has fewer than two long clips");
}

FlatPerson FlatCast::person(int row) const {
  const ShapedBody shaped = body_.shaped(betas(row));
  return flat_person(shaped.vertices, shaped.joints, head_);
}

std::vector<Pose> FlatCast::poses(int run, int count, float rate) const {
  const ClipRun& from = runs_[static_cast<size_t>(run)];
  const Motion& motion = clips_[static_cast<size_t>(from.clip)].motion;
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const int at =
        static_cast<int>(std::lround(static_cast<float>(i) * static_cast<float>(motion.fps) / rate));
    poses.push_back(motion.poses[static_cast<size_t>(from.first + std::min(at, from.count - 1))]);
  }
  return poses;
}

Vec3 middle_of(const std::vector<Pose>& poses) {
  Vec3 sum = Vec3::Zero();
  for (const Pose& pose : poses) sum += pose.root;
  return sum / static_cast<float>(poses.size());
}

}  // namespace understudy::app
