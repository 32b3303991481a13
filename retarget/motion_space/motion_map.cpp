#include "retarget/motion_space/motion_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kAsked = 256;  // steps whose neighbours tell how far neighbours are
constexpr Eigen::Index kLongCode = 256;
constexpr float kLeastShare = 0.02f;  // of a step in a blend

constexpr int kBetween = 2;  // frames of motion_of() from one moment to the next
constexpr float kStretch_s = 2, kShortestStretch_s = 0.5f;
constexpr float kShortestMovement_s = 1;  // that is on the map beside steps
constexpr float kAngleUnit = 1e-4f, kLengthUnit = 1e-3f;

std::vector<int16_t> figure_of(const TimedPoses& movement) {
  std::vector<int16_t> figure;
  figure.reserve(kFigureNumbers);
  const auto put = [&figure](const Vec3& values, float unit) {
    for (const float value : values)
      figure.push_back(static_cast<int16_t>(std::lround(std::clamp(value / unit, -32e3f, 32e3f))));
  };
  for (int k = 0; k < kFigureMoments; ++k) {
    const float share = static_cast<float>(k) / (kFigureMoments - 1);
    const Pose pose = pose_at(movement, share * movement.duration());
    for (const Mat3& turn : pose.local) put(rotation_to_axis_angle(turn), kAngleUnit);
    put(pose.root, kLengthUnit);
  }
  return figure;
}

Pose moment_of(const MappedStep& step, int k) {
  const int16_t* at = step.figure.data() + k * (kJointCount + 1) * 3;
  const auto next = [&at](float unit) {
    const Vec3 values(at[0], at[1], at[2]);
    at += 3;
    return Vec3(unit * values);
  };
  Pose pose;
  for (Mat3& turn : pose.local) turn = rotation_from_axis_angle(next(kAngleUnit));
  pose.root = next(kLengthUnit);
  return pose;
}

MappedStep coded(const Motion& motion, const Joints& rest, MovementEncoder& coder, int first, int last) {
  const TimedPoses movement = movement_of(motion, first, last);
  MappedStep step;
  step.first = first, step.last = last;
  step.seconds = movement.duration();
  const Vec3 way = movement.poses.back().root - movement.poses.front().root;
  step.speed_m_s = std::hypot(way.x(), way.z()) / step.seconds;
  step.code = coder.encode(movement, rest).mean;
  step.figure = figure_of(movement);
  return step;
}

}  // namespace

std::vector<MappedStep> coded_steps(const Motion& motion, const Joints& rest, MovementEncoder& coder,
                                    int first, int last) {
  std::vector<MappedStep> steps;
  for (const Step& found : find_steps(motion)) {
    if (found.first < first || found.last > last) continue;
    steps.push_back(coded(motion, rest, coder, found.first, found.last));
    steps.back().left_first = found.left_first;
  }
  return steps;
}

std::vector<MappedStep> coded_stretches(const Motion& motion, const Joints& rest, MovementEncoder& encoder,
                                        int first, int last) {
  std::vector<MappedStep> stretches;
  const float seconds = static_cast<float>(last - first) / motion.fps;
  if (seconds < kShortestStretch_s) return stretches;
  const int count = std::max(1, static_cast<int>(std::lround(seconds / kStretch_s)));
  for (int i = 0; i < count; ++i) {
    const auto frame = [&](int k) {
      return first + static_cast<int>(static_cast<int64_t>(last - first) * k / count);
    };
    stretches.push_back(coded(motion, rest, encoder, frame(i), frame(i + 1)));
  }
  return stretches;
}

std::vector<MappedStep> coded_movements(const Motion& motion, const std::vector<MappedStep>& steps,
                                        const Joints& rest, MovementEncoder& encoder) {
  std::vector<char> taken(motion.poses.size(), 0);
  for (size_t t = 0; t < motion.flags.size(); ++t) taken[t] = motion.flags[t] != 0;
  for (const MappedStep& step : steps)
    std::fill(taken.begin() + step.first, taken.begin() + step.last + 1, 1);
  std::vector<MappedStep> movements;
  for (int first = 0, end = 0; first < ssize(taken); first = end) {
    while (end < ssize(taken) && taken[end] == taken[first]) ++end;
    if (taken[first] != 0 || static_cast<float>(end - 1 - first) < kShortestMovement_s * motion.fps) continue;
    for (MappedStep& one : coded_stretches(motion, rest, encoder, first, end - 1))
      movements.push_back(std::move(one));
  }
  return movements;
}

Motion motion_of(const MappedStep& step) {
  constexpr int kFrames = (kFigureMoments - 1) * kBetween + 1;
  Motion motion;
  motion.fps = static_cast<float>(kFrames - 1) / step.seconds;
  motion.poses.resize(kFrames);
  std::vector<KnownParts> known(kFrames, all_parts(false));
  for (int k = 0; k < kFigureMoments; ++k) {
    motion.poses[kBetween * k] = moment_of(step, k);
    known[kBetween * k] = all_parts(true);
  }
  fill_curves(known, 0, kFrames - 1, motion);
  return motion;
}

Joints figure_at(const MappedStep& step, const Joints& rest, float seconds, bool in_place) {
  const float turn = step.seconds > 0 ? seconds / step.seconds : 0;
  const float at = (turn - std::floor(turn)) * (kFigureMoments - 1);
  const int k = std::min(static_cast<int>(at), kFigureMoments - 2);
  Pose pose = pose_at({{moment_of(step, k), moment_of(step, k + 1)}, {0, 1}}, at - static_cast<float>(k));
  if (in_place) pose.root.x() = pose.root.z() = 0;
  return forward_kinematics(rest, pose).joints;
}

std::string action_of_name(const std::string& path) {
  const std::string stem = std::filesystem::path(path).stem().string();
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0 || c >= 0x80; };
  const auto last = std::find_if(stem.rbegin(), stem.rend(), is_letter);
  return last == stem.rend() ? stem : lower_case(stem.substr(0, stem.rend() - last));
}

std::string distance_words(float distance) {
  const bool far = distance > kFarFromKnown;
  return printed("%s%.1f times as far from the nearest step as neighbours are",
                 far ? "far from anything known: " : "", static_cast<double>(distance));
}

MotionMap::MotionMap(std::vector<MappedMotion> motions) : motions_(std::move(motions)) {
  for (int m = 0; m < ssize(motions_); ++m)
    for (int s = 0; s < ssize(motions_[m].steps); ++s) of_step_.push_back({m, s});
  if (size() == 0) return;
  codes_.resize(size(), ssize(step(0).code));
  for (int i = 0; i < size(); ++i) {
    const auto& code = step(i).code;
    US_CHECK(ssize(code) == codes_.cols(), motion_of(i).name, ": its steps have codes of ", code.size(),
             " numbers, others of ", codes_.cols());
    codes_.row(i) = Eigen::Map<const Eigen::RowVectorXf>(code.data(), codes_.cols());
    US_CHECK(codes_.row(i).allFinite(), motion_of(i).name, ": the code of a step is not finite");
  }
  squares_ = codes_.rowwise().squaredNorm();
  find_axes();
  find_unit();
}

/// Principal components; of both directions of an axis that one whose largest part is positive. Of long codes
/// (the plain coder's) those of some of the steps: what takes seconds else takes a tenth of one.
void MotionMap::find_axes() {
  mean_ = codes_.cast<double>().colwise().mean().cast<float>();
  const Eigen::Index d = codes_.cols(),
                     n = d > kLongCode ? std::min<Eigen::Index>(size(), kLongCode) : size();
  Eigen::MatrixXd centred(n, d);
  for (Eigen::Index i = 0; i < n; ++i) centred.row(i) = (codes_.row(i * size() / n) - mean_).cast<double>();
  const bool dual = n < d;  // both products have the same eigenvalues above 0
  const Eigen::MatrixXd product =
      dual ? Eigen::MatrixXd(centred * centred.transpose()) : Eigen::MatrixXd(centred.transpose() * centred);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(product);
  const Eigen::Index count = product.cols();
  axes_.setZero(d, 2);
  const double all = std::max(solver.eigenvalues().sum(), 1e-30);
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(2, count); ++k) {
    Eigen::VectorXd axis = solver.eigenvectors().col(count - 1 - k);
    if (dual) axis = (centred.transpose() * axis).normalized();
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0) axis = -axis;
    axes_.col(k) = axis.cast<float>();
    shares_[k] = static_cast<float>(std::max(0.0, solver.eigenvalues()[count - 1 - k]) / all);
  }
  places_ = (codes_.rowwise() - mean_) * axes_;
}

bool MotionMap::share_frames(int a, int b) const {
  return of_step_[a].motion == of_step_[b].motion && step(a).first <= step(b).last &&
         step(b).first <= step(a).last;
}

void MotionMap::find_unit() {
  const int asked = std::min(size(), kAsked);
  std::vector<float> distances;
  for (int q = 0; q < asked; ++q) {
    const int i = static_cast<int>(static_cast<int64_t>(q) * size() / asked);
    Eigen::VectorXf square = squares_ - 2 * (codes_ * codes_.row(i).transpose());
    for (int j = i; j >= 0 && of_step_[j].motion == of_step_[i].motion; --j)
      if (share_frames(i, j)) square[j] = INFINITY;
    for (int j = i + 1; j < size() && of_step_[j].motion == of_step_[i].motion; ++j)
      if (share_frames(i, j)) square[j] = INFINITY;
    Eigen::Index nearest = 0;
    square.minCoeff(&nearest);
    if (std::isfinite(square[nearest])) distances.push_back((codes_.row(nearest) - codes_.row(i)).norm());
  }
  if (distances.empty()) return;
  const auto middle = distances.begin() + ssize(distances) / 2;
  std::nth_element(distances.begin(), middle, distances.end());
  if (*middle > 0) unit_ = *middle;
}

MapPlace MotionMap::place_of(const std::vector<float>& code) const {
  US_CHECK(ssize(code) == codes_.cols(), "a code of ", code.size(), " numbers on a map of codes of ",
           codes_.cols());
  return ((Eigen::Map<const Eigen::RowVectorXf>(code.data(), codes_.cols()) - mean_) * axes_).transpose();
}

std::vector<NearStep> MotionMap::nearest(const std::vector<std::vector<float>>& codes, int count,
                                         const std::function<bool(int)>& skip) const {
  Eigen::VectorXf least = Eigen::VectorXf::Constant(size(), INFINITY);
  for (const std::vector<float>& code : codes) {
    US_CHECK(size() == 0 || ssize(code) == codes_.cols(), "a code of ", code.size(),
             " numbers on a map of codes of ", codes_.cols());
    if (size() == 0) break;
    const Eigen::Map<const Eigen::RowVectorXf> asked(code.data(), codes_.cols());
    least = least.cwiseMin((codes_.rowwise() - asked).rowwise().norm());
  }
  std::vector<NearStep> near;
  for (int i = 0; i < size(); ++i)
    if (std::isfinite(least[i]) && !(skip && skip(i))) near.push_back({i, least[i] / unit_});
  const auto end = near.begin() + std::min<int64_t>(std::max(0, count), ssize(near));
  std::partial_sort(near.begin(), end, near.end(), [](const NearStep& a, const NearStep& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.step < b.step;
  });
  near.erase(end, near.end());
  return near;
}

std::vector<int> MotionMap::around(const MapPlace& place) const {
  const Eigen::Matrix<float, Eigen::Dynamic, 2> ways = places_.rowwise() - place.transpose();
  Eigen::Index nearest = 0;
  ways.rowwise().squaredNorm().minCoeff(&nearest);
  const float ahead = std::atan2(ways(nearest, 1), ways(nearest, 0));
  std::array<int, 2> other = {-1, -1};
  std::array<float, 2> away = {INFINITY, INFINITY};
  for (int i = 0; i < size(); ++i) {
    float turn = std::atan2(ways(i, 1), ways(i, 0)) - ahead;
    turn -= 2 * kPi * std::floor(turn / (2 * kPi));
    const int third =
        static_cast<int>(std::floor((turn + kPi / 3) / (2 * kPi / 3)));  // 0 and 3: the nearest's
    if (third % 3 == 0 || ways.row(i).squaredNorm() >= away[third - 1]) continue;
    away[third - 1] = ways.row(i).squaredNorm();
    other[third - 1] = i;
  }
  if (away[1] < away[0]) std::swap(other[0], other[1]);
  std::vector<int> steps = {static_cast<int>(nearest)};
  for (const int one : other)
    if (one >= 0) steps.push_back(one);
  return steps;
}

MapBlend MotionMap::at(const MapPlace& place) const {
  US_CHECK(size() > 0, "there are no steps on the map");
  const float extent = (places_.colwise().maxCoeff() - places_.colwise().minCoeff()).norm();
  const float on_it = 1e-5f * (extent + 1e-6f);  // so near to a step that it is meant
  MapBlend blend;
  float sum = 0;
  for (const int one : around(place)) {
    const float away = (places_.row(one).transpose() - place).squaredNorm();
    const float weight = 1 / std::max(away, on_it * on_it);
    if (weight < kLeastShare * sum) break;
    blend.weights.emplace_back(one, weight);
    sum += weight;
  }
  Eigen::RowVectorXf code = Eigen::RowVectorXf::Zero(codes_.cols());
  for (auto& [one, weight] : blend.weights) {
    weight /= sum;
    code += weight * codes_.row(one);
  }
  blend.code.assign(code.data(), code.data() + code.size());
  blend.known = nearest({blend.code}, 1)[0];
  return blend;
}

namespace {

/// Groups of steps by a name; the many small ones share no colour.
MapColouring by_name(const MotionMap& map, const std::function<const std::string&(int)>& name) {
  std::map<std::string, int> counts;
  for (int i = 0; i < map.size(); ++i) ++counts[name(i)];
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  if (ssize(sorted) > kMapGroups) sorted.resize(kMapGroups);
  MapColouring colouring;
  std::map<std::string, int> number;
  for (const auto& [group, count] : sorted) {
    number[group] = static_cast<int>(colouring.groups.size());
    colouring.groups.push_back(group);
  }
  for (int i = 0; i < map.size(); ++i) {
    const auto found = number.find(name(i));
    colouring.group.push_back(found == number.end() ? -1 : found->second);
  }
  return colouring;
}

/// A scale that leaves out the few extremes which would squeeze the rest.
MapColouring by_value(const MotionMap& map, const std::string& unit, float MappedStep::*value) {
  MapColouring colouring;
  colouring.unit = unit;
  std::vector<float> sorted;
  sorted.reserve(static_cast<size_t>(map.size()));
  for (int i = 0; i < map.size(); ++i) sorted.push_back(map.step(i).*value);
  std::sort(sorted.begin(), sorted.end());
  if (!sorted.empty()) {
    const size_t edge = sorted.size() / 50;
    colouring.low = sorted[edge], colouring.high = sorted[sorted.size() - 1 - edge];
  }
  const float span = std::max(colouring.high - colouring.low, 1e-6f);
  for (int i = 0; i < map.size(); ++i)
    colouring.value.push_back(std::clamp((map.step(i).*value - colouring.low) / span, 0.0f, 1.0f));
  return colouring;
}

}  // namespace

MapColouring map_colouring(const MotionMap& map, MapColour by) {
  if (by == MapColour::Speed) return by_value(map, "m/s", &MappedStep::speed_m_s);
  if (by == MapColour::Duration) return by_value(map, "s", &MappedStep::seconds);
  if (by == MapColour::File)
    return by_name(map, [&](int i) -> const std::string& { return map.motion_of(i).name; });
  return by_name(map, [&](int i) -> const std::string& { return map.motion_of(i).action; });
}

}  // namespace understudy
