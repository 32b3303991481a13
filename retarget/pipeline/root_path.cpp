#include "retarget/pipeline/root_path.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {

namespace {

constexpr std::array<int, 4> kFeet = {LeftAnkle, RightAnkle, LeftFoot, RightFoot};
constexpr float kContactEase = 0.1f;  // seconds in which a contact takes hold
constexpr float kAloneEase = 0.03f;   // the same where the pelvis alone takes the soles to the floor
constexpr float kPlantEase = 0.06f;   // the same of a leg that reaches for the floor
constexpr float kPelvisEase = 0.2f;   // the same of a pelvis that was seen far from where the feet put it
constexpr float kUsual = 0.035f;      // of the leg: what errors of the feet alone amount to
constexpr float kSlack = 0.002f;      // of the leg: soles this near are left alone
constexpr float kDeepest = 0.25f;     // of the leg: a pelvis comes down no further for long steps
constexpr float kWidth = 0.4f;        // of a foot, of its length
constexpr float kSpan = 0.988f;       // of the leg: as far as it reaches before it straightens softly

/// At most some 2,000 points of the scan within `reach` of a foot's joint, the lowest first.
std::vector<Vec3> points_near_feet(const Extraction& source, const Points& scan, float reach) {
  std::vector<int> feet;
  for (const int j : kFeet)
    if (!is_lost(source, j)) feet.push_back(j);
  std::vector<Vec3> near;
  for (Eigen::Index i = 0; i < scan.rows(); ++i)
    for (const int j : feet)
      if ((scan.row(i) - source.joints.row(j)).squaredNorm() < reach * reach) {
        near.push_back(scan.row(i).transpose());
        break;
      }
  constexpr size_t kMost = 2000;
  const size_t step = 1 + near.size() / kMost;
  for (size_t i = 0; i * step < near.size(); ++i) near[i] = near[i * step];
  near.resize((near.size() + step - 1) / step);
  std::sort(near.begin(), near.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  return near;
}

int neighbours_of(const Vec3& point, const std::vector<Vec3>& points, float reach) {
  int count = -1;  // itself
  for (const Vec3& other : points) count += (other - point).squaredNorm() < reach * reach ? 1 : 0;
  return count;
}

}  // namespace

std::optional<float> sole_height(const Extraction& source, const Points& scan) {
  const float leg = std::max(leg_length(source.joints), 1e-3f);
  const std::vector<Vec3> near = points_near_feet(source, scan, 0.25f * leg);
  if (near.size() < 20) return std::nullopt;
  // Bits of floor and outliers lie below the soles, but sparsely; a sole is as dense as the legs above it.
  const float apart = 0.03f * leg;
  std::vector<int> neighbours;
  for (size_t i = 0; i < near.size(); i += 1 + near.size() / 64)
    neighbours.push_back(neighbours_of(near[i], near, apart));
  std::nth_element(neighbours.begin(), neighbours.begin() + static_cast<long>(neighbours.size() / 2),
                   neighbours.end());
  const int dense = std::max(2, (neighbours[neighbours.size() / 2] + 1) / 2);
  // The mean of the lowest ones: one alone would tremble.
  const size_t skip = near.size() / 400, wanted = 1 + near.size() / 50;
  size_t found = 0;
  float sum = 0;
  for (const Vec3& point : near) {
    if (neighbours_of(point, near, apart) < dense || found++ < skip) continue;
    sum += point.y();
    if (found == skip + wanted) return sum / static_cast<float>(wanted);
  }
  return std::nullopt;
}

SupportPoints SupportPoints::from(const Points& rest, const Joints& rest_joints) {
  SupportPoints support;
  std::vector<Vec3> offsets;
  const auto add = [&](int moved_with, const Vec3& point) {
    support.joint.push_back(moved_with);
    offsets.push_back(point - rest_joints.row(moved_with).transpose());
  };
  for (const int j :
       {Pelvis, Head, LeftKnee, RightKnee, LeftWrist, RightWrist, LeftAnkle, RightAnkle, LeftFoot, RightFoot})
    add(j, rest_joints.row(j).transpose());
  for (const int side : {0, 1}) {
    const int ankle = side == 0 ? LeftAnkle : RightAnkle, toe = side == 0 ? LeftFoot : RightFoot;
    const float mid = 0.5f * (rest_joints(LeftAnkle, 0) + rest_joints(RightAnkle, 0));
    // The sole in cells along and across the foot, which may stand on an edge: of each the lowest vertex,
    // behind the ball with the ankle, before it with the toes.
    constexpr int kCells = 6, kAcross = 4;
    const float heel = rest_joints(ankle, 2) - 0.09f * leg_length(rest_joints),
                length = 0.35f * leg_length(rest_joints), edge = rest_joints(toe, 0) - 0.5f * kWidth * length,
                width = kWidth * length;
    std::array<int, kCells * kAcross> lowest;
    lowest.fill(-1);
    for (Eigen::Index v = 0; v < rest.rows(); ++v) {
      const bool mine = (rest(v, 0) > mid) == (side == 0) && rest(v, 1) < rest_joints(ankle, 1);
      const int along = static_cast<int>(std::floor((rest(v, 2) - heel) / length * kCells));
      if (!mine || along < 0 || along >= kCells) continue;
      const int across = static_cast<int>(std::floor((rest(v, 0) - edge) / width * kAcross));
      const int cell = along * kAcross + std::clamp(across, 0, kAcross - 1);
      if (lowest[cell] < 0 || rest(v, 1) < rest(lowest[cell], 1)) lowest[cell] = v;
    }
    for (const int v : lowest)
      if (v >= 0) add(rest(v, 2) > rest_joints(toe, 2) ? toe : ankle, rest.row(v).transpose());
  }
  support.offset = Eigen::Map<const Points>(offsets[0].data(), offsets.size(), 3);
  return support;
}

float SupportPoints::lowest(const PosedSkeleton& posed) const {
  float low = 0;
  for (size_t i = 0; i < joint.size(); ++i) {
    const Vec3 offset_world = posed.global[joint[i]] * offset.row(i).transpose();
    low = std::min(low, posed.joints(joint[i], 1) - posed.joints(Pelvis, 1) + offset_world.y());
  }
  return low;
}

float SupportPoints::lowest_of_foot(const PosedSkeleton& posed, int side) const {
  float low = posed.joints(LeftAnkle + side, 1);
  for (size_t i = 0; i < joint.size(); ++i) {
    const int j = joint[i];
    if (j != LeftAnkle + side && j != LeftFoot + side) continue;
    const Vec3 offset_world = posed.global[j] * offset.row(i).transpose();
    low = std::min(low, posed.joints(j, 1) + offset_world.y());
  }
  return low;
}

void RootPath::reset(const Points& rest_b, const Joints& joints_b) {
  rest_b_ = joints_b;
  leg_b_ = leg_length(joints_b);
  US_CHECK(std::isfinite(leg_b_) && leg_b_ > 1e-4f, "the target's legs have no length");
  support_ = SupportPoints::from(rest_b, joints_b);
  leg_a_.clear();
  offsets_.clear();
  started_ = false;
  offset_ = correction_ = pelvis_error_ = sole_ = touching_ = left_over_ = lowered_ = 0;
  scale_ = 1;
}

float RootPath::clearance(const Extraction& source) const {
  if (source.sole_height) return *source.sole_height;
  float lowest_joint = source.joints(LeftAnkle, 1);
  for (const int j : kFeet) lowest_joint = std::min(lowest_joint, source.joints(j, 1));
  return lowest_joint - 0.03f * std::max(leg_a_.value(), 1e-3f);  // the joints less a sole
}

Vec3 RootPath::push(const Extraction& source, const Rotations& local_b, float dt) {
  leg_a_.push(leg_length(source.joints));
  const float wanted_scale = leg_b_ / std::max(leg_a_.value(), 1e-4f);
  const Vec3 pelvis = source.joints.row(Pelvis).transpose();
  const float follow = started_ ? 1 - std::exp(-dt / std::max(options_.settle_s, 1e-3f)) : 1.0f;
  scale_ += follow * (wanted_scale - scale_);

  if (!started_) {
    root_ = pelvis;
  } else if (options_.mode != RootMode::InPlace) {
    const float s = options_.mode == RootMode::Scaled ? scale_ * options_.stride : 1.0f;
    root_.x() += s * (pelvis.x() - last_source_.x());
    root_.z() += s * (pelvis.z() - last_source_.z());
  }
  last_source_ = pelvis;

  // y = s * y_source + offset; the offset makes the target's soles as high over the floor as s times the
  // source's.
  const float lowest = support_.lowest(forward_kinematics(rest_b_, Pose{local_b, Vec3::Zero()}));
  const float clear = clearance(source);
  const float exact = scale_ * clear - lowest;
  offsets_.push(exact - scale_ * pelvis.y());
  offset_ += follow * (offsets_.value() - offset_);
  root_.y() = scale_ * pelvis.y() + offset_;

  // In contact the rest of the error is taken out: small ones in part, all of it would shake the body with
  // every foot's error; larger ones whole, then it is the pelvis that was not well seen.
  const float height = std::max(0.0f, clear) / std::max(options_.contact_height_m, 1e-4f);
  touching_ = std::clamp(1.5f - height, 0.0f, 1.0f);
  const float contact_ease = options_.contact < 1 ? kContactEase : kAloneEase;
  const float ease = started_ ? 1 - std::exp(-dt / contact_ease) : 1.0f;
  const float error = exact - root_.y();
  const float small = std::clamp(error, -kUsual * leg_b_, kUsual * leg_b_);
  const float swift = started_ ? 1 - std::exp(-dt / kPelvisEase) : 1.0f;
  correction_ += ease * (touching_ * options_.contact * small - correction_);
  pelvis_error_ += swift * (touching_ * (error - small) - pelvis_error_);
  root_.y() += correction_ + pelvis_error_;
  sole_ = scale_ * clear;
  const float quick = started_ ? 1 - std::exp(-dt / kPlantEase) : 1.0f;
  const float rest = exact - root_.y();
  const float seen = std::copysign(std::max(0.0f, std::abs(rest) - kSlack * leg_b_), rest);
  left_over_ += quick * (touching_ * seen - left_over_);
  started_ = true;
  return root_;
}

/// 1: a foot so far above the body's lowest point stands .. 0 it does not.
float RootPath::standing(float above) const {
  return std::clamp(1.5f - above / std::max(options_.contact_height_m, 1e-4f), 0.0f, 1.0f);
}

Pose RootPath::step(const Pose& pose) const {
  if (options_.stride == 1 && options_.hip_height_m == 0) return pose;
  const PosedSkeleton posed = forward_kinematics(rest_b_, pose);
  const float lowest = support_.lowest(posed) + posed.joints(Pelvis, 1);
  std::array<Vec3, 2> goal;
  float raise = options_.hip_height_m;
  for (const int side : {0, 1}) {
    const Leg leg = Leg::of(side);
    const Vec3 hip = posed.joints.row(leg.hip).transpose();
    const Vec3 way = posed.joints.row(leg.ankle).transpose() - hip;
    const Vec3 longer(options_.stride * way.x(), way.y(), options_.stride * way.z());
    goal[side] = hip + longer;
    // How far the hip may rise: |longer - (0, room, 0)| = longest.
    const float longest = std::max(way.norm(), kSpan * leg_b_);
    const float flat = longer.x() * longer.x() + longer.z() * longer.z();
    const float room = longer.y() + std::sqrt(std::max(0.0f, longest * longest - flat));
    const float most = std::max(room, std::min(0.0f, options_.hip_height_m) - kDeepest * leg_b_);
    const float stands = standing(support_.lowest_of_foot(posed, side) - lowest);
    raise = std::min(raise, options_.hip_height_m + stands * std::min(0.0f, most - options_.hip_height_m));
  }
  Pose result = pose;
  result.root.y() += raise;
  for (const int side : {0, 1}) place_ankle(rest_b_, side, goal[side], result);
  return result;
}

Pose RootPath::plant(const Pose& pose, float dt) {
  const PosedSkeleton posed = forward_kinematics(rest_b_, pose);
  const float lowest = support_.lowest(posed) + posed.joints(Pelvis, 1);
  Pose result = pose;
  float low = 1e9f;
  for (const int side : {0, 1}) {
    const float above = support_.lowest_of_foot(posed, side) - lowest;
    const float reach = standing(above);
    if (reach <= 0) continue;
    const Vec3 move(0, reach * left_over_, 0);
    const Vec3 ankle = posed.joints.row(LeftAnkle + side).transpose();
    const Vec3 came = place_ankle(rest_b_, side, ankle + move, result);
    low = std::min(low, lowest + above + came.y() - ankle.y());
  }
  const float short_by = low < 1e9f ? touching_ * std::max(0.0f, low - sole_) : 0.0f;
  lowered_ += (1 - std::exp(-dt / kContactEase)) * (short_by - lowered_);
  result.root.y() -= lowered_;
  return result;
}

}  // namespace understudy
