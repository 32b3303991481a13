#include "retarget/motion_space/step_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/seam.hpp"

namespace understudy {
namespace {

// Chosen on some windows of unseen walks.
constexpr float kNoise_m = 0.005f;
constexpr size_t kFollowed = 4;  // starts
constexpr int kMostRounds = 6, kSteps = 6;
constexpr float kLeastGain = 1e-3f, kLeastRoundGain = 0.02f;  // shares of the cost

constexpr int kPlaceNumbers = 3;
constexpr float kPlaceScale = 0.05f;  // metres or radians
constexpr float kDifference = 0.05f;
constexpr int kSmoothings = 2;
constexpr float kShortestRound = 0.1f;  // seconds

/// A movement from the origin that goes on where it ends, as it is at any time.
class Course {
 public:
  explicit Course(TimedPoses movement) : movement_(std::move(movement)) {
    turn_ = Outlook::of(movement_.poses.back());
    turn_.place.y() = 0;
    close_seam(movement_.poses);
  }

  Pose at(float seconds) const {
    const float round = std::max(movement_.duration(), kShortestRound);
    const int rounds = static_cast<int>(seconds / round);
    Pose pose = pose_at(movement_, seconds - static_cast<float>(rounds) * round);
    for (int i = 0; i < rounds; ++i) pose = turn_.placed(pose);
    return pose;
  }

 private:
  TimedPoses movement_;
  Outlook turn_;  // where it ends
};

/// Each pose half of itself, half of those beside it: a decoded movement has kinks at its knots.
std::vector<Pose> smoothed(const std::vector<Pose>& poses) {
  std::vector<Pose> made = poses;
  for (size_t i = 1; i + 1 < poses.size(); ++i)
    made[i] = between(poses[i], between(poses[i - 1], poses[i + 1], 0.5f), 0.5f);
  return made;
}

/// Where a fit has come to.
struct Attempt {
  Eigen::VectorXf x;    // the code, and then the place in units of kPlaceScale
  Eigen::VectorXf off;  // see StepFitter::off
  float cost = 0;       // |off|^2 + |code|^2
};

bool is_cheaper(const Attempt& a, const Attempt& b) {
  return a.cost < b.cost;
}

class StepFitter {
 public:
  StepFitter(MotionCoder& coder, const MotionWindow& window) : coder_(coder), window_(window) {
    const std::vector<KnownParts> known = known_of(window);
    for (int i = 0; i < ssize(window.curve); ++i)
      if (known[i] == all_parts(true)) {
        known_.push_back(i);
        joints_.push_back(forward_kinematics(window.rest, window.curve[i]).joints);
      }
    US_CHECK(!known_.empty(), "a movement is fitted where nothing is known");
    begin_ = Outlook::of(window.curve.front());
    begin_.place.y() = -window.outlook.place.y();  // the floor
  }

  Attempt begin(const std::vector<float>& code) const {
    Eigen::VectorXf x(ssize(code) + kPlaceNumbers);
    x << Eigen::Map<const Eigen::VectorXf>(code.data(), ssize(code)), Vec3::Zero();
    return attempt(std::move(x));
  }

  /// Some steps with one set of derivatives. Whether much was gained.
  bool improve(Attempt& best) const {
    Eigen::MatrixXf J = jacobian(best);
    const float before = best.cost;
    const Eigen::Index code = best.x.size() - kPlaceNumbers;
    float damping = 1e-2f;
    for (int i = 0; i < kSteps; ++i) {
      Eigen::MatrixXf H = J.transpose() * J;
      H.diagonal().head(code).array() += 1;
      H.diagonal() *= 1 + damping;
      Eigen::VectorXf g = J.transpose() * best.off;
      g.head(code) += best.x.head(code);
      const Eigen::VectorXf way = H.ldlt().solve(-g);
      Attempt moved = attempt(best.x + way);
      // The derivatives learn from the step (Broyden 1965): decoding is dear.
      J += (moved.off - best.off - J * way) * way.transpose() / std::max(way.squaredNorm(), 1e-12f);
      const float gain = best.cost - moved.cost;
      damping *= gain > 0 ? 0.3f : 5;
      if (gain > 0) best = std::move(moved);
      if (gain > 0 && gain < kLeastGain * best.cost) break;
    }
    return before - best.cost > kLeastRoundGain * before;
  }

  FittedStep result(const Attempt& best) const {
    FittedStep step;
    step.error_m = kNoise_m * best.off.norm();
    const Course course = course_of(best.x);
    const Outlook place = place_of(best.x);
    for (int i = 0; i < ssize(window_.curve); ++i)
      step.poses.push_back(place.placed(course.at(static_cast<float>(i) / kWindowRate)));
    for (int i = 0; i < kSmoothings; ++i) step.poses = smoothed(step.poses);
    return step;
  }

 private:
  Course course_of(const Eigen::VectorXf& x) const {
    return Course(coder_.decode({x.data(), x.data() + x.size() - kPlaceNumbers}, window_.rest));
  }

  Outlook place_of(const Eigen::VectorXf& x) const {
    const Vec3 moved = kPlaceScale * x.tail<kPlaceNumbers>();
    return {begin_.place + begin_.heading * Vec3(moved[0], 0, moved[1]),
            begin_.heading * rotation_about_y(moved[2])};
  }

  Attempt attempt(Eigen::VectorXf x) const {
    Attempt made{std::move(x), {}, 0};
    made.off = off(made.x);
    made.cost = made.off.squaredNorm() + made.x.head(made.x.size() - kPlaceNumbers).squaredNorm();
    return made;
  }

  /// How far the joints of known samples are from where they should be; the squares sum to the mean square
  /// distance in units of the noise.
  Eigen::VectorXf off(const Eigen::VectorXf& x) const {
    const Course course = course_of(x);
    const Outlook place = place_of(x);
    constexpr int kEach = 3 * kJointCount;
    Eigen::VectorXf off(kEach * ssize(known_));
    for (int k = 0; k < ssize(known_); ++k) {
      const Pose pose = place.placed(course.at(static_cast<float>(known_[k]) / kWindowRate));
      const Joints apart = forward_kinematics(window_.rest, pose).joints - joints_[k];
      off.segment<kEach>(kEach * k) = Eigen::Map<const Eigen::VectorXf>(apart.data(), kEach);
    }
    return off / (kNoise_m * std::sqrt(static_cast<float>(kJointCount * ssize(known_))));
  }

  Eigen::MatrixXf jacobian(const Attempt& at) const {
    Eigen::MatrixXf J(at.off.size(), at.x.size());
    for (Eigen::Index n = 0; n < at.x.size(); ++n) {
      Eigen::VectorXf moved = at.x;
      moved(n) += kDifference;
      J.col(n) = (off(moved) - at.off) / kDifference;
    }
    return J;
  }

  MotionCoder& coder_;
  const MotionWindow& window_;
  std::vector<int> known_;      // samples
  std::vector<Joints> joints_;  // of each of them
  Outlook begin_;               // of the window's first sample
};

}  // namespace

FittedStep fit_step(MotionCoder& coder, const MotionWindow& window,
                    const std::vector<std::vector<float>>& starts) {
  US_CHECK(!starts.empty(), "a movement is fitted from no start");
  const StepFitter fitter(coder, window);
  std::vector<Attempt> attempts;
  attempts.reserve(starts.size());
  for (const std::vector<float>& code : starts) attempts.push_back(fitter.begin(code));
  const auto keep = [&attempts](size_t count) {
    std::stable_sort(attempts.begin(), attempts.end(), is_cheaper);
    attempts.erase(attempts.begin() + static_cast<ptrdiff_t>(std::min(count, attempts.size())),
                   attempts.end());
  };
  keep(kFollowed);
  for (int round = 0; round < kMostRounds; ++round) {
    bool gained = false;
    for (Attempt& one : attempts) gained |= fitter.improve(one);
    if (!gained) break;
    keep(std::max<size_t>(1, attempts.size() / 2));
  }
  keep(1);
  return fitter.result(attempts.front());
}

}  // namespace understudy
