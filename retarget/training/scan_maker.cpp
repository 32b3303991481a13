#include "retarget/training/scan_maker.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/body/costume.hpp"
#include "retarget/body/depth_cameras.hpp"
#include "retarget/body/partial_view.hpp"
#include "retarget/body/seated_pose.hpp"
#include "retarget/body/surroundings.hpp"
#include "retarget/math/directions.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::training {
namespace {

constexpr int kPoolSize = 40;
constexpr int kScansPerPerson = 24;
// Sampled before holes take their share; the rest fills up with what is left.
constexpr int kRawPoints = 1800;
constexpr int kPieceRawPoints = 500;            // of another person, of whom a piece is left
constexpr float kHalfAndOneSided = 0.5f;        // of half bodies, those seen by one camera
constexpr int kHandSolid = 1100;                // points of a hand with some of its forearm, as a solid
constexpr int kBodySolid = 3000;                // of a whole body, at most
constexpr float kFewest = 500, kMost = 300000;  // points of depth cameras

// Changes and things of a stream that are the same in all its frames.
enum class Sticky : uint64_t {
  Skirt = 1,
  Coat,
  Hair,
  HeldThing,
  Limb = 20,
  Desk,
  OneSide,
  Below,
  Beside,
  Rig,
  Ground,
  Furniture,
  Chair,
  Ball,
  Other,
  Uneven = 100,
  Welded,
  LeftHand,
  RightHand,
  Voxels
};

Rng of_stream(uint64_t seed, Sticky thing) {
  return Rng(seed ^ (0xd1342543de82ef95ull * static_cast<uint64_t>(thing)));
}

/// Changes a share of scans; of_stream()'s random numbers make the same change in each frame.
template <class Change>
void sometimes(float share, Rng rng, Change&& change) {
  if (rng.chance(share)) change(rng);
}

Mat3 random_turn(float angle, Rng& rng) {
  return rotation_from_axis_angle(angle * random_direction(rng));
}

bool is_upper(int joint) {
  return joint == Spine1 || joint == Spine2 || joint == Spine3 || joint >= Neck;
}

/// Exactly kScanPoints of the points, at random, repeating some where there are too few.
void thin(MadeScan& scan, Rng& rng) {
  std::vector<int> order(scan.points.rows());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (size_t i = 0; i + 1 < order.size(); ++i) std::swap(order[i], order[i + rng.below(order.size() - i)]);
  const size_t count = order.size();
  order.resize(nn::kScanPoints);
  for (size_t i = count; i < order.size(); ++i) order[i] = order[i % count];
  keep_rows(scan, order);
}

}  // namespace

ScanMakerOptions ScanMakerOptions::rest() {
  ScanMakerOptions options;
  options.captured = 0.25f;
  options.t_pose = 1;
  options.yaw = 0.5f;
  options.stretch = 0.15f;
  options.one_sided = 0;
  options.posed_hands = 0.5f;
  options.uneven = 0.15f;
  options.welded = options.fused_hands = options.voxels = 0.05f;
  return options.whole_and_alone();
}

ScanMakerOptions ScanMakerOptions::whole_and_alone() const {
  ScanMakerOptions options = *this;
  options.cut_below = options.cut_beside = options.seated = options.desks = options.sensors = 0;
  options.ground = options.furniture = options.balls = options.others = 0;
  return options;
}

ScanMaker::ScanMaker(const TrainingData& data, const ScanMakerOptions& options, uint64_t seed)
    : data_(data), options_(options), rng_(seed) {
  for (int i = 0; i < kPoolSize; ++i) {
    people_.push_back(make_person());
    people_.back()->left = 1 + rng_.below(kScansPerPerson);  // so that they are not all replaced at once
  }
}

std::shared_ptr<ScanMaker::Person> ScanMaker::make_person() {
  ShapedBody body;
  const HandVertices* hands = &data_.hands;
  if (!data_.dressed.empty() && rng_.chance(options_.dressed)) {
    const int which = rng_.below(data_.dressed.size());
    body = data_.dressed[which];
    hands = at_or_null(data_.dressed_hands, which);
  } else {
    body = data_.body.shaped(random_shape(data_, rng_));
  }
  SurfaceSampler sampler(body.vertices, body.faces);
  return std::make_shared<Person>(Person{std::move(body), std::move(sampler), kScansPerPerson, hands});
}

std::vector<Pose> ScanMaker::clip_poses(int count) {
  std::vector<Pose> poses = random_poses(data_, count, rng_);
  if (options_.mirror && rng_.chance(0.5f))
    for (Pose& pose : poses) pose = mirrored(pose);
  return poses;
}

/// Postures of clips; in some the upper body does something else.
std::vector<Pose> ScanMaker::mixed_poses(int count) {
  std::vector<Pose> poses = clip_poses(count);
  if (!rng_.chance(options_.mixed)) return poses;
  const std::vector<Pose> others = clip_poses(count);
  poses.resize(std::min(poses.size(), others.size()));
  for (size_t i = 0; i < poses.size(); ++i)
    for (int j = 0; j < kJointCount; ++j)
      if (is_upper(j)) poses[i].local[j] = others[i].local[j];
  return poses;
}

/// What joints are turned by from a clip's posture.
Rotations ScanMaker::draw_turns() {
  Rotations turns;
  turns.fill(Mat3::Identity());
  if (rng_.chance(options_.jittered)) {
    const float spread = rng_.uniform(0.0f, 0.3f);
    for (int j = 1; j < kJointCount; ++j) turns[j] = random_turn(spread * std::abs(rng_.normal()), rng_);
  }
  if (rng_.chance(options_.limp))
    for (const int j : {LeftWrist, RightWrist, Head, LeftAnkle, RightAnkle})
      turns[j] = turns[j] * random_turn(0.5f * std::abs(rng_.normal()), rng_);
  return turns;
}

/// Up to `count`; what is changed of a clip's postures is changed in all of them alike.
std::vector<Pose> ScanMaker::make_poses(int count, bool seated) {
  Mat3 yaw = rotation_about_y(rng_.uniform(-options_.yaw, options_.yaw));
  std::vector<Pose> poses(count);
  Rotations turns;
  if (rng_.chance(options_.t_pose)) {
    const float spread = rng_.chance(0.5f) ? 0.0f : 0.08f;
    for (Mat3& turn : turns) turn = random_turn(spread * rng_.uniform(), rng_);
  } else {
    poses = mixed_poses(count);
    turns = draw_turns();
    yaw = yaw * random_turn((rng_.chance(options_.tilted) ? 1.2f : 0.05f) * rng_.normal(), rng_);
  }
  if (seated) sit_down(poses, rng_);
  for (Pose& pose : poses) {
    for (int j = 0; j < kJointCount; ++j) pose.local[j] = pose.local[j] * turns[j];
    pose.local[Pelvis] = yaw * pose.local[Pelvis];
    pose.root = yaw * pose.root;
  }
  return poses;
}

/// Hands of their own, now and then alike.
HandMotion ScanMaker::draw_hands() {
  HandMotion motion;
  if (!data_.hand_poses || !rng_.chance(options_.posed_hands)) return motion;
  const bool are_alike = rng_.chance(0.25f);
  for (auto* ends : {&motion.from, &motion.to})
    for (size_t side = 0; side < 2; ++side)
      (*ends)[side] = side == 1 && are_alike ? (*ends)[0] : data_.hand_poses->draw(rng_);
  motion.share = rng_.uniform();
  if (rng_.chance(options_.moving_hands))
    motion.step = rng_.uniform(-0.1f, 0.1f);
  else
    motion.to = motion.from;
  return motion;
}

/// Shoes of a stream; in high heels its poses change.
void ScanMaker::draw_shoes(Stream& stream) {
  if (!rng_.chance(options_.shod)) return;
  stream.shoes = std::make_shared<Shoes>(stream.person->body, random_shoe(rng_));
  for (Pose& pose : stream.poses) stream.shoes->lift_heels(pose);
}

/// Points of the person whom the surface is of.
OrientedPoints ScanMaker::sample_posed(const Person& person, PosedSurface& surface, int count) {
  return surface.sample(person.sampler, person.body.faces, count, rng_);
}

/// Where much is taken away more is made, so that what is left has as many points as any cloud.
int ScanMaker::raw_points(const Setting& setting) const {
  if (options_.points > 0) return options_.points;
  return kRawPoints * (setting.is_partial() ? 4 : setting.sensors ? 3 : 2) / 2;
}

/// The person of a stream in its next frame, with fingers and shoes.
MadeScan ScanMaker::make_scan(Stream& stream) {
  const Person& person = *stream.person;
  SurfaceLook look{data_.hand_poses.get(), person.hands, stream.hands.next(), stream.shoes.get()};
  std::optional<UnevenSurface> uneven;
  sometimes(options_.uneven, of_stream(stream.seed, Sticky::Uneven), [&](Rng& rng) {
    // Patches stick, then jump.
    const bool has_jumped = rng.chance(0.3f) && ssize(stream.poses) <= rng.below(options_.longest);
    Rng own(rng.next() + has_jumped);
    look.uneven = &uneven.emplace(person.body.vertices, person.body.joints, own);
  });
  PosedSurface surface(person.body, stream.poses.back(), look);
  OrientedPoints cloud = sample_posed(person, surface, raw_points(stream.setting));
  if (!stream.setting.sensors) fuse(cloud, surface, stream);
  return {std::move(cloud), surface.truth(), {}};
}

/// As a rig that fuses many views leaves the surface: the same in all frames of a stream.
void ScanMaker::fuse(OrientedPoints& cloud, PosedSurface& surface, const Stream& stream) {
  const float size = leg_length(surface.truth().joints) / 0.85f;
  const float area = stream.person->sampler.area() / static_cast<float>(cloud.points.rows());
  const auto random = [&](Sticky thing) { return of_stream(stream.seed, thing); };
  for (const int side : {0, 1})
    sometimes(options_.fused_hands, random(side == 0 ? Sticky::LeftHand : Sticky::RightHand), [&](Rng& rng) {
      const float softness = size * rng.uniform(0.008f, 0.02f), level = rng.uniform(0.1f, 0.45f);
      const auto solid = surface.hand_solid(side, kHandSolid, softness, rng.next());
      if (solid) fuse_hand(cloud, surface.truth(), side, *solid, level);
    });
  sometimes(options_.welded, random(Sticky::Welded), [&](Rng& rng) {
    const Eigen::Index step = 1 + cloud.points.rows() / kBodySolid;
    const auto every = Eigen::seq(0, Eigen::last, step);
    const Points points = cloud.points(every, Eigen::all), normals = cloud.normals(every, Eigen::all);
    const float part = area * static_cast<float>(step);
    const float softness = std::max(size * rng.uniform(0.012f, 0.045f), 1.1f * std::sqrt(part));
    weld(cloud, SoftSolid(points, normals, part, softness), rng.uniform(0.54f, 0.68f));
  });
  sometimes(options_.voxels, random(Sticky::Voxels), [&](Rng& rng) { snap_to_voxels(cloud, rng); });
}

/// Wide clothes, hair, held things: what clips and dressed people of the data lack.
void ScanMaker::put_on(MadeScan& scan, uint64_t seed) {
  const PosedSkeleton& truth = scan.truth;
  const auto random = [&](Sticky thing) { return of_stream(seed, thing); };
  sometimes(options_.skirts, random(Sticky::Skirt), [&](Rng& rng) { wear_skirt(scan, truth, rng); });
  sometimes(options_.coats, random(Sticky::Coat), [&](Rng& rng) { wear_coat(scan, truth, rng); });
  sometimes(options_.hair, random(Sticky::Hair), [&](Rng& rng) { wear_hair(scan, truth, rng); });
  sometimes(options_.holding, random(Sticky::HeldThing), [&](Rng& rng) { hold_thing(scan, truth, rng); });
}

/// What lies about, as far as a segmentation left it.
void ScanMaker::surround(MadeScan& scan, Stream& stream) {
  const Setting& setting = stream.setting;
  const auto random = [&](Sticky thing) { return SceneRandom{of_stream(stream.seed, thing), rng_}; };
  if (setting.chair) add_chair_below(scan, stream.first, random(Sticky::Chair));
  if (setting.ground) add_ground(scan, stream.first, random(Sticky::Ground));
  if (setting.furniture) add_furniture(scan, stream.first, random(Sticky::Furniture));
  if (setting.ball) add_loose_ball(scan, stream.first, random(Sticky::Ball));
  if (!stream.other) return;
  Other& other = *stream.other;
  const Person& person = *other.person;
  PosedSurface surface(person.body, other.poses.back(),
                       {data_.hand_poses.get(), person.hands, other.hands.next()});
  OrientedPoints piece = sample_posed(person, surface, kPieceRawPoints);
  if (other.poses.size() > 1) other.poses.pop_back();
  piece.points.rowwise() += other.shift.transpose();
  PosedSkeleton others = surface.truth();
  others.joints.rowwise() += other.shift.transpose();
  add_piece(scan, stream.first, piece, others, random(Sticky::Other));
}

/// Takes away limbs that are lost and what no camera sees.
void ScanMaker::hide(MadeScan& scan, const Stream& stream) {
  const Setting& setting = stream.setting;
  const auto random = [&](Sticky thing) { return of_stream(stream.seed, thing); };
  Rng desk = random(Sticky::Desk), side = random(Sticky::OneSide), below = random(Sticky::Below),
      beside = random(Sticky::Beside);
  sometimes(options_.limbless, random(Sticky::Limb), [&](Rng& rng) { lose_limb(scan, rng); });
  if (setting.desk) put_behind_desk(scan, stream.first, desk);
  if (setting.one_sided) see_from_one_side(scan, scan.truth, side);
  if (setting.below) cut_below(scan, stream.first, below);
  if (setting.beside) cut_beside(scan, stream.first, beside);
}

/// Joints of a stretched body are the stretched joints; rotations are kept, as bodies stay near the T-pose.
void ScanMaker::stretch(MadeScan& scan) {
  for (int axis = 0; axis < 3; ++axis) {
    const float factor = 1 + rng_.uniform(-options_.stretch, options_.stretch);
    scan.points.col(axis) *= factor;
    scan.truth.joints.col(axis) *= factor;
  }
}

void ScanMaker::add_clutter(MadeScan& scan, bool with_floor) {
  const Eigen::Index size = scan.points.rows(), count = size;
  const int outliers = rng_.below(static_cast<int>(2 + size / 150));
  const int floor = with_floor && rng_.chance(0.7f) ? rng_.below(static_cast<int>(2 + size / 25)) : 0;
  const float margin = rng_.uniform(0.05f, 0.3f);
  const Vec3 low = scan.points.colwise().minCoeff().transpose().array() - margin;
  const Vec3 high = scan.points.colwise().maxCoeff().transpose().array() + margin;
  const float ground = low.y() + margin;
  scan.points.conservativeResize(count + outliers + floor, 3);
  for (Eigen::Index i = count; i < scan.points.rows(); ++i) {
    for (int axis = 0; axis < 3; ++axis) scan.points(i, axis) = rng_.uniform(low[axis], high[axis]);
    if (i >= count + outliers) scan.points(i, 1) = ground + 0.003f * rng_.normal();
    scan.parts.push_back(kNoBody);
  }
}

void ScanMaker::degrade(MadeScan& scan) {
  const Vec3 view = random_direction(rng_), mean = scan.points.colwise().mean();
  const float least = rng_.uniform(0.15f, 0.8f);  // density at the back, of that at the front
  std::vector<std::pair<Vec3, float>> holes(rng_.below(6));
  for (auto& [at, radius] : holes) {
    at = scan.points.row(rng_.below(scan.points.rows()));
    radius = rng_.uniform(0.03f, 0.12f);
  }
  std::vector<int> kept;
  for (int i = 0; i < scan.points.rows(); ++i) {
    const Vec3 x = scan.points.row(i);
    const float seen = least + (1 - least) / (1 + std::exp(-6 * (x - mean).dot(view)));
    const bool in_hole = std::any_of(holes.begin(), holes.end(),
                                     [&x](const auto& h) { return (x - h.first).norm() < h.second; });
    if (!in_hole && rng_.chance(seen)) kept.push_back(i);
  }
  if (kept.size() >= 256) keep_rows(scan, kept);
  const float noise = rng_.uniform(0.0f, 0.008f);
  for (Eigen::Index i = 0; i < scan.points.size(); ++i) scan.points.data()[i] += noise * rng_.normal();
}

/// As depth cameras have it: in place of degrade().
void ScanMaker::sense(MadeScan& scan, const Stream& stream) {
  Rng random = of_stream(stream.seed, Sticky::Rig);
  const DepthRig rig = random_depth_rig(stream.first, random);
  const float most = kFewest * std::pow(kMost / kFewest, random.uniform());
  const PosedSkeleton beside = !stream.poses.empty()
                                   ? forward_kinematics(stream.person->body.joints, stream.poses.back())
                                   : stream.before.value_or(scan.truth);
  see_with_depth_cameras(scan, rig, scan.truth, beside, rng_);
  const float left = most / static_cast<float>(scan.points.rows());
  if (left < 1) keep_where(scan, [&](int) { return rng_.chance(left); });
}

std::shared_ptr<const ScanMaker::Person> ScanMaker::draw_person() {
  std::shared_ptr<Person>& person = people_[rng_.below(kPoolSize)];
  if (--person->left < 0) person = make_person();
  return person;
}

ScanMaker::Setting ScanMaker::draw_setting() {
  const auto drawn = [this](float share) { return rng_.chance(share); };
  Setting setting;
  setting.captured = drawn(options_.captured);
  setting.sensors = setting.captured && drawn(options_.sensors);
  setting.seated = drawn(options_.seated);
  setting.chair = setting.seated && drawn(0.5f);
  setting.below = drawn(options_.cut_below);
  setting.beside = drawn(options_.cut_beside);
  setting.desk = setting.seated ? drawn(0.5f) : drawn(options_.desks);
  // A desk's camera is its own.
  setting.one_sided =
      !setting.desk && drawn(setting.below || setting.beside ? kHalfAndOneSided : options_.one_sided);
  setting.ground = drawn(options_.ground);
  setting.furniture = drawn(options_.furniture);
  setting.ball = drawn(options_.balls);
  setting.other = drawn(options_.others);
  return setting;
}

ScanMaker::Other ScanMaker::draw_other(const PosedSkeleton& first, int frames) {
  Other other{draw_person(), make_poses(frames, false), draw_hands()};
  std::reverse(other.poses.begin(), other.poses.end());
  const PosedSkeleton others = forward_kinematics(other.person->body.joints, other.poses.back());
  other.shift = shift_beside(first, others, rng_);
  return other;
}

ScanMaker::Stream ScanMaker::start() {
  const int frames = 1 + rng_.below(options_.longest);
  const Setting setting = draw_setting();
  Stream stream{draw_person(), make_poses(frames, setting.seated), rng_.next(), setting};
  const float scale = leg_length(stream.person->body.joints) / data_.template_leg;
  for (Pose& pose : stream.poses) pose.root *= scale;  // clips' paths are the template's
  std::reverse(stream.poses.begin(), stream.poses.end());
  stream.hands = draw_hands();
  draw_shoes(stream);
  stream.first = forward_kinematics(stream.person->body.joints, stream.poses.back());
  if (setting.other) stream.other = draw_other(stream.first, frames);
  return stream;
}

MadeScan ScanMaker::next(Stream& stream) {
  const Setting& setting = stream.setting;
  MadeScan scan = make_scan(stream);
  stream.poses.pop_back();
  put_on(scan, stream.seed);
  if (options_.stretch > 0) stretch(scan);
  const PerJoint whole = surface_about_joints(scan, scan.truth);
  surround(scan, stream);
  hide(scan, stream);
  if (setting.sensors) sense(scan, stream);
  if (setting.captured && !setting.sensors) degrade(scan);
  if (setting.captured) add_clutter(scan, !setting.is_partial());
  scan.sight = joint_sight(whole, scan, scan.truth);
  stream.before = scan.truth;
  if (options_.points == 0) thin(scan, rng_);
  return scan;
}

MadeScan ScanMaker::next() {
  Stream stream = start();
  return next(stream);
}

}  // namespace understudy::training
