#include "tests/retarget/scene/made_scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/body/cell_image.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/scene/person_evidence.hpp"

namespace understudy::test {
namespace {

const ShapedBody& body_of(float stature) {
  static std::vector<std::pair<float, ShapedBody>> made;
  for (const auto& [known, body] : made)
    if (known == stature) return body;
  PersonOptions options;
  options.stature = stature;
  made.reserve(16);
  return made.emplace_back(stature, builtin_person(options)).second;
}

/// Where a person stands in a frame: the motion as it is, turned about the vertical and moved.
Pose placed(const Actor& actor, const Motion& motion, int t) {
  const int frames = static_cast<int>(motion.poses.size());
  // There and back: nobody jumps.
  const int phase = (actor.first + (actor.is_still ? 0 : t)) % (2 * frames - 2);
  Pose pose = motion.poses[static_cast<size_t>(phase < frames ? phase : 2 * frames - 2 - phase)];
  const Mat3 turn = rotation_about_y(actor.turn_deg * kPi / 180);
  pose.local[Pelvis] = turn * pose.local[Pelvis];
  pose.root = turn * pose.root + actor.place;
  return pose;
}

/// Points as a mirror shows them.
template <class Rows>
void reflect(float x, Rows& points) {
  points.col(0) = 2 * x - points.col(0).array();
}

}  // namespace

MadeScene::MadeScene(std::vector<Actor> actors) {
  for (Actor& actor : actors) {
    const ShapedBody& body = body_of(actor.stature);
    performers_.push_back({std::move(actor), body, {}});
    performers_.back().motion = builtin_motion(performers_.back().actor.motion, body.joints);
  }
}

void MadeScene::add_ground(float half_m, int points, float noise_m, float tilt_deg) {
  const float slope = std::tan(tilt_deg * kPi / 180);
  things_.push_back([=](Rng& rng) {
    Points made(points, 3);
    for (auto row : made.rowwise()) {
      const float x = rng.uniform(-half_m, half_m), z = rng.uniform(-half_m, half_m);
      row << x, slope * x + noise_m * rng.normal(), z;
    }
    return made;
  });
}

void MadeScene::add_box(const Vec3& centre, const Vec3& half, int points) {
  const Vec3 areas(half.y() * half.z(), half.x() * half.z(), half.x() * half.y());
  things_.push_back([=](Rng& rng) {
    Points made(points, 3);
    for (auto row : made.rowwise()) {
      Vec3 at(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      const float pick = rng.uniform(0, areas.sum());
      const int side = pick < areas.x() ? 0 : pick < areas.x() + areas.y() ? 1 : 2;
      at[side] = rng.chance(0.5f) ? 1.0f : -1.0f;
      row = (centre + at.cwiseProduct(half)).transpose() +
            0.004f * Vec3(rng.normal(), rng.normal(), rng.normal()).transpose();
    }
    return made;
  });
}

void MadeScene::add_points(Points points) {
  things_.push_back([points = std::move(points)](Rng&) { return points; });
}

MadeScan MadeScene::frame(int t) const {
  Rng rng(static_cast<uint64_t>(t) + 1);
  MadeScan made;
  std::vector<Vec3> points, colors;
  const auto add = [&](const Points& more, int owner, const Vec3& color) {
    for (const auto& row : more.rowwise()) {
      points.emplace_back(row.transpose());
      colors.push_back(color);
      made.owner.push_back(owner);
    }
  };
  for (size_t k = 0; k < performers_.size(); ++k) {
    const auto& [actor, body, motion] = performers_[k];
    if (t < actor.enters || t >= actor.leaves) continue;
    const Pose pose = placed(actor, motion, t);
    const Mesh surface{posed_vertices(body, pose), body.faces};
    Points skin = sample_points(surface, actor.points, rng);
    Joints joints = forward_kinematics(body.joints, pose).joints;
    if (actor.mirror_x) {
      reflect(*actor.mirror_x, skin);
      reflect(*actor.mirror_x, joints);
      joints = Joints(joints(kMirror, Eigen::all));
    }
    add(skin, static_cast<int>(k) + 1, actor.color);
    made.joints.push_back(joints);
  }
  for (const auto& thing : things_) add(thing(rng), kGround, Vec3::Constant(0.3f));
  made.scan.vertices = Eigen::Map<const Points>(reinterpret_cast<const float*>(points.data()),
                                                static_cast<Eigen::Index>(points.size()), 3);
  made.scan.colors = Eigen::Map<const Points>(reinterpret_cast<const float*>(colors.data()),
                                              static_cast<Eigen::Index>(colors.size()), 3);
  if (!eye_) return made;
  const Points seen = seen_from(made.scan.vertices, *eye_, Vec3(0, 1, 0), 0.03f);
  const CellImage image(seen);
  std::vector<int> shown;
  for (int i = 0; i < seen.rows(); ++i)
    if (image.shows(i, 0.05f)) shown.push_back(i);
  MadeScan part;
  part.joints = made.joints;
  part.scan.vertices = made.scan.vertices(shown, Eigen::all);
  part.scan.colors = made.scan.colors(shown, Eigen::all);
  for (const int i : shown) part.owner.push_back(made.owner[static_cast<size_t>(i)]);
  return part;
}

Extraction KnowingExtractor::extract(const Mesh& scan) {
  US_CHECK(scan.vertices.rows() >= 32, "too few points");
  ++looks;
  Extraction best;
  best.confidence.setZero();
  float most = -1;
  for (const Joints& joints : truth_) {
    int near = 0;
    std::array<int, kJointCount> about{};
    for (const auto& row : scan.vertices.rowwise()) {
      if (bone_distance(row.transpose(), joints) <= body_reach(joints)) ++near;
      for (int j = 0; j < kJointCount; ++j) about[j] += (joints.row(j) - row).norm() < body_reach(joints);
    }
    const float share = static_cast<float>(near) / static_cast<float>(scan.vertices.rows());
    const auto seen =
        static_cast<float>(std::count_if(about.begin(), about.end(), [](int n) { return n > 2; }));
    const float score = share * share * seen / kJointCount;
    if (score <= most) continue;
    most = score;
    best.joints = joints;
    best.confidence.setConstant(score);
  }
  return best;
}

}  // namespace understudy::test
