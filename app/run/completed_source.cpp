#include "app/run/completed_source.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/marker_places.hpp"
#include "retarget/formats/markers.hpp"
#include "retarget/formats/scan_times.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/motion_space/person_fitter.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy::app {
namespace {

constexpr Eigen::Index kFewestCompleted = 10, kMostKept = 4000;  // points of a scan
constexpr double kSameTime_s = 0.005;     // between markers and the scan that they go with
constexpr float kFloorAtMost_m = 0.2f;    // that soles are from what the scans took for the floor
constexpr float kLeastConfidence = 0.1f;  // of made frames: doubt is told, and the frame is shown

Points kept_points(const Mesh& scan) {
  Points all = finite_points(scan.vertices);
  if (all.rows() <= kMostKept) return all;
  Points kept(kMostKept, 3);
  for (Eigen::Index i = 0; i < kMostKept; ++i) kept.row(i) = all.row(i * all.rows() / kMostKept);
  return kept;
}

/// When the first scan was taken, as markers count time.
double first_time(const SourceOptions& options) {
  if (options.times.empty()) return 0;
  double first = 1e300;
  for (const ScanTime& time : read_scan_times(options.times)) first = std::min(first, time.seconds);
  return first;
}

class CompletedScans final : public Source {
 public:
  CompletedScans(std::unique_ptr<Source> scans, const SourceOptions& options)
      : Source(options.complete), scans_(std::move(scans)), options_(options) {
    if (options.made) set_made(options.made);
    if (!options.markers.empty()) markers_ = known_markers(options.markers, scans_->fps());
  }

  void set_look(const std::function<Extraction(const Mesh&)>& look) override { scans_->set_look(look); }
  void set_tools(const SourceTools& tools) override { tools_ = tools; }
  std::shared_ptr<const MadeCapture> made() const override { return made_; }
  std::optional<int64_t> count() const override {
    const int64_t scans = scans_->count().value_or(0);
    if (scans <= 1) return scans;
    return static_cast<int64_t>(std::floor(static_cast<double>(scans - 1) / scans_->fps() * fps() + 1e-6)) +
           1;
  }
  void seek(int64_t frame) override {
    US_CHECK(frame >= 0 && frame < *count(), "there is no frame ", frame, " in a motion of ", *count());
    at_ = frame;
  }
  std::optional<SourceFrame> next() override {
    if (at_ >= *count()) return std::nullopt;
    if (!made_) complete();
    SourceFrame frame = frame_at(at_);
    frame.number = at_++;
    return frame;
  }

 private:
  void complete() {
    US_CHECK(tools_.extractor, options_.path, ": nothing is here that completes scans (--complete)");
    SparseCapture capture = read_scans();
    add_markers(capture);
    US_CHECK(ssize(capture.frames) >= 2, options_.path, ": shows ", ssize(capture.frames),
             ssize(capture.frames) == 1 ? " scan" : " scans",
             " of ten points or more; two at least can be completed");
    capture.fps = fps();
    PersonFitter fitter(tools_.extractor(), tools_.space ? tools_.space() : nullptr);
    const auto tell = [this](float share) {
      check_interrupt("while " + options_.path + " was completed");
      if (tools_.progress) tools_.progress(share);
    };
    auto made = std::make_shared<MadeCapture>();
    const std::string problem = failure_of([&] { made->capture = fitter.complete(capture, tell); });
    check_interrupt("while " + options_.path + " was completed");
    US_CHECK(problem.empty(), options_.path, ": ", problem);
    made->first = static_cast<int64_t>(std::lround(capture.frames.front().seconds * fps()));
    stand_on_floor(*made);
    const std::vector<bool>& is_made = made->capture.is_made;
    made->sentence = scans_->decision();
    append_item(made->sentence,
                printed("%zu scans completed to %g frames/s, %td of %zu frames are made (looks both ways)",
                        capture.frames.size(), fps(), std::count(is_made.begin(), is_made.end(), true),
                        is_made.size()));
    if (!options_.quiet) log::info(options_.path + ": " + made->sentence);
    set_made(std::move(made));
  }
  void set_made(std::shared_ptr<const MadeCapture> made) {
    made_ = std::move(made);
    set_decision(made_->sentence, made_->to_file);
  }

  SparseCapture read_scans() {
    SparseCapture capture;
    int few = 0;
    for (int64_t i = 0; auto scan = scans_->next(); ++i) {
      check_interrupt("while " + options_.path + " was read");
      if (!scan->usable) continue;
      if (!options_.edits.empty()) scan->mesh = understudy::apply(options_.edits, scan->mesh);
      SparseFrame frame;
      frame.seconds = static_cast<double>(i) / scans_->fps();
      frame.points = kept_points(scan->mesh);
      if (frame.points.rows() >= kFewestCompleted)
        capture.frames.push_back(std::move(frame));
      else
        ++few;
    }
    if (few > 0)
      log::warn(options_.path + ": " + std::to_string(few) + (few == 1 ? " scan has" : " scans have") +
                " fewer than ten points and are left out");
    return capture;
  }

  /// Those of one time with a scan go with it, others are frames of their own, no more than are wanted.
  void add_markers(SparseCapture& capture) {
    if (markers_.empty() || capture.frames.empty()) return;
    const Eigen::Matrix4f m = scans_->to_file().inverse().cast<float>();
    const double begin = first_time(options_), near = std::min(0.5 / scans_->fps(), kSameTime_s);
    const double first = capture.frames.front().seconds, last = capture.frames.back().seconds;
    std::vector<SparseFrame> alone;
    int64_t outside = 0;
    for (const MarkerFrame& seen : markers_) {
      const double seconds = seen.seconds - begin;
      if (seconds < first - near || seconds > last + near) {
        ++outside;
        continue;
      }
      const auto after =
          std::lower_bound(capture.frames.begin(), capture.frames.end(), seconds - near,
                           [](const SparseFrame& frame, double s) { return frame.seconds < s; });
      const bool has_scan =
          after != capture.frames.end() && after->seconds <= seconds + near && after->markers.empty();
      if (!has_scan && !alone.empty() && seconds - alone.back().seconds < 1 / fps()) continue;
      SparseFrame& to = has_scan ? *after : alone.emplace_back();
      if (!has_scan) to.seconds = seconds;
      for (const Marker& marker : seen.markers)
        to.markers.push_back(
            {marker.name, m.topLeftCorner<3, 3>() * marker.place + m.topRightCorner<3, 1>()});
    }
    US_CHECK(outside < ssize(markers_), options_.markers,
             ": none of its markers is from the time of the scans, ",
             printed("%.3g to %.3g s", begin + first, begin + last));
    if (outside > 0)
      log::warn(options_.markers + ": " + std::to_string(outside) +
                " of its times are before the first scan or after the last, and are left out");
    for (SparseFrame& frame : alone)
      if (ssize(frame.markers) >= 3) capture.frames.push_back(std::move(frame));
    std::stable_sort(capture.frames.begin(), capture.frames.end(),
                     [](const SparseFrame& a, const SparseFrame& b) { return a.seconds < b.seconds; });
    const auto same = [](const SparseFrame& a, const SparseFrame& b) { return b.seconds - a.seconds < 1e-3; };
    capture.frames.erase(std::unique(capture.frames.begin(), capture.frames.end(), same),
                         capture.frames.end());
  }

  /// Few points seldom show the soles; the body does.
  void stand_on_floor(MadeCapture& made) const {
    std::vector<double> lowest;
    for (const Pose& pose : made.capture.motion.poses)
      lowest.push_back(static_cast<double>(surface(made.capture, pose).col(1).minCoeff()));
    const auto low = static_cast<float>(percentile(lowest, 10));
    made.to_file = scans_->to_file();
    if (options_.import.floor || std::abs(low) > kFloorAtMost_m) return;
    for (Pose& pose : made.capture.motion.poses) pose.root.y() -= low;
    Eigen::Matrix4d up = Eigen::Matrix4d::Identity();
    up(1, 3) = static_cast<double>(low);
    made.to_file = made.to_file * up;
  }

  static Points surface(const CompletedCapture& made, const Pose& pose) {
    return linear_blend_skinning(made.vertices, made.weights, made.rest, forward_kinematics(made.rest, pose));
  }

  SourceFrame frame_at(int64_t frame) const {
    const CompletedCapture& made = made_->capture;
    SourceFrame out;
    const int64_t t = frame - made_->first;
    if (t < 0 || t >= ssize(made.motion.poses)) {
      out.usable = false;
      out.problem = options_.path + ": no scan that can be used is before and after it";
      return out;
    }
    const PosedSkeleton posed = forward_kinematics(made.rest, made.motion.poses[t]);
    out.mesh.vertices = linear_blend_skinning(made.vertices, made.weights, made.rest, posed);
    out.mesh.faces = made.faces;
    out.skeleton = exact_extraction(posed);
    out.skeleton->confidence.setConstant(std::max(kLeastConfidence, confidence_for(made.doubt_m[t])));
    out.doubt_m = made_->doubt_of(frame);
    return out;
  }

  std::unique_ptr<Source> scans_;
  SourceOptions options_;
  std::vector<MarkerFrame> markers_;
  SourceTools tools_;
  std::shared_ptr<const MadeCapture> made_;
  int64_t at_ = 0;  // the next frame
};

}  // namespace

float MadeCapture::doubt_of(int64_t frame) const {
  const int64_t t = frame - first;
  return t >= 0 && t < ssize(capture.is_made) && capture.is_made[t] ? capture.doubt_m[t] : 0;
}

std::vector<MarkerFrame> known_markers(const std::string& path, double fps) {
  std::vector<MarkerFrame> frames = read_markers(path, fps);
  std::string names;
  for (const MarkerPlace& place : kMarkerPlaces) append_item(names, place.name);
  for (const MarkerFrame& frame : frames)
    for (const Marker& marker : frame.markers)
      US_CHECK(marker_named(marker.name) >= 0, path, ": there is no place for a marker '",
               excerpt(marker.name), "', only for ", names);
  return frames;
}

std::unique_ptr<Source> complete_scans(std::unique_ptr<Source> scans, const SourceOptions& options) {
  return std::make_unique<CompletedScans>(std::move(scans), options);
}

}  // namespace understudy::app
