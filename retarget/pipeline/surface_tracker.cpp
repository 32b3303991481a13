#include "retarget/pipeline/surface_tracker.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/math/rotation.hpp"
#include "retarget/math/segment.hpp"

namespace understudy {
namespace {

using Mat6 = Eigen::Matrix<float, 6, 6>;

constexpr float kMarkReach = 0.04f;               // metres from a mark to the surface that it may lie on
constexpr float kAboutJoints = 0.5f;              // metres about the joints that a person's points lie in
constexpr float kCarried = 0.25f;                 // metres from a bone to the surface that it carries
constexpr float kLeastDeviation = 0.002f;         // metres, the least deviation of a surface that is believed
constexpr float kUnfitted = 0.008f;               // the same before any fit
constexpr float kRobust = 2;                      // deviations from which a mark counts less
constexpr float kRobustTurn = 25 / 180.0f * kPi;  // from which an extracted rotation counts less
constexpr float kFlat = 0.25f;                    // thickness of a surface that has a normal
constexpr float kSkin_m2 = 1.9f;                  // of a person, for the distance between points
constexpr int kForMean = 20;                      // frames that the offsets' means are over
constexpr int kDenseMesh = 4000;  // vertices of a mesh that are looked at instead of its faces
constexpr int kLookedAt = 8000;   // points
constexpr int kCandidates = 400;  // for new marks, each frame
constexpr float kShown = 0.5f;    // visibility of a bone that gets marks
constexpr size_t kFewestMatches = 6;

struct Segment {
  int bone;  // that carries it
  Vec3 from, to;
};

/// The bones' axes; hands, feet and head reach beyond their last joint.
std::vector<Segment> segments(const Joints& joints) {
  const auto at = [&](int j) -> Vec3 { return joints.row(j); };
  const auto beyond = [&](int joint, int before, float share) {
    return Segment{joint, at(joint), at(joint) + share * (at(joint) - at(before))};
  };
  std::vector<Segment> all;
  for (int j = 1; j < kJointCount; ++j) all.push_back({kParents[j], at(kParents[j]), at(j)});
  all.push_back(beyond(LeftWrist, LeftElbow, 0.6f));
  all.push_back(beyond(RightWrist, RightElbow, 0.6f));
  all.push_back(beyond(LeftFoot, LeftAnkle, 0.5f));
  all.push_back(beyond(RightFoot, RightAnkle, 0.5f));
  all.push_back(beyond(Head, Neck, 1.3f));
  return all;
}

/// The bone whose axis is nearest; -1: none is near.
int bone_of(const Vec3& point, const std::vector<Segment>& segments) {
  float least = kCarried * kCarried;
  int bone = -1;
  for (const Segment& segment : segments) {
    const float d = from_segment(point, segment.from, segment.to).squaredNorm();
    if (d >= least) continue;
    least = d;
    bone = segment.bone;
  }
  return bone;
}

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Where the scan is looked at: some of its points, or points on its faces where it has few corners.
Points looked_at(const Mesh& scan, Rng& rng) {
  if (!scan.is_cloud() && scan.vertices.rows() < kDenseMesh) return sample_points(scan, kLookedAt, rng);
  const Eigen::Index step = std::max<Eigen::Index>(1, scan.vertices.rows() / kLookedAt);
  if (step == 1) return scan.vertices;
  Points some((scan.vertices.rows() + step - 1) / step, 3);
  for (Eigen::Index i = 0; i < some.rows(); ++i) some.row(i) = scan.vertices.row(i * step);
  return some;
}

}  // namespace

struct SurfaceTracker::Block {
  Mat6 own = Mat6::Zero();     // of the normal equations, with itself
  Vec6 pull = Vec6::Zero();    // their right side, negated
  Mat6 parent = Mat6::Zero();  // with the parent's unknowns
};

SurfaceTracker::SurfaceTracker(const SurfaceTrackerOptions& options) : options_(options) {
  restart();
}

void SurfaceTracker::restart() {
  rng_ = Rng(0);
  for (std::vector<Mark>& marks : marks_) marks.clear();
  variance_.fill(kUnfitted * kUnfitted);
  offsets_.setZero();
  frames_ = 0;
}

std::vector<SurfaceTracker::Match> SurfaceTracker::matches(int bone, const Bones& bones,
                                                           const NearPoints& surface) const {
  std::vector<Match> found;
  const Vec3 joint = bones.joints.row(bone);
  for (const Mark& mark : marks_[bone]) {
    const Vec3 arm = bones.turns[bone] * mark.place, normal = bones.turns[bone] * mark.normal;
    if (const auto point = surface.nearest(joint + arm))
      found.push_back({arm, normal, normal.dot(joint + arm - *point)});
  }
  return found;
}

/// A bone whose surface is rough, loose or noisy holds less.
void SurfaceTracker::settle(int bone, const std::vector<Match>& matches) {
  if (matches.size() < kFewestMatches) return;
  std::vector<float> off;
  off.reserve(matches.size());
  for (const Match& match : matches) off.push_back(std::abs(match.off));
  const auto middle = off.begin() + static_cast<long>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  const float deviation = std::max(kLeastDeviation, 1.48f * *middle);
  variance_[bone] += options_.settling * (deviation * deviation - variance_[bone]);
}

void SurfaceTracker::pull_to_extracted(const Extraction& seen, const Bones& bones, Blocks& blocks) const {
  const float turn = options_.turn_deg / 180 * kPi;
  for (int b = 0; b < kJointCount; ++b) {
    const float expected = options_.joint_errors * expected_error_for(seen.confidence[b]);
    const float joint = std::max(options_.least_joint_m, expected);
    const Vec3 off = (bones.joints.row(b) - seen.joints.row(b)).transpose();
    const Vec3 turned = rotation_to_axis_angle(bones.turns[b] * (*seen.global)[b].transpose());
    const float of_turn = 1 / (turn * turn * (1 + turned.squaredNorm() / (kRobustTurn * kRobustTurn)));
    blocks[b].own.diagonal().head<3>().array() += 1 / (joint * joint);
    blocks[b].pull.head<3>() += off / (joint * joint);
    blocks[b].own.diagonal().tail<3>().array() += of_turn;
    blocks[b].pull.tail<3>() += of_turn * turned;
  }
}

/// The residual x_b - x_p - R_p o_b of each joint b beside its parent p.
void SurfaceTracker::hold_together(const Bones& bones, Blocks& blocks) const {
  const float weight = 1 / (options_.offset_m * options_.offset_m);
  for (int b = 1; b < kJointCount; ++b) {
    const int p = kParents[b];
    const Vec3 offset = bones.turns[p] * offsets_.row(b).transpose();
    const Vec3 off = (bones.joints.row(b) - bones.joints.row(p)).transpose() - offset;
    Eigen::Matrix<float, 3, 6> of_own = Eigen::Matrix<float, 3, 6>::Zero(), of_parent = of_own;
    of_own.leftCols<3>().setIdentity();
    of_parent.leftCols<3>() = -Mat3::Identity();
    of_parent.rightCols<3>() = cross_matrix(offset);
    blocks[b].own += weight * of_own.transpose() * of_own;
    blocks[b].pull += weight * of_own.transpose() * off;
    blocks[b].parent += weight * of_own.transpose() * of_parent;
    blocks[p].own += weight * of_parent.transpose() * of_parent;
    blocks[p].pull += weight * of_parent.transpose() * off;
  }
}

/// Of a bone's marks: the residual along the normal, robust (Geman-McClure).
void SurfaceTracker::lay_on_surface(int bone, const std::vector<Match>& matches, Block& block) const {
  const float variance = variance_[bone];
  const bool hand = bone == LeftWrist || bone == RightWrist;
  const float share = hand ? options_.hand_share : options_.mark_share;
  for (const Match& match : matches) {
    const float far = 1 + match.off * match.off / (kRobust * kRobust * variance);
    const float weight = share / (variance * far * far);
    Vec6 slope;
    slope << match.normal, match.arm.cross(match.normal);
    block.own += weight * slope * slope.transpose();
    block.pull += weight * match.off * slope;
  }
}

/// Solves the normal equations, leaves first: a bone's unknowns in terms of its parent's.
void SurfaceTracker::step(Blocks& blocks, Bones& bones) {
  std::array<Eigen::LLT<Mat6>, kJointCount> solved;
  for (int b = kJointCount - 1; b >= 0; --b) {
    solved[b].compute(blocks[b].own);
    if (b == Pelvis) break;
    Block& parent = blocks[kParents[b]];
    parent.own -= blocks[b].parent.transpose() * solved[b].solve(blocks[b].parent);
    parent.pull -= blocks[b].parent.transpose() * solved[b].solve(blocks[b].pull);
  }
  std::array<Vec6, kJointCount> change;
  for (int b = 0; b < kJointCount; ++b) {
    if (b != Pelvis) blocks[b].pull += blocks[b].parent * change[kParents[b]];
    change[b] = -solved[b].solve(blocks[b].pull);
    bones.joints.row(b) += change[b].head<3>().transpose();
    bones.turns[b] = rotation_from_axis_angle(change[b].tail<3>()) * bones.turns[b];
  }
}

void SurfaceTracker::fit(const Extraction& seen, const NearPoints& surface, Bones& bones) {
  for (int round = 1; round <= options_.rounds; ++round) {
    Blocks blocks;
    pull_to_extracted(seen, bones, blocks);
    hold_together(bones, blocks);
    for (int b = 0; b < kJointCount; ++b) {
      const std::vector<Match> found = matches(b, bones, surface);
      lay_on_surface(b, found, blocks[b]);
      if (round == options_.rounds) settle(b, found);
    }
    step(blocks, bones);
  }
}

/// Draws bones towards what was extracted; the marks stay where they are on the surface.
void SurfaceTracker::anchor(const Extraction& seen, Bones& bones) {
  const float share = std::max(1 / static_cast<float>(frames_ + 1), options_.anchoring);
  for (int b = 0; b < kJointCount; ++b) {
    const Vec3 joint = bones.joints.row(b);
    const Mat3 turn = bones.turns[b];
    const Vec3 off = rotation_to_axis_angle((*seen.global)[b] * turn.transpose());
    bones.joints.row(b) += share * (seen.joints.row(b) - bones.joints.row(b));
    bones.turns[b] = rotation_from_axis_angle(options_.anchoring * off) * turn;
    for (Mark& mark : marks_[b]) {
      mark.place = bones.turns[b].transpose() * (joint + turn * mark.place - bones.joints.row(b).transpose());
      mark.normal = bones.turns[b].transpose() * (turn * mark.normal);
    }
  }
}

void SurfaceTracker::remember_offsets(const Bones& bones) {
  const float share = 1 / static_cast<float>(std::min(frames_ + 1, kForMean));
  for (int b = 1; b < kJointCount; ++b) {
    const Vec3 beside = (bones.joints.row(b) - bones.joints.row(kParents[b])).transpose();
    const Vec3 offset = bones.turns[kParents[b]].transpose() * beside;
    offsets_.row(b) += share * (offset.transpose() - offsets_.row(b));
  }
}

void SurfaceTracker::renew_marks(const Extraction& seen, const NearPoints& surface, const Bones& bones) {
  const std::vector<Segment> axes = segments(bones.joints);
  const float spacing = std::sqrt(kSkin_m2 / static_cast<float>(std::max(1, surface.size())));
  const float radius = std::clamp(2.2f * spacing, 0.015f, kMarkReach);
  std::array<int, kJointCount> wanted;
  for (int b = 0; b < kJointCount; ++b) {
    std::vector<Mark>& marks = marks_[b];
    wanted[b] = seen.visibility[b] < kShown ? 0 : options_.marks - static_cast<int>(marks.size());
    if (wanted[b] > 0 || marks.empty()) continue;
    const int old = static_cast<int>(std::ceil(options_.renewed * static_cast<float>(marks.size())));
    for (int i = 0; i < old; ++i) {
      std::swap(marks[rng_.below(static_cast<int>(marks.size()))], marks.back());
      marks.pop_back();
    }
    wanted[b] = old;
  }
  std::vector<Vec3> around;
  const int looks = std::min(surface.size(), frames_ == 0 ? 5 * kCandidates : kCandidates);
  for (int look = 0; look < looks; ++look) {
    const Vec3& at = surface[rng_.below(surface.size())];
    const int b = bone_of(at, axes);
    if (b < 0 || wanted[b] <= 0) continue;
    surface.within(at, radius, around);
    const std::optional<Facing> face = facing(around);
    if (!face || face->thickness > kFlat) continue;
    const Mat3 into = bones.turns[b].transpose();
    marks_[b].push_back({into * (at - bones.joints.row(b).transpose()), into * face->normal});
    --wanted[b];
  }
}

Extraction SurfaceTracker::follow(const Extraction& seen, const Mesh& scan) {
  if (!seen.global || !seen.joints.allFinite()) {
    restart();
    return seen;
  }
  const Vec3 low = seen.joints.colwise().minCoeff().transpose().array() - kAboutJoints,
             high = seen.joints.colwise().maxCoeff().transpose().array() + kAboutJoints;
  const NearPoints surface(looked_at(scan, rng_), low, high, kMarkReach);
  Bones bones{seen.joints, *seen.global};
  if (frames_ > 0) {  // begin where the last correction stands beside what is extracted
    for (int b = 0; b < kJointCount; ++b)
      bones.turns[b] = (*seen.global)[b] * extracted_.turns[b].transpose() * corrected_.turns[b];
    bones.joints += corrected_.joints - extracted_.joints;
    fit(seen, surface, bones);
    anchor(seen, bones);
  }
  Extraction followed = seen;
  for (Mat3& turn : bones.turns) turn = Eigen::Quaternionf(turn).normalized().toRotationMatrix();
  followed.joints = bones.joints;
  followed.global = bones.turns;
  remember_offsets(bones);
  renew_marks(seen, surface, bones);
  extracted_ = {seen.joints, *seen.global};
  corrected_ = bones;
  ++frames_;
  return followed;
}

}  // namespace understudy
