#include "app/run/keypoint_source.hpp"

#include <utility>
#include <vector>

#include "app/run/animated_source.hpp"
#include "app/run/flat_performance.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/keypoints/keypoint_filter.hpp"

namespace understudy::app {
namespace {

FlatSourceOptions flat_options(const SourceOptions& options) {
  FlatSourceOptions flat;
  flat.path = options.path;
  flat.fps = options.fps;
  flat.layout = options.layout;
  flat.person = options.person;
  if (!options.canvas.empty()) flat.canvas = parse_canvas(options.canvas);
  return flat;
}

/// With points dragged and sides exchanged as the options have it.
std::vector<CleanPose> clean_poses(const KeypointReading& reading, const SourceOptions& options) {
  KeypointFilterOptions filter;
  filter.smoothing = options.smoothing;
  std::vector<CleanPose> poses = clean_track(reading, reading.performer, filter);
  edit_track(options.point_edits, poses);
  return poses;
}

class KeypointSource final : public AnimatedSource {
 public:
  KeypointSource(const KeypointReading& reading, const SourceOptions& options)
      : AnimatedSource(reading.fps, ssize(reading.frames)),
        name_(options.path),
        poses_(clean_poses(reading, options)) {
    view_.canvas = reading.canvas;
    view_.stature_m = static_cast<float>(options.stature);
    view_.fov_deg = static_cast<float>(options.fov);
    if (options.pitch) view_.pitch_deg = static_cast<float>(*options.pitch);
    for (int64_t frame = 0; frame < ssize(reading.frames); ++frame)
      numbers_.push_back(reading.seconds(frame));
    std::string told;
    const std::string whose = name_ + ": ";
    for (const std::string& sentence : reading.told)
      append_item(told, sentence.rfind(whose, 0) == 0 ? sentence.substr(whose.size()) : sentence, "; ");
    append_item(told,
                printed("lifted for a person of %g m before a camera of %g degrees that looks down %s",
                        options.stature, options.fov,
                        options.pitch ? printed("by %g", *options.pitch).c_str() : "as far as they tell"),
                "; ");
    set_decision(told, Eigen::Matrix4d::Identity());
    if (!options.quiet) log::info(name_ + ": " + told);
  }
  void set_tools(const SourceTools& tools) override { make_lifter_ = tools.lifter; }

 private:
  SourceFrame frame_at(int64_t frame) override {
    while (ssize(lifted_) <= frame) lift_next();
    const std::optional<Extraction>& skeleton = lifted_[static_cast<size_t>(frame)];
    SourceFrame out;
    out.path = name_;
    out.skeleton = skeleton;
    out.usable = skeleton.has_value();
    if (skeleton)
      out.mesh = bone_shapes(skeleton->joints);
    else
      out.problem = problems_[static_cast<size_t>(frame)];
    return out;
  }

  /// Frames are lifted in their order, once.
  void lift_next() {
    if (!lifter_) {
      US_CHECK(make_lifter_, name_, ": 2D poses are performed in space by a network that is not there");
      lifter_ = make_lifter_();
      lifter_->reset(view_);
    }
    const size_t frame = lifted_.size();
    check_interrupt("before frame " + std::to_string(frame));
    const CleanPose& pose = poses_[frame];
    std::optional<Extraction> skeleton;
    std::string problem = pose.problem;
    if (pose.is_usable) {
      const double since = lifted_.empty() ? 1 / fps() : numbers_[frame] - last_s_;
      problem = failure_of([&] { skeleton = lifter_->push(pose.pose, static_cast<float>(since)); });
      if (skeleton) last_s_ = numbers_[frame];
    }
    lifted_.push_back(std::move(skeleton));
    problems_.push_back(std::move(problem));
  }

  std::string name_;
  LiftView view_;
  std::vector<CleanPose> poses_;
  std::vector<double> numbers_;  // seconds of each frame
  std::function<std::unique_ptr<Lifter>()> make_lifter_;
  std::unique_ptr<Lifter> lifter_;
  std::vector<std::optional<Extraction>> lifted_;  // of the frames so far; none: not usable
  std::vector<std::string> problems_;
  double last_s_ = 0;  // when somebody was lifted last
};

}  // namespace

bool is_keypoint_source(const SourceOptions& options) {
  return options.motion.empty() && !options.blend && looks_like_keypoints(options.path);
}

void check_keypoint_options(const SourceOptions& options) {
  const auto refuse = [&](bool wanted, const char* what) {
    US_CHECK(!wanted, options.path, ": is 2D poses, ", what);
  };
  refuse(!options.edits.empty(), "only scans are cleaned (--remove-floor, --largest-part, --crop)");
  refuse(!options.bones.empty(), "they have no bones that a map (--source-map) could name");
  refuse(!options.clip.empty(), "they have no animations to choose from (--clip)");
  refuse(!options.betas.empty(), "only an SMPL-format body that performs a --motion takes --source-betas");
  refuse(options.as_scan, "they have no surface to sample as a scan (--as-scan)");
  refuse(options.follow, "only a folder of scans can be followed (--follow)");
  refuse(!options.times.empty(), "a table of times (--times) is for scans");
  refuse(options.complete > 0 || !options.markers.empty(),
         "only scans are completed (--complete, --markers)");
  refuse(options.person == "all", "one person of them is performed (--person)");
}

void check_no_picture(const SourceOptions& options) {
  US_CHECK(options.layout.empty(), options.path, ": an order of points (--layout) is for 2D poses");
  US_CHECK(options.stature == static_cast<double>(kUsualStature_m) &&
               options.fov == static_cast<double>(kUsualFov_deg) && !options.pitch,
           options.path, ": a stature and a camera (--stature, --fov, --pitch) are for 2D poses");
}

std::unique_ptr<Source> open_keypoint_source(const SourceOptions& options) {
  return std::make_unique<KeypointSource>(open_keypoints(flat_options(options)), options);
}

}  // namespace understudy::app
