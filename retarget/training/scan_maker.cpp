#include "retarget/training/scan_maker.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/body/costume.hpp"
#include "retarget/math/directions.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::training {
namespace {

constexpr int kPoolSize = 40;
constexpr int kScansPerPerson = 24;
// Sampled before holes take their share; the rest fills up with what is left.
constexpr int kRawPoints = 1800;

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
  if (!data_.dressed.empty() && rng_.chance(options_.dressed))
    body = data_.dressed[rng_.below(data_.dressed.size())];
  else
    body = data_.body.shaped(random_shape(data_, rng_));
  SurfaceSampler sampler(body.vertices, body.faces);
  return std::make_shared<Person>(Person{std::move(body), std::move(sampler), kScansPerPerson});
}

std::vector<Pose> ScanMaker::clip_poses(int count) {
  std::vector<Pose> poses = random_poses(data_, count, rng_);
  if (options_.mirror && rng_.chance(0.5f))
    for (Pose& pose : poses) pose = mirrored(pose);
  return poses;
}

/// Up to `count`; what is changed of a clip's postures is changed in all of them alike.
std::vector<Pose> ScanMaker::make_poses(int count) {
  const auto turn = [this](float angle) { return rotation_from_axis_angle(angle * random_direction(rng_)); };
  Mat3 yaw = rotation_about_y(rng_.uniform(-options_.yaw, options_.yaw));
  std::vector<Pose> poses(count);
  Rotations changed;
  changed.fill(Mat3::Identity());
  if (rng_.chance(options_.t_pose)) {
    const float spread = rng_.chance(0.5f) ? 0.0f : 0.08f;
    for (Mat3& R : changed) R = turn(spread * rng_.uniform());
  } else {
    poses = clip_poses(count);
    if (rng_.chance(options_.mixed)) {
      const std::vector<Pose> others = clip_poses(count);
      poses.resize(std::min(poses.size(), others.size()));
      for (size_t i = 0; i < poses.size(); ++i)
        for (int j = 0; j < kJointCount; ++j)
          if (is_upper(j)) poses[i].local[j] = others[i].local[j];
    }
    if (rng_.chance(options_.jittered)) {
      const float spread = rng_.uniform(0.0f, 0.3f);
      for (int j = 1; j < kJointCount; ++j) changed[j] = turn(spread * std::abs(rng_.normal()));
    }
    if (rng_.chance(options_.limp))
      for (const int j : {LeftWrist, RightWrist, Head, LeftAnkle, RightAnkle})
        changed[j] = changed[j] * turn(0.5f * std::abs(rng_.normal()));
    yaw = yaw * turn((rng_.chance(options_.tilted) ? 1.2f : 0.05f) * rng_.normal());
  }
  for (Pose& pose : poses) {
    for (int j = 0; j < kJointCount; ++j) pose.local[j] = pose.local[j] * changed[j];
    pose.local[Pelvis] = yaw * pose.local[Pelvis];
    pose.root = yaw * pose.root;
  }
  return poses;
}

MadeScan ScanMaker::sample_posed(const Person& person, const Pose& pose) {
  const int count = options_.points > 0 ? options_.points : kRawPoints;
  const ShapedBody& body = person.body;
  MadeScan scan;
  scan.truth = forward_kinematics(body.joints, pose);
  const Eigen::VectorXf features = pose_features(pose.local);
  Points rest = Points::Zero(count, 3), offset = Points::Zero(count, 3);
  RowMatrix weights = RowMatrix::Zero(count, kJointCount);
  for (int i = 0; i < count; ++i) {
    const auto s = person.sampler.sample(rng_);
    for (int k = 0; k < 3; ++k) {
      const int v = body.faces(s.face, k);
      const float b = s.barycentric[k];
      rest.row(i) += b * body.vertices.row(v);
      weights.row(i) += b * body.weights.row(v);
      if (body.pose_dirs) offset.row(i) += b * (body.pose_dirs->middleRows(3 * v, 3) * features).transpose();
    }
  }
  scan.points = linear_blend_skinning(rest + offset, weights, body.joints, scan.truth);
  scan.parts.resize(count);
  for (int i = 0; i < count; ++i) weights.row(i).maxCoeff(&scan.parts[i]);
  return scan;
}

/// Wide clothes, hair, held things, one camera, lost limbs: what clips and dressed people of the data lack.
/// The same seed, in another frame, puts on the same things.
void ScanMaker::occlude(MadeScan& scan, uint64_t seed) {
  uint64_t kind = 0;
  const auto sometimes = [&](float share, auto&& change) {
    Rng rng(seed ^ (0xd1342543de82ef95ull * ++kind));
    if (rng.chance(share)) change(rng);
  };
  sometimes(options_.skirts, [&](Rng& rng) { wear_skirt(scan, scan.truth, rng); });
  sometimes(options_.coats, [&](Rng& rng) { wear_coat(scan, scan.truth, rng); });
  sometimes(options_.hair, [&](Rng& rng) { wear_hair(scan, scan.truth, rng); });
  sometimes(options_.holding, [&](Rng& rng) { hold_thing(scan, scan.truth, rng); });
  sometimes(options_.limbless, [&](Rng& rng) { lose_limb(scan, rng); });
  sometimes(options_.one_sided, [&](Rng& rng) { see_from_one_side(scan, scan.truth, rng); });
}

/// Joints of a stretched body are the stretched joints; rotations are kept, as bodies stay near the T-pose.
void ScanMaker::stretch(MadeScan& scan) {
  for (int axis = 0; axis < 3; ++axis) {
    const float factor = 1 + rng_.uniform(-options_.stretch, options_.stretch);
    scan.points.col(axis) *= factor;
    scan.truth.joints.col(axis) *= factor;
  }
}

void ScanMaker::add_clutter(MadeScan& scan, Eigen::Index count) {
  const Eigen::Index size = scan.points.rows();
  const int outliers = rng_.below(static_cast<int>(2 + size / 150));
  const int floor = rng_.chance(0.7f) ? rng_.below(static_cast<int>(2 + size / 25)) : 0;
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
  add_clutter(scan, scan.points.rows());
}

std::shared_ptr<const ScanMaker::Person> ScanMaker::draw_person() {
  std::shared_ptr<Person>& person = people_[rng_.below(kPoolSize)];
  if (--person->left < 0) person = make_person();
  return person;
}

ScanMaker::Stream ScanMaker::start() {
  const int frames = 1 + rng_.below(options_.longest);
  Stream stream{draw_person(), make_poses(frames), rng_.next(), rng_.chance(options_.captured)};
  const float scale = leg_length(stream.person->body.joints) / data_.template_leg;
  for (Pose& pose : stream.poses) pose.root *= scale;  // clips' paths are the template's
  std::reverse(stream.poses.begin(), stream.poses.end());
  return stream;
}

MadeScan ScanMaker::next(Stream& stream) {
  MadeScan scan = sample_posed(*stream.person, stream.poses.back());
  stream.poses.pop_back();
  occlude(scan, stream.seed);
  if (options_.stretch > 0) stretch(scan);
  if (stream.captured) degrade(scan);
  if (options_.points == 0) thin(scan, rng_);
  return scan;
}

MadeScan ScanMaker::next() {
  Stream stream = start();
  return next(stream);
}

}  // namespace understudy::training
