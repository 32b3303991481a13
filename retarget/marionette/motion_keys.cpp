#include "retarget/marionette/motion_keys.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr double kKeyFades = 1.0 / 3;  // seconds

Mat3 part_of_turn(const Mat3& R, float share) {
  return rotation_from_axis_angle(share * rotation_to_axis_angle(R));
}

/// A turn about the vertical, then a move along the floor.
struct FloorMove {
  float angle = 0;
  Vec3 move = Vec3::Zero();
  Vec3 operator()(const Vec3& place) const { return rotation_about_y(angle) * place + move; }
};

float nearest_turn(float angle) {
  return std::remainder(angle, 2 * kPi);
}

/// Where a pose has to be taken to stand and face as another.
FloorMove floor_move(const RigPose& from, const RigPose& to) {
  FloorMove move;
  move.angle = nearest_turn(heading_of(to.turns[0]) - heading_of(from.turns[0]));
  move.move = to.root - rotation_about_y(move.angle) * from.root;
  move.move.y() = 0;
  return move;
}

/// What a pose lacks of another that stands where it does.
struct Lack {
  float height = 0;
  std::vector<Mat3> turns;
  std::vector<float> slides;
};

Lack lack_of(const RigPose& is, const RigPose& wanted, const FloorMove& placed) {
  Lack lack;
  lack.height = wanted.root.y() - is.root.y();
  for (size_t j = 0; j < is.turns.size(); ++j) {
    const Mat3 own = j == 0 ? Mat3(rotation_about_y(placed.angle) * is.turns[0]) : is.turns[j];
    lack.turns.push_back(own.transpose() * wanted.turns[j]);
    lack.slides.push_back(wanted.slides[j] - is.slides[j]);
  }
  return lack;
}

void add(const Lack& lack, float share, RigPose& pose) {
  pose.root.y() += share * lack.height;
  for (size_t j = 0; j < pose.turns.size(); ++j) {
    pose.turns[j] = nearest_rotation(pose.turns[j] * part_of_turn(lack.turns[j], share));
    pose.slides[j] += share * lack.slides[j];
  }
}

void put_down(const FloorMove& move, RigPose& pose) {
  pose.root = move(pose.root);
  pose.turns[0] = rotation_about_y(move.angle) * pose.turns[0];
}

/// Between two keys, `share` of the way.
void put_between(const FloorMove& before, const FloorMove& after, float share, RigPose& pose) {
  const Vec3 place = (1 - share) * before(pose.root) + share * after(pose.root);
  const float angle = before.angle + share * nearest_turn(after.angle - before.angle);
  pose.turns[0] = rotation_about_y(angle) * pose.turns[0];
  pose.root = place;
}

RigPose between(const RigPose& a, const RigPose& b, float share) {
  RigPose pose = a;
  pose.root = (1 - share) * a.root + share * b.root;
  for (size_t j = 0; j < a.turns.size(); ++j) {
    pose.turns[j] = nearest_rotation(a.turns[j] * part_of_turn(a.turns[j].transpose() * b.turns[j], share));
    pose.slides[j] = (1 - share) * a.slides[j] + share * b.slides[j];
  }
  return pose;
}

/// The keys about a frame, and how far it is from the one to the other.
struct KeysAbout {
  const PoseKey *before, *after;
  float share;
};
KeysAbout keys_about(const std::vector<PoseKey>& keys, int frame) {
  const auto after = std::lower_bound(keys.begin(), keys.end(), frame,
                                      [](const PoseKey& key, int t) { return key.frame < t; });
  if (after == keys.end()) return {&keys.back(), &keys.back(), 0};
  if (after == keys.begin()) return {&*after, &*after, 0};
  const PoseKey& before = *(after - 1);
  return {&before, &*after,
          static_cast<float>(frame - before.frame) / static_cast<float>(after->frame - before.frame)};
}

}  // namespace

void check_keys(const Rig& rig, int frames, const std::vector<PoseKey>& keys) {
  US_CHECK(frames >= 1, "a motion of ", frames, " frames");
  int last = -1;
  for (const PoseKey& key : keys) {
    US_CHECK(key.frame >= 0 && key.frame < frames, "a key at frame ", key.frame, " of ", frames);
    US_CHECK(key.frame > last, "keys have to come one after the other, not frame ", key.frame, " after ",
             last);
    US_CHECK(ssize(key.pose.turns) == rig.count() && ssize(key.pose.slides) == rig.count(), "a key of ",
             key.pose.turns.size(), " joints for a rig of ", rig.count());
    last = key.frame;
  }
}

void meet_keys(const Rig& rig, double fps, const std::vector<PoseKey>& keys, std::vector<RigPose>& poses) {
  check_keys(rig, static_cast<int>(ssize(poses)), keys);
  if (keys.empty()) return;
  std::vector<FloorMove> moves;
  std::vector<Lack> lacks;
  for (const PoseKey& key : keys) {
    const RigPose& is = poses[static_cast<size_t>(key.frame)];
    moves.push_back(floor_move(is, key.pose));
    lacks.push_back(lack_of(is, key.pose, moves.back()));
  }
  const auto fades = static_cast<float>(std::max(1.0, kKeyFades * fps));
  for (int t = 0; t < ssize(poses); ++t) {
    RigPose& pose = poses[static_cast<size_t>(t)];
    const KeysAbout about = keys_about(keys, t);
    const auto a = static_cast<size_t>(about.before - keys.data()),
               b = static_cast<size_t>(about.after - keys.data());
    if (a == b) {
      put_down(moves[a], pose);
      add(lacks[a], std::max(0.0f, 1 - static_cast<float>(std::abs(t - keys[a].frame)) / fades), pose);
    } else {
      put_between(moves[a], moves[b], about.share, pose);
      add(lacks[a], 1 - about.share, pose);
      add(lacks[b], about.share, pose);
    }
  }
  for (const PoseKey& key : keys) poses[static_cast<size_t>(key.frame)] = key.pose;  // to the last bit
}

std::vector<Points> own_places(const Rig& rig, const std::vector<RigPose>& poses) {
  std::vector<Points> places;
  for (RigPose pose : poses) {
    pose.turns[0] = rotation_about_y(-heading_of(pose.turns[0])) * pose.turns[0];
    pose.root.setZero();
    places.push_back(joint_places(rig, bone_motions(rig, pose)));
  }
  return places;
}

std::vector<RigPose> slerp_between(const Rig& rig, const std::vector<PoseKey>& keys, int frames) {
  US_CHECK(!keys.empty(), "there is no key to begin with");
  check_keys(rig, frames, keys);
  std::vector<RigPose> poses;
  for (int t = 0; t < frames; ++t) {
    const KeysAbout about = keys_about(keys, t);
    poses.push_back(between(about.before->pose, about.after->pose, about.share));
  }
  for (const PoseKey& key : keys) poses[static_cast<size_t>(key.frame)] = key.pose;
  return poses;
}

std::vector<RigPose> lerp_between(const Rig& rig, const std::vector<PoseKey>& keys, int frames) {
  std::vector<RigPose> poses = slerp_between(rig, keys, frames);
  for (int t = 0; t < frames; ++t) {
    const KeysAbout about = keys_about(keys, t);
    if (about.share == 0 || about.share == 1) continue;
    const Points places = (1 - about.share) * joint_places(rig, bone_motions(rig, about.before->pose)) +
                          about.share * joint_places(rig, bone_motions(rig, about.after->pose));
    RigPose& pose = poses[static_cast<size_t>(t)];
    pose = pose_at_places(rig, places, pose);
  }
  return poses;
}

RigPose pose_at_places(const Rig& rig, const Points& places, const RigPose& like) {
  US_CHECK(places.rows() == rig.count(), places.rows(), " places for a rig of ", rig.count(), " joints");
  const auto children = children_of(rig);
  BoneMotions bones(rig.joints.size());
  for (size_t j = 0; j < bones.size(); ++j) {
    const RigJoint& joint = rig.joints[j];
    const Vec3 place = places.row(static_cast<Eigen::Index>(j)).transpose();
    Mat3 R = like.turns[j];
    if (joint.parent >= 0) R = bones[static_cast<size_t>(joint.parent)].R * R;
    const std::vector<int>& own = children[j];
    if (own.size() == 1) {
      const Vec3 carried = R * (rig.joints[static_cast<size_t>(own[0])].rest - joint.rest),
                 wanted = places.row(own[0]).transpose() - place;
      if (carried.norm() > 1e-6f && wanted.norm() > 1e-6f) R = rotation_between(carried, wanted) * R;
    } else if (own.size() > 1) {
      Points rest(ssize(own), 3), found(ssize(own), 3);
      for (Eigen::Index i = 0; i < rest.rows(); ++i) {
        rest.row(i) = (R * (rig.joints[static_cast<size_t>(own[static_cast<size_t>(i)])].rest - joint.rest))
                          .transpose();
        found.row(i) = places.row(own[static_cast<size_t>(i)]) - place.transpose();
      }
      // Two children in one line say nothing of the turn about it: a little of what `like` says does.
      Points both(rest.rows() + 3, 3), to(rest.rows() + 3, 3);
      const Mat3 axes = rest.rowwise().norm().maxCoeff() * Mat3::Identity();
      both << rest, axes;
      to << found, axes;
      Eigen::VectorXf weights = Eigen::VectorXf::Ones(both.rows());
      weights.tail(3).setConstant(1e-3f);
      R = kabsch(both, to, weights) * R;
    }
    bones[j] = {R, place - R * joint.rest};
  }
  return pose_of(rig, bones);
}

}  // namespace understudy
