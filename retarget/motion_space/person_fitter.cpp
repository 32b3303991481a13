#include "retarget/motion_space/person_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/marker_places.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/plain_space.hpp"
#include "retarget/motion_space/sparse_looks.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {
namespace {

constexpr int kFitPoints = 700;  // of a scan that are looked at
constexpr int kFewestPoints = 10, kFewestMarkers = 3, kSeenPoints = 32;
constexpr double kLongestPause_s = 3600;
constexpr double kLookEvery_s = 0.06;  // frames nearer than that to one that was extracted are not
constexpr int kNearRounds = 3;
constexpr int kManyLooks = 150;           // of the extractor, in all
constexpr Eigen::Index kSparse = 250;     // points of a scan below which one way to fill it is not enough
constexpr Eigen::Index kVerySparse = 80;  // below which starts are chosen again, once all was fitted

std::string where(const SparseCapture& capture, int frame) {
  return "frame " + std::to_string(frame) + " of " + std::to_string(ssize(capture.frames));
}

void check_capture(const SparseCapture& capture) {
  US_CHECK(capture.fps > 0 && capture.fps <= 1000, "a motion of ", capture.fps, " frames/s cannot be made");
  US_CHECK(ssize(capture.frames) >= 2,
           "one frame alone cannot be completed: a motion is between two at least");
  for (int t = 0; t < ssize(capture.frames); ++t) {
    const SparseFrame& frame = capture.frames[t];
    US_CHECK(std::isfinite(frame.seconds), where(capture, t), ": its time is not finite");
    if (t > 0) {
      const double since = frame.seconds - capture.frames[t - 1].seconds;
      US_CHECK(since > 0, where(capture, t), ": is not after the frame before it");
      US_CHECK(since < kLongestPause_s, where(capture, t), ": is an hour or more after the frame before it");
    }
    for (const Marker& marker : frame.markers) {
      US_CHECK(marker_named(marker.name) >= 0, where(capture, t), ": there is no marker '", marker.name, "'");
      US_CHECK(marker.place.allFinite(), where(capture, t), ": marker ", marker.name, " is nowhere");
    }
    const Eigen::Index points = finite_count(frame.points);
    US_CHECK(points >= kFewestPoints || !frame.markers.empty(), where(capture, t), ": has ", points,
             " points and no markers; ten points are the fewest");
    US_CHECK(points >= kFewestPoints || ssize(frame.markers) >= kFewestMarkers, where(capture, t), ": has ",
             ssize(frame.markers), " markers and ", points, " points; three markers are the fewest");
  }
}

Points thinned(const Points& points, int count) {
  if (points.rows() <= count) return points;
  Points kept(count, 3);
  for (int i = 0; i < count; ++i) kept.row(i) = points.row(i * points.rows() / count);
  return kept;
}

std::vector<Evidence> evidence_of(const SparseCapture& capture) {
  std::vector<Evidence> all;
  for (const SparseFrame& frame : capture.frames) {
    Evidence& one = all.emplace_back();
    one.seconds = frame.seconds;
    one.points = thinned(finite_points(frame.points), kFitPoints);
    one.filled = filled_between(one.points, kFitPoints, 0);
    for (const Marker& marker : frame.markers)
      one.markers.push_back({marker_named(marker.name), marker.place});
  }
  return all;
}

/// Extracted rotations err more the fewer points there are, as extracted joints do.
float turn_error_for(const Extraction& seen) {
  return std::clamp(6 * expected_error_for(seen.confidence.mean()), 0.12f, 1.5f);
}

/// The pose that what was extracted shows.
Pose pose_of(const Extraction& seen) {
  Pose pose;
  if (seen.global) pose.local = local_rotations(*seen.global);
  pose.root = seen.joints.row(Pelvis).transpose();
  return pose;
}

/// The usual pose, laid on the markers.
std::optional<Pose> pose_of(const std::vector<Evidence::Marked>& markers, const Joints& rest) {
  if (ssize(markers) < kFewestMarkers) return std::nullopt;
  Pose pose = usual_pose();
  const MarkerPoints usual = marker_points(rest, pose);
  Points is(ssize(markers), 3), wanted(ssize(markers), 3);
  for (Eigen::Index i = 0; i < is.rows(); ++i) {
    is.row(i) = usual.row(markers[i].marker);
    wanted.row(i) = markers[i].place.transpose();
  }
  const Vec3 middle = is.colwise().mean(), wanted_middle = wanted.colwise().mean();
  const Mat3 turn = kabsch(is.rowwise() - middle.transpose(), wanted.rowwise() - wanted_middle.transpose(),
                           Eigen::VectorXf::Ones(is.rows()));
  pose.local[Pelvis] = turn * pose.local[Pelvis];
  pose.root = wanted_middle + turn * (pose.root - middle);
  return pose;
}

/// Frames that something may begin with: those that are far enough apart in time, the first and the last.
std::vector<int> looked_at(const std::vector<Evidence>& frames, bool extracts) {
  std::vector<int> chosen;
  double last = -1e9;
  for (int t = 0; t < ssize(frames); ++t) {
    if (!(extracts && frames[t].points.rows() >= kSeenPoints) && ssize(frames[t].markers) < kFewestMarkers)
      continue;
    if (frames[t].seconds - last < kLookEvery_s && t + 1 < ssize(frames)) continue;
    chosen.push_back(t);
    last = frames[t].seconds;
  }
  return chosen;
}

/// Medians over what was extracted, the believed counting more, sides alike.
Joints bones_of(const std::vector<std::vector<Extraction>>& seen, const Joints& usual) {
  Eigen::Array<float, kJointCount, 1> lengths = bone_lengths(usual);
  for (int j = 1; j < kJointCount; ++j) {
    std::vector<std::pair<float, float>> found;  // length, weight
    float total = 0;
    for (const std::vector<Extraction>& frame : seen)
      for (const Extraction& one : frame)
        for (const int side : {j, kMirror[j]}) {
          const float error = std::max(0.01f, expected_error_for(one.confidence[side]));
          found.emplace_back((one.joints.row(side) - one.joints.row(kParents[side])).norm(),
                             1 / (error * error));
          total += found.back().second;
        }
    std::sort(found.begin(), found.end());
    float sum = 0;
    for (const auto& [length, weight] : found)
      if ((sum += weight) >= total / 2) {
        lengths[j] = length;
        break;
      }
  }
  return rest_with_lengths(usual, lengths);
}

/// The shape whose joints come nearest to these.
Eigen::VectorXf shape_for(const PersonModel& model, const Joints& rest) {
  constexpr float kJoint_m = 0.02f;
  const int count = model.parameters();
  Eigen::MatrixXf slopes(3 * kJointCount, count);
  for (int s = 0; s < count; ++s)
    slopes.col(s) = Eigen::Map<const Eigen::VectorXf>(model.joint_dirs[s].data(), 3 * kJointCount) / kJoint_m;
  const Joints off = rest - model.whole.joints;
  Eigen::MatrixXf H = slopes.transpose() * slopes;
  for (int s = 0; s < count; ++s) H(s, s) += 1 / (model.spread[s] * model.spread[s]);
  return H.ldlt().solve(slopes.transpose() * Eigen::Map<const Eigen::VectorXf>(off.data(), off.size()) /
                        kJoint_m);
}

FitRound far_round() {
  FitRound round;
  round.steps = 6;
  round.reach = 0.15f;
  round.surface_m = 0.03f;
  round.cover = 0.3f;
  round.seen = 0.5f;
  return round;
}
FitRound near_round() {
  FitRound round;
  round.steps = 4;
  round.reach = 0.06f;
  round.surface_m = 0.015f;
  round.seen = 0.25f;
  round.swell = true;
  return round;
}

/// A pose that a frame may begin with.
struct Start {
  Pose pose;
  float misfit = 0;
  int seen = -1;  // which look it is from; -1: none
};

/// Sides of limbs exchanged, or all turned about: what few points hardly tell from the pose itself.
std::vector<Pose> look_alikes(const Pose& pose) {
  const Pose mirror = mirrored(pose);
  std::vector<Pose> alike;
  const auto with = [&](std::initializer_list<int> joints) {
    Pose& other = alike.emplace_back(pose);
    for (const int j : joints) other.local[j] = mirror.local[j];
  };
  with({LeftHip, RightHip, LeftKnee, RightKnee, LeftAnkle, RightAnkle});
  with({LeftCollar, RightCollar, LeftShoulder, RightShoulder, LeftElbow, RightElbow});
  alike.push_back(alike[0]);
  for (const int j : {LeftCollar, RightCollar, LeftShoulder, RightShoulder, LeftElbow, RightElbow})
    alike.back().local[j] = mirror.local[j];
  alike.push_back(alike.back());
  alike.back().local[Pelvis] = rotation_about_y(kPi) * pose.local[Pelvis];
  return alike;
}

/// The usual pose where the frame's points or markers are.
Pose standing_at(const Evidence& frame) {
  Pose pose = usual_pose();
  if (frame.points.rows() > 0) pose.root = frame.points.colwise().mean().transpose();
  return pose;
}

class Starts {
 public:
  Starts(const std::vector<int>& looked, const std::vector<std::vector<Extraction>>& seen, CaptureFit& fit)
      : looked_(looked), seen_(seen), fit_(fit), starts_(looked.size()) {}

  /// Again once all frames were fitted: the body is known better then, and so are the frames beside each.
  void choose(const std::function<void(float)>& tell) {
    for (std::vector<Start>& of_frame : starts_) of_frame.clear();
    for (size_t i = 0; i < looked_.size(); ++i) {
      tell(static_cast<float>(i) / static_cast<float>(looked_.size()));
      for (int k = 0; k < ssize(seen_[i]); ++k) add(i, pose_of(seen_[i][k]), k);
      if (const auto pose = pose_of(frame(i).markers, fit_.rest())) add(i, *pose, -1);
      if (is_sparse(i)) add_guesses(i);
      if (starts_[i].empty()) add(i, standing_at(frame(i)), -1);
      if (is_sparse(i)) {
        keep(i, 2);
        const std::vector<Start> best = starts_[i];
        for (const Start& one : best)
          for (const Pose& pose : look_alikes(one.pose)) add(i, pose, -1);
      }
      keep(i, kKept);
    }
    const std::vector<std::vector<Start>> own = starts_;
    for (size_t i = 0; i < looked_.size(); ++i)
      for (const size_t from : {i - 1, i + 1})
        if (is_sparse(i) && from < looked_.size() && !own[from].empty()) borrow(i, from, own[from][0].pose);
    take_likeliest_path();
    is_fitted_ = true;
  }

  bool any_very_sparse() const {
    for (size_t i = 0; i < looked_.size(); ++i)
      if (is_sparse(i) && frame(i).points.rows() < kVerySparse) return true;
    return false;
  }

 private:
  static constexpr size_t kKept = 5, kManyKept = 100;
  const Evidence& frame(size_t i) const { return fit_.frames()[looked_[i]]; }
  bool is_sparse(size_t i) const { return frame(i).points.rows() < kSparse && frame(i).markers.empty(); }
  void add(size_t i, Pose pose, int seen) {
    const float misfit = fit_.run_alone(far_round(), looked_[i], pose);
    starts_[i].push_back({pose, misfit, seen});
  }
  /// The usual pose as the best look stands; once all was fitted what was fitted there, and between
  /// neighbours.
  void add_guesses(size_t i) {
    keep(i, kManyKept);
    const Pose from = is_fitted_ ? fit_.poses[looked_[i]] : starts_[i].empty() ? Pose() : starts_[i][0].pose;
    Pose usual = usual_pose();
    usual.local[Pelvis] = rotation_about_y(heading_of(from.local[Pelvis]));
    usual.root = from.root;
    if (is_fitted_ || !starts_[i].empty()) add(i, usual, -1);
    if (!is_fitted_) return;
    add(i, from, -1);
    if (i > 0 && i + 1 < looked_.size())
      add(i, between(fit_.poses[looked_[i - 1]], fit_.poses[looked_[i + 1]], 0.5f), -1);
  }
  void keep(size_t i, size_t count) {
    std::stable_sort(starts_[i].begin(), starts_[i].end(),
                     [](const Start& a, const Start& b) { return a.misfit < b.misfit; });
    if (starts_[i].size() > count) starts_[i].resize(count);
  }
  void borrow(size_t i, size_t from, Pose pose) {
    pose.root += (frame(i).points.colwise().mean() - frame(from).points.colwise().mean()).transpose();
    add(i, pose, -1);
  }
  /// Joints go at some speed.
  float travel(size_t i, const Start& before, const Start& after) const {
    constexpr float kSpeed = 1.5f, kShare = 0.3f;
    const auto since = static_cast<float>(frame(i).seconds - frame(i - 1).seconds);
    const Joints rest = fit_.rest();
    const Joints way =
        forward_kinematics(rest, after.pose).joints - forward_kinematics(rest, before.pose).joints;
    return kShare * 0.5f * way.squaredNorm() / (kSpeed * kSpeed * since * since + 0.01f);
  }
  void take_likeliest_path() {
    std::vector<std::vector<std::pair<float, int>>> best(starts_.size());  // cost, start before
    for (size_t i = 0; i < starts_.size(); ++i)
      for (const Start& one : starts_[i]) {
        std::pair<float, int> least = {i == 0 ? 0 : 1e30f, -1};
        for (int k = 0; i > 0 && k < ssize(starts_[i - 1]); ++k)
          least = std::min(least, {best[i - 1][k].first + travel(i, starts_[i - 1][k], one), k});
        best[i].emplace_back(least.first + one.misfit, least.second);
      }
    auto at =
        static_cast<int>(std::min_element(best.back().begin(), best.back().end()) - best.back().begin());
    for (size_t i = starts_.size(); i-- > 0;) {
      const Start& taken = starts_[i][at];
      fit_.poses[looked_[i]] = taken.pose;
      const Extraction* const seen = taken.seen < 0 ? nullptr : &seen_[i][taken.seen];
      fit_.believe(looked_[i], seen, seen ? turn_error_for(*seen) : 1);
      at = best[i][at].second;
    }
  }

  const std::vector<int>& looked_;
  const std::vector<std::vector<Extraction>>& seen_;
  CaptureFit& fit_;
  std::vector<std::vector<Start>> starts_;
  bool is_fitted_ = false;  // all frames were fitted once
};

/// Frames that were not looked at begin between those that were.
void spread_starts(const std::vector<int>& looked, const std::vector<Evidence>& frames, CaptureFit& fit) {
  for (int t = 0; t < ssize(frames); ++t) {
    const auto after = std::lower_bound(looked.begin(), looked.end(), t);
    if (after != looked.end() && *after == t) continue;
    if (after == looked.begin() || after == looked.end()) {
      fit.poses[t] = fit.poses[after == looked.end() ? looked.back() : looked.front()];
      continue;
    }
    const int a = *(after - 1), b = *after;
    const double share = (frames[t].seconds - frames[a].seconds) / (frames[b].seconds - frames[a].seconds);
    fit.poses[t] = between(fit.poses[a], fit.poses[b], static_cast<float>(share));
  }
}

/// The pose at a time between known ones: cubic Hermite curves over uneven times.
Pose pose_at(const std::vector<Evidence>& frames, const std::vector<Pose>& poses, double seconds) {
  const int last = ssize(poses) - 1;
  int b = 1;
  while (b < last && frames[b].seconds < seconds) ++b;
  const int a = b - 1;
  const auto time = [&](int t) { return static_cast<float>(frames[t].seconds - frames[a].seconds); };
  const float length = time(b), at = static_cast<float>(seconds - frames[a].seconds) / length;
  if (at <= 0) return poses[a];
  if (at >= 1) return poses[b];
  const float t2 = at * at, t3 = t2 * at;
  const auto curve = [&](const Vec3& end, const Vec3& before, const Vec3& after) {
    const Vec3 mean = end / length;
    Vec3 leaving = mean, coming = mean;
    if (a > 0) leaving = (length * before / -time(a - 1) + -time(a - 1) * mean) / (length - time(a - 1));
    if (b < last) {
      const float until = time(b + 1) - length;
      coming = (length * after / until + until * mean) / (length + until);
    }
    return Vec3((t3 - 2 * t2 + at) * length * leaving + (3 * t2 - 2 * t3) * end +
                (t3 - t2) * length * coming);
  };
  const auto step = [&](int part, int from, int to) {
    if (part == kJointCount) return Vec3(poses[to].root - poses[from].root);
    return rotation_to_axis_angle(poses[from].local[part].transpose() * poses[to].local[part]);
  };
  Pose pose = poses[a];
  for (int part = 0; part <= kJointCount; ++part) {
    const Vec3 before = a > 0 ? step(part, a - 1, a) : Vec3(Vec3::Zero()),
               after = b < last ? step(part, b, b + 1) : Vec3(Vec3::Zero());
    const Vec3 way = curve(step(part, a, b), before, after);
    if (part == kJointCount)
      pose.root += way;
    else
      pose.local[part] = poses[a].local[part] * rotation_from_axis_angle(way);
  }
  return pose;
}

/// What the extractor makes of the frames looked at; nothing of those with too few points.
std::vector<std::vector<Extraction>> seen_in(SkeletonExtractor* extractor, const SparseCapture& capture,
                                             const std::vector<int>& looked,
                                             const std::function<void(float)>& tell) {
  std::vector<std::vector<Extraction>> seen;
  const int many = std::clamp(kManyLooks / static_cast<int>(ssize(looked)), 2, 12);
  for (const int t : looked) {
    const Points points = finite_points(capture.frames[t].points);
    seen.emplace_back();
    if (extractor && points.rows() >= kSeenPoints)
      seen.back() = looks(*extractor, points, points.rows() >= kSparse ? 1 : many);
    tell(static_cast<float>(seen.size()) / static_cast<float>(looked.size()));
  }
  return seen;
}

/// The fitted poses on the frames that are wanted, and all between by the motion space.
void fill_frames(const SparseCapture& capture, const CaptureFit& fit, MotionSpace& space,
                 CompletedCapture& result) {
  const std::vector<Evidence>& frames = fit.frames();
  const std::vector<float> errors = fit.expected_errors(near_round());
  const double begin = frames.front().seconds, seconds = frames.back().seconds - begin;
  const auto count = static_cast<size_t>(std::floor(seconds * capture.fps + 1e-6)) + 1;
  KnownMotion question{{static_cast<float>(capture.fps), std::vector<Pose>(count), {}},
                       std::vector<KnownParts>(count, all_parts(false)),
                       result.rest};
  std::vector<float> own(count, -1);
  result.is_made.assign(count, true);
  for (int t = 0; t < ssize(frames); ++t) {
    const double at = (frames[t].seconds - begin) * capture.fps;
    const size_t i = std::min(count - 1, static_cast<size_t>(std::lround(at)));
    question.known[i] = all_parts(true);
    question.motion.poses[i] = pose_at(frames, fit.poses, begin + static_cast<double>(i) / capture.fps);
    result.is_made[i] = false;
    own[i] = errors[t];
  }
  Completion filled = space.complete(question);
  result.motion = std::move(filled.motion);
  result.doubt_m.resize(count);
  float last = 0;
  for (size_t i = 0; i < count; ++i) {
    if (own[i] >= 0) last = own[i];
    result.doubt_m[i] = std::hypot(last, filled.doubt_m[i]);
  }
}

}  // namespace

PersonFitter::PersonFitter(std::shared_ptr<SkeletonExtractor> extractor, std::shared_ptr<MotionSpace> between)
    : extractor_(std::move(extractor)), between_(between ? std::move(between) : make_hermite_space()) {}

CompletedCapture PersonFitter::complete(const SparseCapture& capture, const Progress& progress) {
  check_capture(capture);
  const auto tell = [&](float share) {
    if (progress) progress(share);
  };
  tell(0);
  const std::shared_ptr<const PersonModel> model = builtin_person_model();
  const std::vector<Evidence> frames = evidence_of(capture);
  const std::vector<int> looked = looked_at(frames, extractor_ != nullptr);
  US_CHECK(!looked.empty(), "no frame has the 32 points or 3 markers that the fit can begin with");
  tell(0.1f);
  const std::vector<std::vector<Extraction>> seen =
      seen_in(extractor_.get(), capture, looked, [&](float share) { tell(0.1f + 0.3f * share); });
  CaptureFit fit(model, frames);
  fit.shape = shape_for(*model, bones_of(seen, model->whole.joints));
  Starts starts(looked, seen, fit);
  starts.choose([&](float share) { tell(0.4f + 0.1f * share); });
  spread_starts(looked, frames, fit);
  fit.run(far_round());
  if (starts.any_very_sparse()) {
    starts.choose([&](float share) { tell(0.5f + 0.1f * share); });
    spread_starts(looked, frames, fit);
    fit.run(far_round());
  }
  for (int i = 0; i < kNearRounds; ++i) {
    tell(0.7f + 0.07f * static_cast<float>(i));
    fit.run(near_round());
  }
  CompletedCapture result;
  ShapedBody body = model->body(fit.shape, fit.swelling);
  result.rest = body.joints, result.vertices = std::move(body.vertices);
  result.faces = std::move(body.faces), result.weights = std::move(body.weights);
  fill_frames(capture, fit, *between_, result);
  tell(1);
  return result;
}

}  // namespace understudy
