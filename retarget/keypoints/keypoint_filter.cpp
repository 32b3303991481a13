#include "retarget/keypoints/keypoint_filter.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/keypoints/exchanged_sides.hpp"
#include "retarget/keypoints/point_filter.hpp"
#include "retarget/keypoints/track_noise.hpp"

namespace understudy {
namespace {

constexpr int kFewestPoints = 3;       // fewer are no pose
constexpr int kOutliersBelieved = 3;   // frames in a row: then the point did jump
constexpr double kLongestStep = 3600;  // seconds: longer is as good as that

/// Where a hand or the face starts among all points of a person.
constexpr int kLeftHandAt = kBodyPoints, kRightHandAt = kLeftHandAt + kHandPoints,
              kFaceAt = kRightHandAt + kHandPoints, kAllPoints = kFaceAt + kFacePoints;

}  // namespace

struct KeypointFilter::State {
  std::array<PointFilter, kAllPoints> points;
  TrackNoise track;
  ExchangedSides sides;
  FlatPose last;
  double waiting = 0;  // seconds of frames that could not be used
  bool has_last = false;

  PointFilter::Noise noise(const KeypointFilterOptions& options) const {
    return {std::max(track.size(), 1.0f), options.smoothing * track.sigma(), unrest(), options.gap_s};
  }
  float unrest() const {
    float sum = 0;
    int alive = 0;
    for (size_t p = 0; p < kBodyPoints; ++p)
      if (points[p].is_alive()) sum += points[p].unrest(), ++alive;
    return alive > 0 ? sum / static_cast<float>(alive) : 0;
  }
  FlatPose expected(float dt) const {
    FlatPose pose;
    for (int p = 0; p < kBodyPoints; ++p)
      if (points[static_cast<size_t>(p)].is_alive())
        pose.set(p, points[static_cast<size_t>(p)].expected(dt), 1);
    return pose;
  }
  void forget_points() {
    for (PointFilter& point : points) point.reset();
    sides.reset();
    track.restart();
  }
  /// A cut, or another place at once: most of what is seen both times is far off.
  bool has_jumped(const FlatPose& pose, float dt, const PointFilter::Noise& noise) const {
    int common = 0, far = 0;
    for (int p = 0; p < kBodyPoints; ++p) {
      const PointFilter& point = points[static_cast<size_t>(p)];
      if (!pose.has(p) || !point.is_alive()) continue;
      ++common;
      far += point.is_outlier(pose.at(p), dt, noise);
    }
    return far >= kFewestPoints && 2 * far > common;
  }
  int step(Eigen::Ref<FlatPoints> rows, int first, float dt, const PointFilter::Noise& noise);
  void step_part(FlatPoints& rows, int first, int count, float dt, const PointFilter::Noise& noise);
};

/// Filters rows in place; how many were missing and carried on.
int KeypointFilter::State::step(Eigen::Ref<FlatPoints> rows, int first, float dt,
                                const PointFilter::Noise& noise) {
  int filled = 0;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    PointFilter& point = points[static_cast<size_t>(first + r)];
    const Vec2 seen = rows.row(r).head<2>();
    bool is_seen = rows(r, 2) > 0;
    if (is_seen && point.is_outlier(seen, dt, noise)) {
      if (point.outliers() + 1 >= kOutliersBelieved)
        point.reset();
      else
        point.count_outlier(), is_seen = false;
    }
    if (is_seen) {
      const Vec2 place = point.see(seen, rows(r, 2), dt, noise);
      rows.row(r).head<2>() = place;
    } else if (point.miss(dt, noise)) {
      rows.row(r) << point.place().x(), point.place().y(), point.confidence(noise);
      ++filled;
    } else {
      rows.row(r).setZero();
    }
  }
  return filled;
}

void KeypointFilter::State::step_part(FlatPoints& rows, int first, int count, float dt,
                                      const PointFilter::Noise& noise) {
  const auto begin = points.begin() + first;
  const bool was_there =
      std::any_of(begin, begin + count, [](const PointFilter& point) { return point.is_alive(); });
  if (rows.rows() == 0 && !was_there) return;
  if (rows.rows() == 0) rows = FlatPoints::Zero(count, 3);
  step(rows, first, dt, noise);
  if (rows.col(2).maxCoeff() <= 0) rows.resize(0, 3);
}

KeypointFilter::KeypointFilter(const KeypointFilterOptions& options)
    : options_(options), state_(std::make_unique<State>()) {
  US_CHECK(options.smoothing >= 0 && options.smoothing <= 10, "smoothing must be in 0..10, not ",
           options.smoothing);
  US_CHECK(options.gap_s >= 0 && options.gap_s <= 10, "gaps are filled for 0 to 10 seconds, not ",
           options.gap_s);
}
KeypointFilter::~KeypointFilter() = default;
KeypointFilter::KeypointFilter(KeypointFilter&&) noexcept = default;
KeypointFilter& KeypointFilter::operator=(KeypointFilter&&) noexcept = default;

void KeypointFilter::reset() {
  *state_ = State();
}

CleanPose KeypointFilter::push(const FlatPose* seen, double dt, const std::string& why) {
  US_CHECK(dt > 0, "the time between two frames must be above 0, not ", dt, " s");
  State& state = *state_;
  CleanPose out;
  state.waiting = std::min(state.waiting + dt, kLongestStep);
  if (!seen || points_seen(*seen) < kFewestPoints) {
    out.is_usable = false;
    out.pose = state.last;
    const int points = seen ? points_seen(*seen) : 0;
    out.problem = !why.empty() ? why
                  : points > 0 ? printed("only %d of 25 points are seen", points)
                               : "nobody is seen";
    return out;
  }
  const auto step = static_cast<float>(state.waiting);
  state.waiting = 0;
  if (step > std::max(options_.gap_s, 2 * static_cast<float>(dt))) state.forget_points();
  state.track.push(*seen, step);
  const PointFilter::Noise noise = state.noise(options_);
  out.pose = *seen;
  if (options_.mend_sides && state.has_last) {
    ExchangedSides::Mended mended = state.sides.mend(*seen, state.expected(step), noise.size, step);
    out.pose = std::move(mended.pose);
    out.sides_mended = mended.any;
    for (int p = 0; p < kBodyPoints; ++p)
      for (int group = 0; group < ExchangedSides::kGroups; ++group)
        if (mended.believed[static_cast<size_t>(group)] && ExchangedSides::is_in_group(p, group))
          state.points[static_cast<size_t>(p)].reset();
  } else if (options_.mend_sides) {
    ExchangedSides::Mended mended = state.sides.mend_first(*seen, noise.size);
    out.pose = std::move(mended.pose);
    out.sides_mended = mended.any;
  }
  if (state.has_jumped(out.pose, step, noise)) state.forget_points();
  FlatPoints rows = out.pose.body;
  out.points_filled = state.step(rows, 0, step, noise);
  out.pose.body = rows;
  state.step_part(out.pose.left_hand, kLeftHandAt, kHandPoints, step, noise);
  state.step_part(out.pose.right_hand, kRightHandAt, kHandPoints, step, noise);
  state.step_part(out.pose.face, kFaceAt, kFacePoints, step, noise);
  if (out.sides_mended) out.problem = "left and right were exchanged and are put back";
  state.last = out.pose;
  state.has_last = true;
  return out;
}

std::vector<CleanPose> clean_track(const KeypointReading& reading, int track,
                                   const KeypointFilterOptions& options) {
  US_CHECK(track >= 0 && track < static_cast<int>(reading.tracks.size()), reading.path,
           ": there is no track ", track);
  const KeypointTrack& person = reading.tracks[static_cast<size_t>(track)];
  KeypointFilter filter(options);
  std::vector<CleanPose> out;
  out.reserve(reading.frames.size());
  size_t next = 0;
  for (int64_t frame = 0; frame < static_cast<int64_t>(reading.frames.size()); ++frame) {
    const KeypointFrame& about = reading.frames[static_cast<size_t>(frame)];
    const bool is_there = next < person.poses.size() && person.poses[next].frame == frame;
    const double dt = frame > 0 ? reading.seconds(frame) - reading.seconds(frame - 1) : 1 / reading.fps;
    const std::string why = is_there ? ""
                            : !about.problem.empty()
                                ? about.problem
                                : "person " + std::to_string(person.person) + " is not seen in frame " +
                                      std::to_string(about.number);
    out.push_back(filter.push(is_there ? &person.poses[next].pose : nullptr, dt, why));
    next += is_there;
  }
  return out;
}

}  // namespace understudy
