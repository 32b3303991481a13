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

namespace understudy {
namespace {

constexpr int kAsked = 256;           // steps whose neighbours tell how far neighbours are
constexpr float kLeastShare = 0.02f;  // of a step in a blend

std::vector<int16_t> figure_of(const TimedPoses& movement, const Joints& rest) {
  std::vector<int16_t> figure;
  figure.reserve(kFigureMoments * kJointCount * 3);
  for (int k = 0; k < kFigureMoments; ++k) {
    const float share = static_cast<float>(k) / (kFigureMoments - 1);
    const Joints joints = forward_kinematics(rest, pose_at(movement, share * movement.duration())).joints;
    for (Eigen::Index i = 0; i < joints.size(); ++i)
      figure.push_back(static_cast<int16_t>(std::lround(std::clamp(1000 * joints.data()[i], -32e3f, 32e3f))));
  }
  return figure;
}

Joints moment_of(const MappedStep& step, int k) {
  // Before the first and after the last it goes on as it did there.
  if (k < 0) return 2 * moment_of(step, 0) - moment_of(step, 1);
  if (k >= kFigureMoments)
    return 2 * moment_of(step, kFigureMoments - 1) - moment_of(step, kFigureMoments - 2);
  const auto* const values = step.figure.data() + k * kJointCount * 3;
  return Eigen::Map<const Eigen::Matrix<int16_t, kJointCount, 3, Eigen::RowMajor>>(values).cast<float>() /
         1000;
}

}  // namespace

std::vector<MappedStep> coded_steps(const Motion& motion, const Joints& rest, MotionCoder& coder, int first,
                                    int last) {
  std::vector<MappedStep> steps;
  for (const Step& found : find_steps(motion)) {
    if (found.first < first || found.last > last) continue;
    const TimedPoses movement = movement_of(motion, found.first, found.last);
    MappedStep step;
    step.first = found.first, step.last = found.last, step.left_first = found.left_first;
    step.seconds = movement.duration();
    const Vec3 way = movement.poses.back().root - movement.poses.front().root;
    step.speed_m_s = std::hypot(way.x(), way.z()) / step.seconds;
    step.code = coder.encode(movement, rest).mean;
    step.figure = figure_of(movement, rest);
    steps.push_back(std::move(step));
  }
  return steps;
}

Joints figure_at(const MappedStep& step, float seconds, bool in_place) {
  const float turn = step.seconds > 0 ? seconds / step.seconds : 0;
  const float at = (turn - std::floor(turn)) * (kFigureMoments - 1);
  const int k = std::min(static_cast<int>(at), kFigureMoments - 2);
  const float t = at - static_cast<float>(k);
  const Joints a = moment_of(step, k - 1), b = moment_of(step, k), c = moment_of(step, k + 1),
               d = moment_of(step, k + 2);
  // Catmull and Rom's curve through b and c.
  Joints joints = b + 0.5f * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
  if (in_place) {
    const Eigen::RowVector3f pelvis = joints.row(Pelvis);
    joints.rowwise() -= Eigen::RowVector3f(pelvis.x(), 0, pelvis.z());
  }
  return joints;
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

/// Principal components; of both directions of an axis that one whose largest part is positive.
void MotionMap::find_axes() {
  mean_ = codes_.cast<double>().colwise().mean().cast<float>();
  const Eigen::MatrixXd centred = (codes_.rowwise() - mean_).cast<double>();
  const Eigen::MatrixXd covariance = centred.transpose() * centred / std::max(1, size() - 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Eigen::Index d = codes_.cols();
  axes_.setZero(d, 2);
  const double all = std::max(solver.eigenvalues().sum(), 1e-30);
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(2, d); ++k) {
    Eigen::VectorXd axis = solver.eigenvectors().col(d - 1 - k);
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0) axis = -axis;
    axes_.col(k) = axis.cast<float>();
    shares_[k] = static_cast<float>(std::max(0.0, solver.eigenvalues()[d - 1 - k]) / all);
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
