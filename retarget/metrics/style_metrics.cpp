#include "retarget/metrics/style_metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "retarget/base/index.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/time_filter.hpp"
#include "retarget/skeleton/foot_contact.hpp"
#include "retarget/skeleton/stances.hpp"

namespace understudy {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr float kSmoothing_s = 0.05f;
constexpr double kShortestFlight_s = 0.15, kLongestFlight_s = 1.2;
constexpr float kOffFloor = 0.06f;  // legs that both feet are above where they stand in a flight
constexpr double kRepeats = 0.4;

JointSequence smoothed(const JointSequence& joints, double fps) {
  return filtered(joints, half_gaussian(kSmoothing_s / kSmoothestSeconds, static_cast<float>(fps)));
}

float leg_of(const JointSequence& joints) {
  std::vector<double> lengths;
  for (const Joints& one : joints) lengths.push_back(static_cast<double>(leg_length(one)));
  return static_cast<float>(percentile(lengths, 50));
}

/// Takes a direction of the world into the heading of the hips.
Mat3 heading_of_hips(const Joints& joints) {
  const Vec3 across = (joints.row(LeftHip) - joints.row(RightHip)).transpose();
  return rotation_about_y(std::atan2(-across.z(), across.x())).transpose();
}

template <class Number>
double mean(const std::vector<Number>& values) {
  if (values.empty()) return kUndefined;
  double sum = 0;
  for (const Number value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

/// -2 times the square's coefficient of the parabola nearest to `heights`, so far apart in time.
double parabola_pull(const std::vector<double>& heights, double dt) {
  Eigen::MatrixX3d powers(ssize(heights), 3);
  Eigen::VectorXd values(ssize(heights));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double t = static_cast<double>(i) * dt;
    powers.row(i) << 1, t, t * t;
    values[i] = heights[static_cast<size_t>(i)];
  }
  const Eigen::Vector3d fit = powers.colPivHouseholderQr().solve(values);
  return -2 * fit[2];
}

/// Correlation of a signal with itself `lag` frames later, the mean taken out.
double self_likeness(const std::vector<double>& signal, size_t lag) {
  double both = 0, first = 0, second = 0;
  for (size_t t = 0; t + lag < signal.size(); ++t) {
    both += signal[t] * signal[t + lag];
    first += signal[t] * signal[t];
    second += signal[t + lag] * signal[t + lag];
  }
  return first > 0 && second > 0 ? both / std::sqrt(first * second) : 0;
}

}  // namespace

double body_sway_deg(const JointSequence& raw, double fps) {
  if (raw.size() < 2) return kUndefined;
  std::array<double, 2> least{1e9, 1e9}, most{-1e9, -1e9};
  for (const Joints& joints : smoothed(raw, fps)) {
    const Vec3 up = heading_of_hips(joints) * (joints.row(Neck) - joints.row(Pelvis)).transpose();
    for (const size_t i : {0, 1}) {
      const double lean = static_cast<double>(std::atan2(up[i == 0 ? 0 : 2], up.y()));
      least[i] = std::min(least[i], lean), most[i] = std::max(most[i], lean);
    }
  }
  return std::hypot(most[0] - least[0], most[1] - least[1]) * 180 / static_cast<double>(kPi);
}

std::vector<float> head_turns_deg_s(const std::vector<Rotations>& local, double fps) {
  std::vector<Mat3> turns;
  turns.reserve(local.size());
  for (const Rotations& one : local) turns.push_back(one[Neck] * one[Head]);
  turns = filtered_rotations(turns, half_gaussian(kSmoothing_s / kSmoothestSeconds, static_cast<float>(fps)));
  std::vector<float> speeds;
  for (size_t t = 1; t < turns.size(); ++t)
    speeds.push_back(geodesic_angle(turns[t - 1], turns[t]) * static_cast<float>(fps) * 180 / kPi);
  return speeds;
}

double head_turn_deg_s(const std::vector<Rotations>& local, double fps) {
  return mean(head_turns_deg_s(local, fps));
}

std::vector<float> pelvis_speeds_legs(const JointSequence& raw, double fps) {
  std::vector<float> speeds;
  if (raw.empty()) return speeds;
  const JointSequence joints = smoothed(raw, fps);
  const float leg = leg_of(joints);
  for (size_t t = 1; t < joints.size(); ++t)
    speeds.push_back((joints[t].row(Pelvis) - joints[t - 1].row(Pelvis)).norm() * static_cast<float>(fps) /
                     leg);
  return speeds;
}

double pelvis_speed_legs(const JointSequence& joints, double fps) {
  return mean(pelvis_speeds_legs(joints, fps));
}

double rise_s(const JointSequence& raw, double fps) {
  if (raw.size() < 2) return kUndefined;
  const JointSequence joints = smoothed(raw, fps);
  double top = 0, reach = 0;
  for (const int wrist : {LeftWrist, RightWrist}) {
    std::vector<Vec3> places;
    for (const Joints& one : joints) places.emplace_back((one.row(wrist) - one.row(Pelvis)).transpose());
    double fastest = 0;
    for (size_t t = 1; t < places.size(); ++t)
      fastest = std::max(fastest, static_cast<double>((places[t] - places[t - 1]).norm()) * fps);
    if (fastest <= top) continue;
    top = fastest, reach = 0;
    const size_t every = 1 + places.size() / 600;
    for (size_t a = 0; a < places.size(); a += every)
      for (size_t b = a + every; b < places.size(); b += every)
        reach = std::max(reach, static_cast<double>((places[a] - places[b]).norm()));
  }
  return top > 0.05 ? reach / top : kUndefined;
}

double flight_gravity(const JointSequence& joints, double fps) {
  if (joints.size() < 3) return kUndefined;
  const float leg = leg_of(joints);
  std::vector<double> lowest, pulls, heights;
  for (const Joints& one : joints) lowest.push_back(static_cast<double>(lowest_foot(one)));
  const double floor = percentile(lowest, 10);
  const auto shortest = static_cast<size_t>(std::ceil(kShortestFlight_s * fps));
  const auto longest = static_cast<size_t>(kLongestFlight_s * fps);  // who stands higher up does not fly
  const auto end = [&] {
    const bool is_flight = heights.size() >= std::max<size_t>(shortest, 4) && heights.size() <= longest;
    if (is_flight) pulls.push_back(parabola_pull(heights, 1 / fps));
    heights.clear();
  };
  for (size_t t = 0; t < joints.size(); ++t) {
    if (lowest[t] > floor + static_cast<double>(kOffFloor * leg))
      heights.push_back(static_cast<double>(joints[t].col(1).mean()));
    else
      end();
  }
  end();
  return pulls.empty() ? kUndefined : percentile(pulls, 50);
}

double cycle_s(const JointSequence& raw, double fps) {
  const JointSequence joints = smoothed(raw, fps);
  std::vector<double> signal;
  for (const Joints& one : joints)
    signal.push_back(static_cast<double>(
        Vec3(heading_of_hips(one) * (one.row(LeftAnkle) - one.row(RightAnkle)).transpose()).z()));
  const double middle = mean(signal);
  for (double& value : signal) value -= middle;
  const auto first = static_cast<size_t>(0.3 * fps),
             last = std::min(static_cast<size_t>(3 * fps), signal.size() / 2);
  std::vector<double> like;
  for (size_t lag = 0; lag <= last; ++lag) like.push_back(self_likeness(signal, lag));
  for (size_t lag = std::max<size_t>(first, 1); lag + 1 < like.size(); ++lag) {
    if (like[lag] < kRepeats || like[lag] < like[lag - 1] || like[lag] < like[lag + 1]) continue;
    // The top of the parabola through the three.
    const double bend = like[lag - 1] - 2 * like[lag] + like[lag + 1];
    const double shift = bend < 0 ? 0.5 * (like[lag - 1] - like[lag + 1]) / bend : 0;
    return (static_cast<double>(lag) + shift) / fps;
  }
  return kUndefined;
}

double stance_slide(const JointSequence& joints, double fps) {
  if (joints.size() < 2) return kUndefined;
  const std::vector<Standing> standing = stances(joints, static_cast<float>(1 / fps), leg_of(joints));
  std::vector<double> speeds;
  for (size_t t = 1; t < joints.size(); ++t)
    for (const size_t side : {0, 1}) {
      if (!standing[t][side] || !standing[t - 1][side]) continue;
      const int foot = LeftFoot + static_cast<int>(side);
      const Vec3 way = (joints[t].row(foot) - joints[t - 1].row(foot)).transpose();
      speeds.push_back(static_cast<double>(std::hypot(way.x(), way.z())) * fps);
    }
  return mean(speeds);
}

}  // namespace understudy
