#include "retarget/rig/rig_edits.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <type_traits>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/union_find.hpp"
#include "retarget/geometry/point_tree.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/math/time_filter.hpp"

namespace understudy {
namespace {

constexpr float kSoftCut = 0.05f;  // to each side of a cut, of the bone's length
constexpr float kOnSkin = 0.25f;   // a place so near to a vertex is on the surface, of a limb's thickness
constexpr float kNoWeight = 1e-4f;

/// Of a Rig or a const one.
template <class AnyRig>
auto& joint_of(AnyRig& rig, int joint) {
  US_CHECK(joint >= 0 && joint < rig.count(), "there is no joint ", joint, " among ", rig.count());
  return rig.joints[static_cast<size_t>(joint)];
}

/// One that hangs on another.
RigJoint& hanging_joint(Rig& rig, int joint, const char* refused) {
  RigJoint& found = joint_of(rig, joint);
  US_CHECK(joint > 0, found.name, " is the root: ", refused);
  return found;
}

void check_place(const Vec3& place) {
  US_CHECK(place.allFinite(), "a place must be three finite numbers");
}

void check_frames(const RigMotion& motion, int first, int last) {
  US_CHECK(first >= 0 && first <= last && last < ssize(motion.poses), "there are no frames ", first, " to ",
           last, " among ", motion.poses.size());
}

std::vector<int> same_numbers(const Rig& rig) {
  std::vector<int> numbers(rig.joints.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

std::vector<BoneMotions> motions_of(const RiggedMotion& performed) {
  std::vector<BoneMotions> motions;
  motions.reserve(performed.motion.poses.size());
  for (const RigPose& pose : performed.motion.poses) motions.push_back(bone_motions(performed.rig, pose));
  return motions;
}

/// What the bones do in each frame, as nearly as the rig as it is now lets them. of_bone: of each bone now,
/// its number in `motions`.
void pose_again(RiggedMotion& performed, const std::vector<BoneMotions>& motions,
                const std::vector<int>& of_bone) {
  BoneMotions now(of_bone.size());
  for (size_t t = 0; t < motions.size(); ++t) {
    for (size_t j = 0; j < now.size(); ++j) now[j] = motions[t][static_cast<size_t>(of_bone[j])];
    performed.motion.poses[t] = pose_of(performed.rig, now);
  }
}

/// Calls see(vertex, slot) for all weights of a bone.
template <class See>
void for_weights(const SkinWeights& skin, int bone, const See& see) {
  for (Eigen::Index v = 0; v < skin.size(); ++v)
    for (int k = 0; k < kSkinBones; ++k)
      if (skin.bones(v, k) == bone && skin.weights(v, k) > 0) see(v, k);
}

/// Where the vertices of a bone are.
struct BoneSpread {
  float weight = 0;
  Vec3 middle = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
};
BoneSpread spread_of(const Rig& rig, int bone) {
  BoneSpread spread;
  const auto place = [&](Eigen::Index v) -> Vec3 { return rig.surface.vertices.row(v).transpose(); };
  for_weights(rig.skin, bone, [&](Eigen::Index v, int k) {
    spread.weight += rig.skin.weights(v, k);
    spread.middle += rig.skin.weights(v, k) * place(v);
  });
  if (spread.weight <= 0) return spread;
  spread.middle /= spread.weight;
  for_weights(rig.skin, bone, [&](Eigen::Index v, int k) {
    const Vec3 off = place(v) - spread.middle;
    spread.covariance += rig.skin.weights(v, k) / spread.weight * off * off.transpose();
  });
  return spread;
}

/// Along a bone: from its joint to what hangs on it, or its tip. Where these tell nothing (a trunk between
/// its limbs) along its vertices.
Vec3 along_bone(const Rig& rig, int bone) {
  const Vec3& from = rig.joints[static_cast<size_t>(bone)].rest;
  Vec3 ends = Vec3::Zero();
  int count = 0;
  for (const RigJoint& joint : rig.joints)
    if (joint.parent == bone) ends += joint.rest, ++count;
  for (const BoneTip& tip : bone_tips(rig))
    if (tip.joint == bone) ends += tip.rest, ++count;
  const BoneSpread spread = spread_of(rig, bone);
  const Vec3 way = count > 0 ? Vec3(ends / static_cast<float>(count) - from) : Vec3::Zero();
  if (way.norm() > std::max(1e-6f, std::sqrt(spread.covariance.trace()))) return way.normalized();
  if (spread.weight <= 0) return Vec3::UnitY();
  return Eigen::SelfAdjointEigenSolver<Mat3>(spread.covariance).eigenvectors().col(2);
}

std::vector<int> change(RiggedMotion& performed, const MergeBone& edit) {
  hanging_joint(performed.rig, edit.joint, "it has no parent to become one with");
  const std::vector<BoneMotions> motions = motions_of(performed);
  std::vector<int> of_bone = same_numbers(performed.rig);
  of_bone.erase(of_bone.begin() + edit.joint);
  std::vector<int> numbers = merge_into_parent(performed.rig, edit.joint);
  pose_again(performed, motions, of_bone);
  return numbers;
}

/// A plane across a bone.
struct BoneCut {
  Vec3 through, along;
  float soft = 0;  // metres to each side
  float beyond(const Vec3& place) const {
    const float distance = (place - through).dot(along);
    return soft > 0 ? smooth_step(-soft, soft, distance) : distance > 0 ? 1.0f : 0.0f;
  }
};

BoneCut cut_across(const Rig& rig, const SplitBone& edit) {
  BoneCut cut{edit.at, along_bone(rig, edit.joint)};
  if (cut.along.dot(edit.at - rig.joints[static_cast<size_t>(edit.joint)].rest) < 0) cut.along *= -1;
  float before = 0, beyond = 0;  // how far the bone goes
  const auto height = [&](Eigen::Index v) {
    return (rig.surface.vertices.row(v).transpose() - edit.at).dot(cut.along);
  };
  for_weights(rig.skin, edit.joint, [&](Eigen::Index v, int) {
    before = std::min(before, height(v));
    beyond = std::max(beyond, height(v));
  });
  cut.soft = kSoftCut * (beyond - before);
  std::vector<Vec3> section;  // vertices about the cut
  for_weights(rig.skin, edit.joint, [&](Eigen::Index v, int) {
    if (std::abs(height(v)) <= cut.soft) section.push_back(rig.surface.vertices.row(v).transpose());
  });
  if (section.empty()) return cut;
  const auto count = static_cast<float>(section.size());
  const Vec3 middle = std::accumulate(section.begin(), section.end(), Vec3(Vec3::Zero())) / count;
  float thickness = 0, nearest = std::numeric_limits<float>::max();
  for (const Vec3& place : section) {
    thickness += (place - middle).norm() / count;
    nearest = std::min(nearest, (place - edit.at).norm());
  }
  if (nearest < kOnSkin * thickness) cut.through = middle - (middle - edit.at).dot(cut.along) * cut.along;
  return cut;
}

/// Gives what is beyond the cut of a bone's vertices to another. A vertex of four bones belongs to one side
/// whole.
void cut_skin(Rig& rig, const BoneCut& cut, int bone, int other) {
  SkinWeights& skin = rig.skin;
  for (Eigen::Index v = 0; v < skin.size(); ++v) {
    int own = -1, free = -1;
    for (int k = 0; k < kSkinBones; ++k) {
      if (skin.weights(v, k) <= 0)
        free = k;
      else if (skin.bones(v, k) == bone)
        own = k;
    }
    if (own < 0) continue;
    const float weight = skin.weights(v, own),
                given = weight * cut.beyond(rig.surface.vertices.row(v).transpose());
    if (given > kNoWeight && weight - given > kNoWeight && free >= 0) {
      skin.weights(v, own) = weight - given;
      skin.weights(v, free) = given;
      skin.bones(v, free) = other;
    } else if (2 * given > weight) {
      skin.bones(v, own) = other;
    }
  }
}

std::vector<int> change(RiggedMotion& performed, const SplitBone& edit) {
  Rig& rig = performed.rig;
  const RigJoint first = joint_of(rig, edit.joint);
  check_place(edit.at);
  const BoneCut cut = cut_across(rig, edit);
  const int other = edit.joint + 1;
  float before = 0, beyond = 0;  // weights and children to each side
  const auto count = [&](const Vec3& place, float weight) {
    beyond += weight * cut.beyond(place);
    before += weight * (1 - cut.beyond(place));
  };
  for_weights(rig.skin, edit.joint, [&](Eigen::Index v, int k) {
    count(rig.surface.vertices.row(v).transpose(), rig.skin.weights(v, k));
  });
  const bool bare = before + beyond <= 0;
  for (const RigJoint& joint : rig.joints)
    if (joint.parent == edit.joint) count(joint.rest, 1);
  US_CHECK(beyond > 0 && (before > 0 || bare), "a cut there leaves nothing of ", first.name, " on one side");

  std::vector<int> numbers = same_numbers(rig);
  for (int j = other; j < rig.count(); ++j) ++numbers[static_cast<size_t>(j)];
  for (RigJoint& joint : rig.joints) {
    if (joint.parent == edit.joint && (joint.rest - cut.through).dot(cut.along) > 0)
      joint.parent = other;
    else if (joint.parent >= 0)
      joint.parent = numbers[static_cast<size_t>(joint.parent)];
  }
  rig.skin = renumbered(rig.skin, numbers);
  RigJoint added{"", edit.joint, JointKind::Ball, cut.through, first.axis};
  for (int n = 2; added.name.empty() || bone_named(rig, added.name) >= 0; ++n)
    added.name = first.name + ' ' + std::to_string(n);
  rig.joints.insert(rig.joints.begin() + other, added);
  cut_skin(rig, cut, edit.joint, other);
  for (RigPose& pose : performed.motion.poses) {
    pose.turns.insert(pose.turns.begin() + other, Mat3::Identity());
    pose.slides.insert(pose.slides.begin() + other, 0.0f);
  }
  return numbers;
}

void change(RiggedMotion& performed, const MoveJoint& edit) {
  RigJoint& joint = joint_of(performed.rig, edit.joint);
  check_place(edit.to);
  if (edit.joint == 0)
    for (RigPose& pose : performed.motion.poses) pose.root += pose.turns[0] * (edit.to - joint.rest);
  joint.rest = edit.to;
}

/// The axis about which turns [T] are nearest to these: their quaternions' vector parts lie along it most.
Vec3 best_hinge(const RigMotion& motion, int joint, const Vec3& otherwise) {
  Mat3 sum = Mat3::Zero();
  for (const RigPose& pose : motion.poses) {
    const Vec3 v = Eigen::Quaternionf(pose.turns[static_cast<size_t>(joint)]).vec();
    sum += v * v.transpose();
  }
  if (sum.trace() < 1e-6f) return otherwise;
  Vec3 axis = Eigen::SelfAdjointEigenSolver<Mat3>(sum).eigenvectors().col(2);
  Eigen::Index most;
  axis.cwiseAbs().maxCoeff(&most);
  return axis[most] < 0 ? Vec3(-axis) : axis;
}

void change(RiggedMotion& performed, const SetJointKind& edit) {
  RigJoint& joint = hanging_joint(performed.rig, edit.joint, "it is free");
  US_CHECK(edit.kind != JointKind::Free, joint.name, " hangs on another bone: it cannot be free");
  US_CHECK(!edit.axis || (edit.axis->allFinite() && edit.axis->norm() > 1e-6f),
           "an axis must be three finite numbers, not all zero");
  const std::vector<BoneMotions> motions = motions_of(performed);
  if (edit.axis)
    joint.axis = edit.axis->normalized();
  else if (edit.kind == JointKind::Hinge)
    joint.axis = best_hinge(performed.motion, edit.joint, joint.axis);
  else if (edit.kind == JointKind::Slider && joint.kind != JointKind::Slider)
    joint.axis = along_bone(performed.rig, edit.joint);
  joint.kind = edit.kind;
  pose_again(performed, motions, same_numbers(performed.rig));
}

/// Joints in an order in which parents come first, otherwise as they were.
std::vector<int> in_order(const std::vector<RigJoint>& joints, int root) {
  std::vector<int> order = {root};
  std::vector<bool> placed(joints.size(), false);
  placed[static_cast<size_t>(root)] = true;
  while (order.size() < joints.size())
    for (size_t j = 0; j < joints.size(); ++j) {
      if (placed[j] || !placed[static_cast<size_t>(joints[j].parent)]) continue;
      placed[j] = true;
      order.push_back(static_cast<int>(j));
      break;
    }
  return order;
}

std::vector<int> change(RiggedMotion& performed, const RootAt& edit) {
  Rig& rig = performed.rig;
  joint_of(rig, edit.joint);
  if (edit.joint == 0) return same_numbers(rig);
  const std::vector<BoneMotions> motions = motions_of(performed);
  std::vector<RigJoint> joints = rig.joints;
  for (int bone = edit.joint; bone != 0;) {  // the joint below a bone now carries that bone
    const RigJoint& below = rig.joints[static_cast<size_t>(bone)];
    RigJoint& turned = joints[static_cast<size_t>(below.parent)];
    turned = {turned.name, bone, below.kind, below.rest, below.axis};
    bone = below.parent;
  }
  RigJoint& root = joints[static_cast<size_t>(edit.joint)];
  root = {root.name, -1, JointKind::Free, middle_of_bone(rig, edit.joint), Vec3::UnitY()};

  const std::vector<int> order = in_order(joints, edit.joint);
  std::vector<int> numbers(order.size());
  for (size_t i = 0; i < order.size(); ++i) numbers[static_cast<size_t>(order[i])] = static_cast<int>(i);
  for (size_t i = 0; i < order.size(); ++i) {
    rig.joints[i] = joints[static_cast<size_t>(order[i])];
    if (i > 0) rig.joints[i].parent = numbers[static_cast<size_t>(rig.joints[i].parent)];
  }
  rig.skin = renumbered(rig.skin, numbers);
  pose_again(performed, motions, order);
  return numbers;
}

void change(RiggedMotion& performed, const RenameBone& edit) {
  RigJoint& joint = joint_of(performed.rig, edit.joint);
  US_CHECK(edit.name.find_first_not_of(" \t\r\n") != std::string::npos, "a bone must have a name");
  US_CHECK(edit.name == joint.name || bone_named(performed.rig, edit.name) < 0, "another bone is called ",
           edit.name);
  joint.name = edit.name;
}

/// Vertices in the brush that hang together with its middle there.
std::vector<Eigen::Index> under_brush(const Mesh& surface, const PaintBone& brush, const Vec3& at) {
  const Points& places = surface.vertices;
  if (places.rows() == 0) return {};
  const Eigen::VectorXf far = (places.rowwise() - at.transpose()).rowwise().norm();
  const auto inside = [&](Eigen::Index v) { return far[v] < brush.radius_m; };
  UnionFind pieces(static_cast<size_t>(places.rows()));
  std::map<std::array<float, 3>, int> first_at;  // exporters split vertices where textures have seams
  for (int v = 0; v < places.rows(); ++v)
    if (inside(v))
      pieces.join(v, first_at.try_emplace({places(v, 0), places(v, 1), places(v, 2)}, v).first->second);
  for (const auto& face : surface.faces.rowwise())
    for (int k = 0; k < 3; ++k)
      if (inside(face[k]) && inside(face[(k + 1) % 3])) pieces.join(face[k], face[(k + 1) % 3]);
  int nearest = 0;
  far.minCoeff(&nearest);
  std::vector<Eigen::Index> found;
  for (int v = 0; v < places.rows(); ++v)
    if (inside(v) && (surface.is_cloud() || pieces.root(v) == pieces.root(nearest))) found.push_back(v);
  return found;
}

/// One vertex: `amount` of the way to the bone's weight 1, or 0. heir: who has what is taken where nobody
/// else is there, -1: none.
void paint_row(SkinWeights& skin, Eigen::Index v, const PaintBone& brush, float amount, int heir) {
  auto weights = skin.weights.row(v);
  auto bones = skin.bones.row(v);
  const bool adds = brush.mode == BrushMode::Add;
  int own = -1, least = 0;
  for (int k = 0; k < kSkinBones; ++k) {
    if (bones[k] == brush.joint && weights[k] > 0) own = k;
    if (weights[k] < weights[least]) least = k;
  }
  if (own < 0) {
    if (!adds || amount < weights[least]) return;
    own = least;
    bones[own] = brush.joint;
    weights[own] = 0;
  }
  const float others = weights.sum() - weights[own],
              wanted = adds ? weights[own] + amount * (1 - weights[own]) : weights[own] * (1 - amount);
  if (others > kNoWeight) {
    weights *= (1 - wanted) / others;
  } else if (!adds && heir >= 0) {
    const int slot = own == 0 ? 1 : 0;
    bones[slot] = heir;
    weights.setZero();
    weights[slot] = 1 - wanted;
  } else {
    return;
  }
  weights[own] = wanted;
  weights /= weights.sum();
}

/// `amounts`: of the way to the mean, of each vertex under a dab.
void smooth_rows(Rig& rig, const std::vector<Eigen::Index>& under, const std::vector<float>& amounts) {
  constexpr int kNearest = 7;  // itself and six more
  if (under.empty()) return;
  const PointTree tree(rig.surface.vertices(under, Eigen::all));
  const SkinWeights skin{rig.skin.bones(under, Eigen::all), rig.skin.weights(under, Eigen::all)};
  const RowMatrix before = skin.dense(rig.count());
  RowMatrix after = before;
  std::vector<PointTree::Near> near;
  for (Eigen::Index i = 0; i < before.rows(); ++i) {
    tree.nearest(tree.points().row(i).transpose(), kNearest, near);
    Eigen::RowVectorXf mean = Eigen::RowVectorXf::Zero(before.cols());
    for (const PointTree::Near& one : near) mean += before.row(one.point) / static_cast<float>(near.size());
    after.row(i) += amounts[static_cast<size_t>(i)] * (mean - before.row(i));
  }
  const SkinWeights smooth = SkinWeights::from(after);
  rig.skin.bones(under, Eigen::all) = smooth.bones;
  rig.skin.weights(under, Eigen::all) = smooth.weights;
}

void dab(Rig& rig, const PaintBone& edit, const Vec3& at) {
  const int parent = rig.joints[static_cast<size_t>(edit.joint)].parent;
  const int heir = parent >= 0 ? parent : rig.count() > 1 ? 1 : -1;
  const std::vector<Eigen::Index> under = under_brush(rig.surface, edit, at);
  std::vector<float> amounts;
  for (const Eigen::Index v : under) {
    const float far = (rig.surface.vertices.row(v).transpose() - at).norm() / edit.radius_m;
    amounts.push_back(edit.strength * (1 - smooth_step(0, 1, far)));
  }
  if (edit.mode == BrushMode::Smooth) return smooth_rows(rig, under, amounts);
  for (size_t i = 0; i < under.size(); ++i) paint_row(rig.skin, under[i], edit, amounts[i], heir);
}

void change(RiggedMotion& performed, const PaintBone& edit) {
  joint_of(performed.rig, edit.joint);
  US_CHECK(!edit.at.empty(), "a stroke without a place paints nothing");
  for (const Vec3& at : edit.at) check_place(at);
  US_CHECK(edit.radius_m > 0 && std::isfinite(edit.radius_m), "a brush of ", edit.radius_m,
           " metres paints nothing");
  US_CHECK(edit.strength >= 0 && edit.strength <= 1, "a brush's strength must be in 0..1, not ",
           edit.strength);
  for (const Vec3& at : edit.at) dab(performed.rig, edit, at);
}

/// As much of the turn as the joint allows.
Vec3 allowed_turn(const Rig& rig, const TurnBone& edit) {
  const RigJoint& joint = joint_of(rig, edit.joint);
  US_CHECK(edit.axis_angle.allFinite(), "a turn must be three finite numbers");
  US_CHECK(joint.kind != JointKind::Slider && joint.kind != JointKind::Fixed, joint.name,
           " does not turn: its joint is ", joint.kind == JointKind::Fixed ? "fixed" : "a slider");
  return joint.kind == JointKind::Hinge ? Vec3(joint.axis.dot(edit.axis_angle) * joint.axis)
                                        : edit.axis_angle;
}

void change(RiggedMotion& performed, const TurnBone& edit) {
  const Vec3 turn = allowed_turn(performed.rig, edit);
  check_frames(performed.motion, edit.frame, edit.frame);
  for (size_t t = 0; t < performed.motion.poses.size(); ++t) {
    const float amount = falloff_weight(static_cast<int>(t), edit.frame, edit.falloff);
    Mat3& R = performed.motion.poses[t].turns[static_cast<size_t>(edit.joint)];
    if (amount > 0) R = R * rotation_from_axis_angle(amount * turn);
  }
}

void change(RiggedMotion& performed, const SmoothBones& edit) {
  if (edit.joint) joint_of(performed.rig, *edit.joint);
  check_frames(performed.motion, edit.first, edit.last);
  const std::vector<float> half = half_gaussian(edit.strength, static_cast<float>(performed.motion.fps));
  const auto frames = static_cast<size_t>(edit.last - edit.first + 1);
  const auto pose = [&](size_t i) -> RigPose& {
    return performed.motion.poses[static_cast<size_t>(edit.first) + i];
  };
  const auto smooth = [&](auto values, const auto& filter, const auto& member) {
    values.resize(frames);
    for (size_t i = 0; i < frames; ++i) values[i] = member(pose(i));
    values = filter(values, half);
    for (size_t i = 0; i < frames; ++i) member(pose(i)) = values[i];
  };
  for (size_t j = 0; j < performed.rig.joints.size(); ++j) {
    if (edit.joint && static_cast<size_t>(*edit.joint) != j) continue;
    smooth(std::vector<Mat3>(), filtered_rotations, [j](RigPose& p) -> Mat3& { return p.turns[j]; });
    smooth(std::vector<float>(), filtered<float>, [j](RigPose& p) -> float& { return p.slides[j]; });
    if (j == 0) smooth(std::vector<Vec3>(), filtered<Vec3>, [](RigPose& p) -> Vec3& { return p.root; });
  }
}

void change(RiggedMotion& performed, const KeepFrames& edit) {
  check_frames(performed.motion, edit.first, edit.last);
  std::vector<RigPose>& poses = performed.motion.poses;
  poses.erase(poses.begin() + edit.last + 1, poses.end());
  poses.erase(poses.begin(), poses.begin() + edit.first);
}

void change(RiggedMotion&, const FitAgain&) {
  throw Error("poses are fitted again to scans: there are none");
}

}  // namespace

Vec3 middle_of_bone(const Rig& rig, int joint) {
  const BoneSpread spread = spread_of(rig, joint);
  return spread.weight > 0 ? spread.middle : rig.joints[static_cast<size_t>(joint)].rest;
}

std::vector<int> apply(RiggedMotion& performed, const RigEdit& edit) {
  for (const RigPose& pose : performed.motion.poses)
    US_CHECK(
        pose.turns.size() == performed.rig.joints.size() && pose.slides.size() == performed.rig.joints.size(),
        "a pose of ", pose.turns.size(), " joints for a rig of ", performed.rig.joints.size());
  const auto one = [&](const auto& kind) {
    if constexpr (std::is_void_v<decltype(change(performed, kind))>) {
      change(performed, kind);
      return same_numbers(performed.rig);
    } else {
      return change(performed, kind);
    }
  };
  return std::visit(one, edit);
}

RigPose turned(const Rig& rig, const RigPose& pose, const TurnBone& edit) {
  const Vec3 turn = allowed_turn(rig, edit);
  RigPose after = pose;
  Mat3& R = after.turns.at(static_cast<size_t>(edit.joint));
  R = R * rotation_from_axis_angle(turn);
  return after;
}

std::vector<int> merge_into_parent(Rig& rig, int joint) {
  US_CHECK(joint > 0 && joint < rig.count(), "joint ", joint, " of ", rig.count(),
           " has no parent to become one with");
  const int parent = rig.joints[static_cast<size_t>(joint)].parent;
  std::vector<int> numbers(rig.joints.size());
  for (int j = 0; j < rig.count(); ++j)
    numbers[static_cast<size_t>(j)] = j == joint ? parent : j > joint ? j - 1 : j;
  rig.joints.erase(rig.joints.begin() + joint);
  for (RigJoint& other : rig.joints)
    if (other.parent >= 0) other.parent = numbers[static_cast<size_t>(other.parent)];
  rig.skin = renumbered(rig.skin, numbers);
  return numbers;
}

SkinWeights renumbered(const SkinWeights& skin, const std::vector<int>& numbers) {
  SkinWeights result = skin;
  for (Eigen::Index v = 0; v < skin.size(); ++v)
    for (int k = 0; k < kSkinBones; ++k) {
      result.bones(v, k) = numbers[static_cast<size_t>(skin.bones(v, k))];
      for (int before = 0; before < k; ++before) {
        if (result.bones(v, before) != result.bones(v, k)) continue;
        result.weights(v, before) += result.weights(v, k);
        result.weights(v, k) = 0;
        break;
      }
    }
  return result;
}

}  // namespace understudy
