#include "retarget/training/style_clips.hpp"

#include <algorithm>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/style/motion_words.hpp"

namespace understudy::training {
namespace fs = std::filesystem;
namespace {

constexpr int kFewestFrames = 10;  // of a run; what is missing of a word repeats the last one

std::vector<std::string> all_clips(const std::string& folder) {
  std::error_code failed;
  US_CHECK(fs::is_directory(folder, failed), folder, ": there is no such folder of clips");
  std::vector<std::string> files;
  for (const auto& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::follow_directory_symlink))
    if (file_suffix(entry.path().string()) == ".npz") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// AMASS's own clips have z up.
void turn_upright(Motion& motion) {
  const Vec3 up = motion.poses.front().local[Pelvis].col(1);
  if (std::abs(up.z()) <= std::abs(up.y())) return;
  const Mat3 turn = rotation_from_axis_angle(Vec3(-kPi / 2, 0, 0));
  for (Pose& pose : motion.poses) pose.local[Pelvis] = turn * pose.local[Pelvis];
}

StyleClip style_clip(const std::string& path, double smooth_frames) {
  StyleClip made{path, {}};
  std::vector<Clip> clip = {read_clip(path)};
  Motion& motion = clip[0].motion;
  if (motion.poses.empty()) return made;
  turn_upright(motion);
  for (const ClipRun& run : good_runs(clip, kFewestFrames, 1 << 30)) {
    std::vector<Rotations> local;
    for (int t = run.first; t < run.first + run.count; ++t)
      local.push_back(motion.poses[static_cast<size_t>(t)].local);
    made.runs.push_back(at_word_rate(local, static_cast<double>(motion.fps), smooth_frames));
  }
  return made;
}

}  // namespace

int each_style_clip(const std::string& folder, double smooth_frames,
                    const std::function<void(const StyleClip&)>& visit) {
  int clips = 0;
  for (const std::string& path : all_clips(folder)) {
    const StyleClip clip = style_clip(path, smooth_frames);
    if (clip.runs.empty()) continue;
    visit(clip);
    ++clips;
  }
  US_CHECK(clips > 0, folder, ": holds no clip (.npz, AMASS-format) with a good frame");
  return clips;
}

}  // namespace understudy::training
