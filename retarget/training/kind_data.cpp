#include "retarget/training/kind_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/keypoint_finder.hpp"
#include "retarget/rig/person_rig.hpp"

namespace understudy::training {
namespace {

constexpr uint64_t kTrainCreatures = 100, kFirstDevCreature = 100, kDevCreatures = 10;
constexpr int kShortestKindRun = 30;  // frames of a clip

Rig rig_of(const ShapedBody& person) {
  Rig rig = person_rig(person.joints);
  rig.surface = {person.vertices, person.faces};
  rig.skin = SkinWeights::from(person.weights);
  return rig;
}

/// Turned to any side, the first frame's root above the origin.
void place_anywhere(RigMotion& motion, Rng& rng) {
  const float angle = rng.uniform(-kPi, kPi);
  const Mat3 turn = Eigen::AngleAxisf(angle, Vec3::UnitY()).toRotationMatrix();
  Vec3 start = motion.poses.front().root;
  start.y() = 0;
  for (RigPose& pose : motion.poses) {
    pose.root = turn * (pose.root - start);
    pose.turns[0] = turn * pose.turns[0];
  }
}

}  // namespace

KindData::KindData(const std::string& kind, const std::string& folder, Split split) {
  const auto& kinds = kBodyKinds;
  US_CHECK(std::find(kinds.begin(), kinds.end(), kind) != kinds.end(), "there is no kind \"", kind, "\"");
  if (kind == "person") {
    people_ = load_training_data(folder, split);
    runs_ = good_runs(people_->clips, kShortestKindRun, 1 << 20);
    poses_.emplace(people_->clips);
    US_CHECK(!runs_.empty(), folder, ": has no clip of ", kShortestKindRun, " good frames in a row");
    return;
  }
  creature_ = static_cast<int>(std::find(kCreatureNames.begin(), kCreatureNames.end(), kind) -
                               kCreatureNames.begin());
  first_seed_ = split == Split::Train ? 0 : kFirstDevCreature;
  rigs_.resize(split == Split::Train ? kTrainCreatures : kDevCreatures);
}

const Rig& KindData::creature(int number) const {
  std::optional<Rig>& rig = rigs_[static_cast<size_t>(number)];
  if (!rig)
    rig = make_creature(static_cast<CreatureKind>(creature_), first_seed_ + static_cast<uint64_t>(number));
  return *rig;
}

RiggedMotion KindData::draw(int frames, double fps, Rng& rng) const {
  RiggedMotion drawn = people_ ? draw_person(frames, fps, rng) : draw_creature(frames, fps, rng);
  place_anywhere(drawn.motion, rng);
  return drawn;
}

double KindData::longest() const {
  if (!people_) return std::numeric_limits<double>::infinity();
  int most = 0;
  for (const ClipRun& run : runs_) most = std::max(most, run.count);
  return (most - 1) / static_cast<double>(kClipRate);
}

RiggedMotion KindData::draw_creature(int frames, double fps, Rng& rng) const {
  const auto kind = static_cast<CreatureKind>(creature_);
  const Rig& rig = creature(rng.below(static_cast<int>(rigs_.size())));
  const int motion = rng.below(static_cast<int>(creature_motions(kind).size()));
  const int skipped = rng.below(static_cast<int>(2 * fps));  // they all begin alike
  RigMotion whole = creature_motion(kind, rig, motion, skipped + frames, fps, rng.next());
  whole.poses.erase(whole.poses.begin(), whole.poses.begin() + skipped);
  return {rig, std::move(whole)};
}

RiggedMotion KindData::draw_person(int frames, double fps, Rng& rng) const {
  const auto step = static_cast<float>(kClipRate / fps);
  const int needed = static_cast<int>(std::ceil(step * static_cast<float>(frames - 1))) + 1;
  const auto long_enough = [needed](const ClipRun& run) { return run.count >= needed; };
  US_CHECK(std::any_of(runs_.begin(), runs_.end(), long_enough), "no clip has ", needed,
           " good frames in a row");
  const ClipRun* run = nullptr;
  do run = &runs_[static_cast<size_t>(rng.below(static_cast<int>(runs_.size())))];
  while (!long_enough(*run));
  const ShapedBody person = people_->body.shaped(random_shape(*people_, rng));
  RiggedMotion drawn{rig_of(person), {fps, {}}};
  const float scale = leg_length(person.joints) / people_->template_leg;
  const auto first = static_cast<float>(run->first + rng.below(run->count - needed + 1));
  for (int t = 0; t < frames; ++t) {
    Pose pose = poses_->at(run->clip, first + step * static_cast<float>(t));
    pose.root *= scale;
    drawn.motion.poses.push_back(person_pose(pose));
  }
  return drawn;
}

SkinnedPoints points_on(const Rig& rig, int count, Rng& rng) {
  const SurfaceSampler sampler(rig.surface.vertices, rig.surface.faces);
  SkinnedPoints points{Points(count, 3), {}};
  RowMatrix weights = RowMatrix::Zero(count, rig.count());
  for (Eigen::Index i = 0; i < count; ++i) {
    const SurfaceSampler::Sample sample = sampler.sample(rng);
    Vec3 place = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
      const int v = rig.surface.faces(sample.face, c);
      place += sample.barycentric[c] * rig.surface.vertices.row(v).transpose();
      for (int k = 0; k < kSkinBones; ++k)
        weights(i, rig.skin.bones(v, k)) += sample.barycentric[c] * rig.skin.weights(v, k);
    }
    points.rest.row(i) = place.transpose();
  }
  points.skin = SkinWeights::from(weights);
  return points;
}

}  // namespace understudy::training
