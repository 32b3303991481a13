#include "retarget/style/standing_feet.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

constexpr float kGivenUp_s = 0.15f, kHeight_s = 0.05f;
constexpr float kMostMoved = 0.3f;  // legs

float eased(float dt, float seconds) {
  return 1 - std::exp(-dt / seconds);
}

}  // namespace

void StandingFeet::push(const StyleFrame& source, const StyledFeet& feet, Pose& styled) {
  const Vec3 root_way = styled.root - last_root_;
  const float most = kMostMoved * leg_length(source.rest);
  for (const size_t side : {size_t{0}, size_t{1}}) {
    Vec3 slid = Vec3::Zero();
    float lower = 0, all = 0, stands = 0;
    for (const size_t k : {side, side + 2}) {
      const float weight = started_ ? std::min(feet.bears[k], last_.bears[k]) : feet.bears[k];
      if (started_)
        slid += weight * ((feet.source[k] - last_.source[k]) - (root_way + feet.styled[k] - last_.styled[k]));
      lower += weight * (feet.source[k].y() - styled.root.y() - feet.styled[k].y());
      all += weight;
      stands = std::max(stands, weight);
    }
    Vec3& moved = moved_[side];
    if (all > 1e-6f) {
      moved.x() += stands * slid.x() / all;
      moved.z() += stands * slid.z() / all;
      lower *= stands / all;
    }
    const float given_up = (1 - stands) * eased(source.dt, kGivenUp_s);
    moved.x() -= given_up * moved.x();
    moved.z() -= given_up * moved.z();
    moved.y() = started_ ? moved.y() + eased(source.dt, kHeight_s) * (lower - moved.y()) : lower;
    if (moved.norm() > most) moved *= most / moved.norm();
    place_ankle(source.rest, static_cast<int>(side), styled.root + feet.styled[side + 2] + moved, styled);
  }
  last_ = feet, last_root_ = styled.root;
  started_ = true;
}

}  // namespace understudy
