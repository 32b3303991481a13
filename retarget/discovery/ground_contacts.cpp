#include "retarget/discovery/ground_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/discovery/articulated_fit.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kTouching = 0.02f;  // of the body's size, above the ground
constexpr float kStill = 0.35f;     // sizes a second
constexpr double kLowestOf = 10;    // percentile of the frames' lowest points
constexpr size_t kEases = 3;        // frames before and after it
constexpr int kShortest = 3;        // frames of a contact that bones bend for
constexpr float kMostBent = 0.06f;  // of the body's size: what is further off stays where it is

/// Points of a rig's surface, sorted by the bone that carries them most.
class Soles {
 public:
  explicit Soles(const Rig& rig) : of_bone(rig.joints.size()) {
    constexpr int kSolePoints = 1500;
    constexpr uint64_t kSoleSeed = 20240617;
    points_ = thinned(rig.surface, kSolePoints, kSolePoints, kSoleSeed).points;
    skin_ = weights_between(points_, rig.surface.vertices, rig.skin, rig.count());
    for (Eigen::Index i = 0; i < points_.rows(); ++i)
      of_bone[static_cast<size_t>(skin_.main_bone(i))].push_back(static_cast<int>(i));
    size = box_diagonal(points_);
  }
  Points posed(const Rig& rig, const RigPose& pose) const {
    return skinned(points_, skin_, bone_motions(rig, pose));
  }
  Vec3 point(const BoneMotions& bones, int number) const {
    Vec3 at = Vec3::Zero();
    for (int k = 0; k < kSkinBones; ++k)
      if (skin_.weights(number, k) > 0)
        at += skin_.weights(number, k) *
              bones[static_cast<size_t>(skin_.bones(number, k))](points_.row(number).transpose());
    return at;
  }
  /// The lowest point of a bone; -1: it has none.
  int lowest(const Points& at, size_t bone) const {
    const auto& own = of_bone[bone];
    const auto found =
        std::min_element(own.begin(), own.end(), [&](int a, int b) { return at(a, 1) < at(b, 1); });
    return found == own.end() ? -1 : *found;
  }

  std::vector<std::vector<int>> of_bone;
  float size = 1;

 private:
  Points points_;
  SkinWeights skin_;
};

float ground_of(const std::vector<Points>& frames) {
  std::vector<double> lowest;
  lowest.reserve(frames.size());
  for (const Points& at : frames) lowest.push_back(static_cast<double>(at.col(1).minCoeff()));
  return lowest.empty() ? 0 : static_cast<float>(percentile(lowest, kLowestOf));
}

/// Between frames that are known, linearly; flat before and after.
void fill_between(const std::vector<char>& known, std::vector<float>& values) {
  const auto count = static_cast<int>(ssize(values));
  int before = -1;
  for (int t = 0; t <= count; ++t) {
    if (t < count && !known[static_cast<size_t>(t)]) continue;
    for (int u = before + 1; u < t; ++u) {
      const float a = before >= 0 ? values[static_cast<size_t>(before)] : 0,
                  b = t < count ? values[static_cast<size_t>(t)] : 0;
      const float share = static_cast<float>(u - before) / static_cast<float>(t - before);
      values[static_cast<size_t>(u)] = before < 0 ? b : t == count ? a : a + share * (b - a);
    }
    before = t;
  }
}

void smooth(std::vector<float>& values) {
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<float> next = values;
    for (size_t t = 1; t + 1 < values.size(); ++t)
      next[t] = 0.25f * values[t - 1] + 0.5f * values[t] + 0.25f * values[t + 1];
    values = next;
  }
}

/// Makes a performance stand.
class Standing {
 public:
  Standing(float ground, const std::vector<std::vector<char>>& touches, RiggedMotion& body)
      : ground_(ground), touches_(touches), body_(body), soles_(body.rig) {}
  void correct_path();
  void bend();

 private:
  RigPose& pose(size_t t) { return body_.motion.poses[t]; }
  Vec3 point(size_t t, int number) { return soles_.point(bone_motions(body_.rig, pose(t)), number); }
  void hold(size_t bone, size_t first, size_t end);
  void reach(size_t t, size_t bone, int number, const Vec3& to);

  float ground_;
  const std::vector<std::vector<char>>& touches_;
  RiggedMotion& body_;
  Soles soles_;
};

/// The body goes as those that stand push it, and is as high as they are.
void Standing::correct_path() {
  const size_t frames = body_.motion.poses.size();
  std::vector<float> height(frames, 0);
  std::vector<char> known(frames, 0);
  std::vector<Vec3> shift(frames, Vec3::Zero());
  Points before;
  for (size_t t = 0; t < frames; ++t) {
    const Points at = soles_.posed(body_.rig, pose(t));
    float lowest = 0;
    Vec3 slid = Vec3::Zero();
    int stood = 0;
    for (size_t b = 0; b < body_.rig.joints.size(); ++b) {
      if (!touches_[t][b]) continue;
      const int number = soles_.lowest(at, b);
      if (number < 0) continue;
      lowest = known[t] ? std::min(lowest, at(number, 1)) : at(number, 1);
      known[t] = 1;
      if (t == 0 || !touches_[t - 1][b]) continue;
      slid += (at.row(number) - before.row(number)).transpose();
      ++stood;
    }
    height[t] = known[t] ? ground_ - lowest : 0;
    if (t > 0) shift[t] = shift[t - 1];
    if (stood > 0) shift[t] -= slid / static_cast<float>(stood);
    before = at;
  }
  if (std::find(known.begin(), known.end(), 1) == known.end()) return;
  fill_between(known, height);
  smooth(height);
  for (size_t t = 0; t < frames; ++t) pose(t).root += Vec3(shift[t].x(), height[t], shift[t].z());
}

/// Turns the bone and the one that carries it, each so that the point comes nearest to where it shall be.
void Standing::reach(size_t t, size_t bone, int number, const Vec3& to) {
  constexpr int kReaches = 8;
  constexpr float kMostTurn = 0.15f;  // radians a round
  for (int round = 0; round < kReaches; ++round)
    for (const int turned : {body_.rig.joints[bone].parent, static_cast<int>(bone)}) {
      if (turned <= 0) continue;  // the root stays
      const BoneMotions bones = bone_motions(body_.rig, pose(t));
      const auto joint = static_cast<size_t>(turned);
      const Vec3 centre = bones[joint](body_.rig.joints[joint].rest);
      const Vec3 is = point(t, number) - centre, wanted = to - centre;
      if (is.norm() < 1e-6f || wanted.norm() < 1e-6f) continue;
      Vec3 turn = rotation_to_axis_angle(rotation_between(is, wanted));
      if (turn.norm() > kMostTurn) turn *= kMostTurn / turn.norm();
      const Mat3& parent = bones[static_cast<size_t>(body_.rig.joints[joint].parent)].R;
      pose(t).turns[joint] = nearest_rotation(parent.transpose() * rotation_from_axis_angle(turn) * parent *
                                              pose(t).turns[joint]);
    }
}

/// One contact: the point that is lowest in its middle stays where it is on average.
void Standing::hold(size_t bone, size_t first, size_t end) {
  const size_t middle = (first + end) / 2;
  const int number = soles_.lowest(soles_.posed(body_.rig, pose(middle)), bone);
  if (number < 0) return;
  Vec3 anchor = Vec3::Zero();
  for (size_t t = first; t < end; ++t) anchor += point(t, number) / static_cast<float>(end - first);
  anchor.y() = std::max(ground_, std::min(anchor.y(), ground_ + kTouching * soles_.size));
  const auto pull = [&](size_t t, const Vec3& off) {
    if (off.norm() < kMostBent * soles_.size) reach(t, bone, number, point(t, number) + off);
  };
  const Vec3 at_first = anchor - point(first, number), at_last = anchor - point(end - 1, number);
  for (size_t t = first; t < end; ++t) pull(t, anchor - point(t, number));
  for (size_t i = 1; i <= kEases; ++i) {  // it comes and goes smoothly
    const float share = 1 - static_cast<float>(i) / (kEases + 1);
    if (i <= first && !touches_[first - i][bone]) pull(first - i, share * at_first);
    const size_t after = end - 1 + i;
    if (after < touches_.size() && !touches_[after][bone]) pull(after, share * at_last);
  }
}

void Standing::bend() {
  const size_t frames = body_.motion.poses.size();
  for (size_t b = 1; b < body_.rig.joints.size(); ++b)
    for (size_t t = 0; t < frames;) {
      size_t end = t;
      while (end < frames && touches_[end][b]) ++end;
      if (end - t >= kShortest) hold(b, t, end);
      t = std::max(end, t + 1);
    }
}

}  // namespace

GroundContacts ground_contacts(const RiggedMotion& body) {
  const Soles soles(body.rig);
  std::vector<Points> frames;
  for (const RigPose& pose : body.motion.poses) frames.push_back(soles.posed(body.rig, pose));
  GroundContacts contacts;
  contacts.ground = ground_of(frames);
  contacts.touches.assign(frames.size(), std::vector<char>(body.rig.joints.size(), 0));
  const auto fps = static_cast<float>(body.motion.fps);
  for (size_t t = 0; t < frames.size(); ++t)
    for (size_t b = 0; b < body.rig.joints.size(); ++b) {
      const int number = soles.lowest(frames[t], b);
      if (number < 0 || frames[t](number, 1) > contacts.ground + kTouching * soles.size) continue;
      const size_t before = t > 0 ? t - 1 : t, after = std::min(t + 1, frames.size() - 1);
      const float moved = (frames[after].row(number) - frames[before].row(number)).norm();
      const float seconds = static_cast<float>(std::max<size_t>(1, after - before)) / fps;
      contacts.touches[t][b] = moved < kStill * soles.size * seconds;
    }
  return contacts;
}

void stand_on(float ground, const std::vector<std::vector<char>>& touches, RiggedMotion& performance) {
  Standing standing(ground, touches, performance);
  standing.correct_path();
  standing.bend();
}

void bend_onto(float ground, const std::vector<std::vector<char>>& touches, RiggedMotion& performance) {
  Standing(ground, touches, performance).bend();
}

}  // namespace understudy
