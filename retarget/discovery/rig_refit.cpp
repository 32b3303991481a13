#include "retarget/discovery/rig_refit.hpp"

#include <algorithm>
#include <future>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/discovery/rig_figures.hpp"
#include "retarget/discovery/rig_follower.hpp"

namespace understudy {
namespace {

/// Fits the frames of one direction, one after the other: each from its own pose, and from where those before
/// it lead: a new joint is found from the frames in which it hardly bends.
class RefitWay {
 public:
  RefitWay(const RigFollower& follower, const DiscoveredRig& rig, size_t from)
      : follower_(follower),
        rig_(rig.found.rig),
        poses_(rig.found.motion.poses),
        places_(rig_.rest_joints()) {
    last_ = before_ = bone_motions(rig_, poses_[from]);
  }

  struct Frame {
    RigPose pose;
    std::optional<ScanDistances> distances{};  // none: not known
  };
  Frame fitted(size_t t, const Mesh& mesh) {
    std::optional<ThinnedFrame> scan;
    try {
      scan = RigFollower::seen(mesh);
    } catch (const Error&) {  // no points
      return {poses_[t]};
    }
    RigFollower::Followed best = follower_.fit(*scan, bone_motions(rig_, poses_[t])),
                          led = follower_.fit(*scan, led_on(before_, last_, places_));
    if (led.off_m() < best.off_m()) std::swap(best, led);
    before_ = std::exchange(last_, bone_motions(rig_, best.pose));
    return {std::move(best.pose), std::move(best.distances)};
  }

 private:
  const RigFollower& follower_;
  const Rig& rig_;
  const std::vector<RigPose>& poses_;
  Points places_;
  BoneMotions last_, before_;
};

Mesh scan_or_nothing(const ScanSequence& scans, int frame) {
  try {
    return scans.scan(frame);
  } catch (const Error&) {
    return {};
  }
}

/// From the rest frame, where a new joint does not bend, to both ends at once. [T], or nothing where it was
/// ended.
std::vector<RefitWay::Frame> refitted(const DiscoveredRig& rig, const ScanSequence& scans,
                                      const RigFollower& follower, const RefitProgress& progress) {
  const int count = static_cast<int>(rig.found.motion.poses.size());
  const int start = std::clamp(rig.rest_frame - rig.first_frame, 0, count - 1);
  std::vector<RefitWay::Frame> frames(static_cast<size_t>(count));
  RefitWay forwards(follower, rig, static_cast<size_t>(start)),
      backwards(follower, rig, static_cast<size_t>(start));
  const auto fit = [&](RefitWay& way, int t, const Mesh& scan) {
    frames[static_cast<size_t>(t)] = way.fitted(static_cast<size_t>(t), scan);
  };
  for (int ahead = start, behind = start - 1, done = 0; done < count; ++ahead, --behind) {
    const Mesh before = behind >= 0 ? scan_or_nothing(scans, behind + rig.first_frame) : Mesh{},
               after = ahead < count ? scan_or_nothing(scans, ahead + rig.first_frame) : Mesh{};
    std::future<void> other;
    if (behind >= 0) other = std::async(std::launch::async, [&] { fit(backwards, behind, before); });
    if (ahead < count) fit(forwards, ahead, after);
    if (other.valid()) other.get();
    done += (behind >= 0 ? 1 : 0) + (ahead < count ? 1 : 0);
    if (progress && !progress(static_cast<float>(done) / static_cast<float>(count))) return {};
  }
  return frames;
}

}  // namespace

bool refit(DiscoveredRig& rig, const ScanSequence& scans, const RefitProgress& progress) {
  RiggedMotion& found = rig.found;
  check_rig(found.rig);
  US_CHECK(!found.motion.poses.empty() && rig.first_frame >= 0 &&
               rig.first_frame + ssize(found.motion.poses) <= scans.count,
           "poses of ", found.motion.poses.size(), " frames from frame ", rig.first_frame,
           " on cannot be fitted to ", scans.count, " scans");
  const RigFollower follower(found.rig);
  const std::vector<RefitWay::Frame> frames = refitted(rig, scans, follower, progress);
  if (frames.empty()) return false;
  BoneDistances off(found.rig.count());
  rig.off_m.clear();
  for (size_t t = 0; t < frames.size(); ++t) {
    const RefitWay::Frame& frame = frames[t];
    found.motion.poses[t] = frame.pose;
    rig.off_m.push_back(frame.distances ? frame.distances->off.mean() : -1);
    if (frame.distances) off.add(follower.surface().skin, *frame.distances);
  }
  rig.doubted = doubted_frames(rig.off_m, box_diagonal(found.rig.surface.vertices));
  measure_motion(found, rig.bones);
  off.tell(rig.bones);
  return true;
}

std::vector<int> apply(DiscoveredRig& rig, const RigEdit& edit, const ScanSequence& scans,
                       const RefitProgress& progress) {
  if (std::holds_alternative<FitAgain>(edit)) {
    if (!refit(rig, scans, progress)) return {};
    std::vector<int> same(rig.found.rig.joints.size());
    std::iota(same.begin(), same.end(), 0);
    return same;
  }
  std::vector<int> numbers = apply(rig.found, edit);
  const std::vector<FoundBone> known = rig.bones;
  const auto count = rig.found.rig.joints.size();
  rig.bones.assign(count, {});
  for (size_t now = 0; now < count && known.size() == numbers.size(); ++now) {
    const auto was = std::find(numbers.begin(), numbers.end(), static_cast<int>(now));
    rig.bones[now] = was != numbers.end()
                         ? known[static_cast<size_t>(was - numbers.begin())]
                         : rig.bones[static_cast<size_t>(rig.found.rig.joints[now].parent)];  // a split's
  }
  measure_motion(rig.found, rig.bones);
  if (const auto* kept = std::get_if<KeepFrames>(&edit)) {
    rig.first_frame += kept->first;
    const auto trim = [kept](auto& frames) {
      if (ssize(frames) <= kept->last) return;
      frames.erase(frames.begin() + kept->last + 1, frames.end());
      frames.erase(frames.begin(), frames.begin() + kept->first);
    };
    trim(rig.off_m);
    trim(rig.doubted);
  }
  return numbers;
}

}  // namespace understudy
