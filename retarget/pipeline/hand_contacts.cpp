#include "retarget/pipeline/hand_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/segment.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

constexpr int kTrunkSamples = 600, kHandSamples = 40, kArmSamples = 40;
constexpr int kHandActors = 14, kForearmActors = 6;  // what is kept out and held
constexpr int kInfluences = 4;
constexpr float kMeanFrames = 90;  // frames that the mean bone lengths remember
constexpr float kReach = 0.15f;    // metres around a hand in which surfaces count
constexpr float kBlur = 0.02f;     // metres over which neighbouring samples are blended
// A gap, metres, up to which a hand is held where it is on the source, and from which it is let go.
constexpr float kNear = 0.02f, kFar = 0.06f;
constexpr float kSnap = 0.5f;       // how much of the gap of a hand that is held is closed
constexpr float kPlace = 0.3f;      // 0 the same gap only .. 1 at the same place, too
constexpr float kForearms = 0.3f;   // how far forearms are pushed out of the body, 0..1
constexpr float kSettle_s = 0.08f;  // time constant in which a correction comes and goes
constexpr float kMost_m = 0.20f;    // a hand is moved no further (leg 0.8 m)

/// The vertices, or an even share of them where they are very many.
std::vector<int> thinned(const std::vector<int>& vertices) {
  const size_t step = std::max<size_t>(1, vertices.size() / 6000);
  std::vector<int> result;
  for (size_t i = 0; i < vertices.size(); i += step) result.push_back(vertices[i]);
  return result;
}

/// 0 left, 1 right arm; -1 none.
int arm_of(int joint) {
  switch (joint) {
    case LeftShoulder:
    case LeftElbow:
    case LeftWrist:
      return 0;
    case RightShoulder:
    case RightElbow:
    case RightWrist:
      return 1;
    default:
      return -1;
  }
}

float lookup(const std::array<float, BodyGirth::kDirections>& radius, float direction) {
  const int low = static_cast<int>(direction) % BodyGirth::kDirections;
  const float t = direction - std::floor(direction);
  const auto at = [&](int d) { return radius[d % BodyGirth::kDirections]; };
  return (1 - t) * at(low) + t * at(low + 1);
}

}  // namespace

struct HandContacts::Body {
  struct Sample {
    std::array<int, kInfluences> joint{};
    std::array<float, kInfluences> weight{};
    int owner = 0;      // the joint that it follows most
    int arm = -1;       // that it is of
    float follows = 0;  // how far it moves with its arm's wrist: 1 the hand, less towards the elbow
    GirthPlace place;
  };
  Joints rest;
  Points points, normals;  // of the samples in T-pose
  std::vector<Sample> samples;
  Eigen::VectorXf follows;                          // theirs
  std::array<std::vector<int>, 2> hands, forearms;  // some samples of each: what is held and kept out
  BodyGirth girth;

  Sample sample_of(const RowMatrix& weights, int vertex, const Vec3& point) const;
};

HandContacts::Body::Sample HandContacts::Body::sample_of(const RowMatrix& weights, int vertex,
                                                         const Vec3& point) const {
  Sample sample;
  Eigen::Array<float, kJointCount, 1> row = weights.row(vertex).transpose().array();
  float sum = 0;
  for (size_t i = 0; i < kInfluences; ++i) {
    sample.weight[i] = row.maxCoeff(&sample.joint[i]);
    row[sample.joint[i]] = -1;
    sum += sample.weight[i];
  }
  for (float& w : sample.weight) w /= std::max(sum, 1e-6f);
  sample.owner = sample.joint[0];
  sample.arm = arm_of(sample.owner);
  sample.place = girth_place(point, rest, identity_rotations());
  if (sample.arm < 0) return sample;
  sample.follows = along_segment(point, rest.row(LeftElbow + sample.arm).transpose(),
                                 rest.row(LeftWrist + sample.arm).transpose());
  return sample;
}

void HandContacts::bind(const Mesh& target, const Joints& rest, const RowMatrix& weights) {
  const Points& vertices = target.vertices;
  US_CHECK(weights.rows() == vertices.rows() && weights.cols() == kJointCount, "skin weights of ",
           weights.rows(), " vertices do not fit a target of ", vertices.rows());
  auto body = std::make_shared<Body>();
  body->rest = rest;
  body->girth = measure_girth(rest, identity_rotations(), vertices);
  RunningGirth whole;
  whole.push(body->girth);
  body->girth = whole.value(leg_length(rest));
  std::array<std::vector<int>, kJointCount + 1> of;  // vertices by owner; last: all but arms
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    int owner = 0;
    weights.row(v).maxCoeff(&owner);
    if (vertices.row(v).allFinite()) of[arm_of(owner) < 0 ? kJointCount : owner].push_back(v);
  }
  std::vector<int> chosen = far_apart(vertices, thinned(of[kJointCount]), kTrunkSamples);
  for (int side = 0; side < 2; ++side)
    for (const int joint : {LeftWrist + side, LeftElbow + side, LeftShoulder + side}) {
      const bool hand = joint == LeftWrist + side;
      const auto some = far_apart(vertices, thinned(of[joint]), hand ? kHandSamples : kArmSamples);
      const int actors = hand ? kHandActors : joint == LeftElbow + side ? kForearmActors : 0;
      for (size_t i = 0; i < some.size(); ++i) {
        if (static_cast<int>(i) < actors)
          (hand ? body->hands : body->forearms)[side].push_back(chosen.size());
        chosen.push_back(some[i]);
      }
    }
  const Eigen::Index count = chosen.size();
  const Points normals = target.is_cloud() ? Points() : vertex_normals(vertices, target.faces);
  body->points.resize(count, 3);
  body->normals.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int v = chosen[i];
    const Vec3 point = vertices.row(v).transpose();
    body->samples.push_back(body->sample_of(weights, v, point));
    body->points.row(i) = point.transpose();
    const Vec3 radial = body->samples.back().place.radial.normalized();
    const bool known = !target.is_cloud() && normals.row(v).squaredNorm() > 0.5f;
    body->normals.row(i) = radial.transpose();
    if (known) body->normals.row(i) = normals.row(v);
  }
  body->follows.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) body->follows[i] = body->samples[i].follows;
  body_ = std::move(body);
  reset();
}

void HandContacts::reset() {
  girth_.clear();
  lengths_.setZero();
  frames_ = 0;
  offset_.fill(Vec3::Zero());
}

void HandContacts::learn(const Joints& source, const std::optional<BodyGirth>& girth) {
  frames_ = std::min(frames_ + 1, kMeanFrames);
  lengths_ += (bone_lengths(source) - lengths_) / frames_;
  if (girth) girth_.push(*girth);
}

/// The samples on the source in T-pose: the target's, with the source's bones and girth.
Points HandContacts::source_rest(const Joints& rest_a) const {
  const Body& body = *body_;
  const BodyGirth girth = girth_.value(leg_length(rest_a));
  const Eigen::Array<float, kJointCount, 1> longer =
      bone_lengths(rest_a) / bone_lengths(body.rest).max(1e-4f);  // of the bone that ends at the joint
  Points result(body.points.rows(), 3);
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    const GirthPlace& place = body.samples[i].place;
    const float scale = longer[place.end >= 0 ? place.end : place.joint];
    float thicker = scale;
    if (place.station >= 0) {
      const size_t s = place.station;
      thicker = lookup(girth.radius[s], place.direction) / lookup(body.girth.radius[s], place.direction);
    }
    // along the bone
    const Vec3 axial = (body.points.row(i) - body.rest.row(place.joint)).transpose() - place.radial;
    result.row(i) = rest_a.row(place.joint) + scale * axial.transpose() +
                    std::clamp(thicker, 0.3f, 3.0f) * place.radial.transpose();
  }
  return result;
}

namespace {

/// A point against a surface of samples.
struct Touch {
  float gap = INFINITY;          // metres, below 0 inside; none within reach: infinity
  Vec3 normal = Vec3::UnitY();   // of the surface there
  Vec3 on_other = Vec3::Zero();  // the same place on the other body's surface
  float moves = 0;               // 0..1: how far the surface moves with the other hand
};

/// The surface looked at, and the other body's.
struct Surface {
  const Eigen::Matrix3Xf &from, &to, &normals;
  const Eigen::VectorXf& follows;
};

/// samples: those that count. Blends the nearest with its neighbours that face the same way: hands are thin.
Touch touch(const Vec3& point, const std::vector<int>& samples, const Surface& surface) {
  const auto& [from, to, normals, follows] = surface;
  Touch result;
  float nearest = kReach * kReach;
  int first = -1;
  for (const int k : samples) {
    const float squared = (point - from.col(k)).squaredNorm();
    if (squared < nearest) nearest = squared, first = k;
  }
  if (first < 0) return result;
  const Vec3 facing = normals.col(first);
  const float distance = std::sqrt(nearest), reach = distance + 2.5f * kBlur;
  float sum = 0, plane = 0;
  Vec3 normal = Vec3::Zero(), place = Vec3::Zero();
  for (const int k : samples) {
    const Vec3 d = point - from.col(k);
    const float squared = d.squaredNorm();
    if (squared > reach * reach) continue;
    const float alike = normals.col(k).dot(facing);
    if (alike <= 0.3f) continue;
    const float w = (alike - 0.3f) * std::exp((nearest - squared) / (2 * kBlur * kBlur));
    const float above = d.dot(normals.col(k));
    sum += w;
    plane += w * above;
    normal += w * normals.col(k);
    place += w * (to.col(k) + d - above * normals.col(k));
    result.moves += w * follows[k];
  }
  plane /= sum;
  result.moves /= sum;
  result.normal = normal.normalized();
  result.on_other = place / sum;
  const float beside = std::sqrt(std::max(0.0f, nearest - 0.03f * 0.03f));  // less what samples lie apart
  result.gap = plane >= 0 ? std::max(plane, beside) : distance < 0.05f - 1.5f * plane ? plane : beside;
  return result;
}

}  // namespace

/// One frame: both bodies' samples in the world.
struct HandContacts::Scene {
  Eigen::Matrix3Xf a, b, normals;  // source, target, normals of both
  Eigen::Matrix3Xf moved;          // b with its arms where the hands are wanted so far
};

/// The samples near some of an arm's, on either body, but for the arm's own.
std::vector<int> HandContacts::near(const Scene& scene, int side, const std::vector<int>& actors) const {
  std::vector<int> result;
  if (actors.empty()) return result;
  Vec3 middle_a = Vec3::Zero(), middle_b = Vec3::Zero();
  for (const int i : actors) middle_a += scene.a.col(i), middle_b += scene.b.col(i);
  middle_a /= static_cast<float>(actors.size()), middle_b /= static_cast<float>(actors.size());
  float reach = 0;
  for (const int i : actors) reach = std::max(reach, (scene.b.col(i) - middle_b).norm());
  reach += kReach;
  for (size_t k = 0; k < body_->samples.size(); ++k) {
    const Eigen::Index c = k;
    if (body_->samples[k].arm != side && ((scene.a.col(c) - middle_a).squaredNorm() < reach * reach ||
                                          (scene.b.col(c) - middle_b).squaredNorm() < reach * reach))
      result.push_back(k);
  }
  return result;
}

/// How far the hand is to be moved so that it is where the source's is. held: 0..1, how much it is.
Vec3 HandContacts::pull(const Scene& scene, const std::vector<int>& hand, const std::vector<int>& near,
                        float& held) const {
  constexpr float kClear = 0.01f;  // metres: out of the body, that will do
  float sum = 0;
  Vec3 pull = Vec3::Zero();
  held = 0;
  for (const int i : hand) {
    const Touch source = touch(scene.a.col(i), near, {scene.a, scene.moved, scene.normals, body_->follows});
    const float w = 1 - smooth_step(kNear, kFar, source.gap);
    if (w <= 0) continue;
    // Nearer than seen: what touches is seen now above the skin, now below. Hands may hold each other.
    const float gap = std::max(source.gap * (1 - kSnap * w), -0.005f - 0.03f * source.moves);
    const Vec3 way = source.on_other + gap * source.normal - scene.moved.col(i);
    const float along = way.dot(source.normal);
    const float needed = along > 0 ? std::max(0.0f, along - std::max(0.0f, gap - kClear)) : along;
    const Vec3 part = needed * source.normal + kPlace * (way - along * source.normal);
    held = std::max(held, w);
    sum += w;
    pull += w * (1 - 0.5f * source.moves) * part;  // two hands: each half
  }
  return sum > 0 ? Vec3(held / sum * pull) : pull;
}

/// How far the hand is to be moved so that it is, or the forearm is, no deeper in the body than the source's.
Vec3 HandContacts::push_out(const Scene& scene, const std::vector<int>& actors,
                            const std::vector<int>& near) const {
  float deepest = 0;
  Vec3 push = Vec3::Zero();
  for (const int i : actors) {
    const float follows = body_->follows[i];
    if (follows < 0.3f) continue;
    const Touch target =
        touch(scene.moved.col(i), near, {scene.moved, scene.moved, scene.normals, body_->follows});
    if (target.gap >= 0) continue;
    const Touch source = touch(scene.a.col(i), near, {scene.a, scene.moved, scene.normals, body_->follows});
    const float need = (1 - target.moves) * (std::min(0.0f, source.gap) - target.gap);
    if (need <= 0) continue;
    push += need * need * target.normal;
    deepest = std::max(deepest, need);
  }
  return push.norm() > 1e-9f ? Vec3(deepest * push.normalized()) : push;
}

/// How far each wrist is to be moved, world.
std::array<Vec3, 2> HandContacts::wanted(Scene& scene) const {
  std::array<Vec3, 2> moved = {Vec3::Zero(), Vec3::Zero()};
  std::array<float, 2> held{};
  std::array<std::vector<int>, 2> near_hand, near_forearm;
  for (size_t s = 0; s < 2; ++s) {
    near_hand[s] = near(scene, s, body_->hands[s]);
    near_forearm[s] = near(scene, s, body_->forearms[s]);
  }
  for (int pass = 0; pass < 3; ++pass) {
    scene.moved = scene.b;
    for (size_t k = 0; k < body_->samples.size(); ++k)
      if (const int arm = body_->samples[k].arm; arm >= 0)
        scene.moved.col(k) += body_->samples[k].follows * moved[arm];
    std::array<Vec3, 2> step;
    for (size_t s = 0; s < 2; ++s) {
      if (pass < 2) {
        step[s] = pull(scene, body_->hands[s], near_hand[s], held[s]);
      } else {  // a hand that is held stays, whatever its forearm does
        const float free = kForearms * (1 - held[s]);
        step[s] = push_out(scene, body_->hands[s], near_hand[s]);
        if (free > 0) step[s] += free * push_out(scene, body_->forearms[s], near_forearm[s]);
      }
    }
    for (size_t s = 0; s < 2; ++s) moved[s] += step[s];
  }
  return moved;
}

Pose HandContacts::push(const Pose& pose, const Joints& source, const std::optional<BodyGirth>& girth,
                        float dt, const Rotations* local_a) {
  US_CHECK(body_, "hand contacts need a target first");
  US_CHECK(source.allFinite(), "the source's joints are not finite");
  learn(source, girth);
  const Body& body = *body_;
  const PosedSkeleton posed = forward_kinematics(body.rest, pose);
  const Rotations global_a = local_a ? global_rotations(*local_a) : posed.global;
  const Joints rest_a = rest_with_lengths(body.rest, lengths_);
  const Points points_a = source_rest(rest_a);
  const auto count = body.points.rows();
  Scene scene{Eigen::Matrix3Xf(3, count), Eigen::Matrix3Xf(3, count), Eigen::Matrix3Xf(3, count), {}};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Body::Sample& sample = body.samples[i];
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    for (size_t k = 0; k < kInfluences && sample.weight[k] > 0.01f; ++k) {
      const int j = sample.joint[k];
      a += sample.weight[k] *
           (global_a[j] * (points_a.row(i) - rest_a.row(j)).transpose() + source.row(j).transpose());
      b += sample.weight[k] * (posed.global[j] * (body.points.row(i) - body.rest.row(j)).transpose() +
                               posed.joints.row(j).transpose());
    }
    scene.a.col(i) = a;
    scene.b.col(i) = b;
    scene.normals.col(i) = posed.global[sample.owner] * body.normals.row(i).transpose();
  }
  const std::array<Vec3, 2> goal = wanted(scene);
  const Mat3& chest = posed.global[Spine3];
  const float follow = frames_ > 1 ? 1 - std::exp(-dt / kSettle_s) : 1.0f;
  const float limit = kMost_m * leg_length(body.rest) / 0.8f;
  Pose result = pose;
  for (int side = 0; side < 2; ++side) {
    Vec3& offset = offset_[side];
    offset += follow * (chest.transpose() * goal[side] - offset);
    if (offset.norm() > limit) offset *= limit / offset.norm();
    if (offset.norm() < 1e-4f) continue;
    place_wrist(body.rest, side, posed.joints.row(LeftWrist + side).transpose() + chest * offset, result);
  }
  return result;
}

}  // namespace understudy
