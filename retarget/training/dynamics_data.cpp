#include "retarget/training/dynamics_data.hpp"

#include <algorithm>
#include <array>

#include "retarget/base/index.hpp"
#include "retarget/marionette/dynamics_rows.hpp"
#include "retarget/rig/person_rig.hpp"

namespace understudy::training {
namespace {

constexpr std::array<double, 8> kRates = {30, 30, 30, 30, 15, 20, 25, 60};
constexpr std::array<int, 3> kDrawnFrames = {36, 64, 96};  // short clips count, too
constexpr size_t kFirstDrawn = 192, kMostDrawn = 4096;
constexpr int kDrawnEachBatch = 3;
constexpr int kMostGiven = 10, kLeastApart = 2;
constexpr double kMostApart = 1.05;                      // seconds
constexpr float kOneGiven = 0.7f, kEvenlyApart = 0.75f;  // shares
constexpr float kSlower = 0.85f, kQuicker = 1.2f;        // people, than they were captured

/// Seen in a mirror that x = 0 is.
void mirror_person(RigMotion& motion) {
  for (RigPose& pose : motion.poses) {
    Pose seen;
    seen.root = pose.root;
    std::copy(pose.turns.begin(), pose.turns.end(), seen.local.begin());
    pose = person_pose(mirrored(seen));
  }
}

void know(Known which, double fps, bool* known, int frames, Rng& rng) {
  std::fill_n(known, frames, false);
  const bool one = which == Known::Keys && rng.chance(kOneGiven);
  const int given = one ? 1 : 2 + rng.below(kMostGiven - 1);
  std::fill_n(known, std::min(given, frames), true);
  if (which == Known::Beginning) return;
  const int most = std::max(kLeastApart, static_cast<int>(kMostApart * fps));
  const auto distance = [&] { return kLeastApart + rng.below(most - kLeastApart + 1); };
  const int usual = distance();
  for (int t = given - 1; t < frames; t += rng.chance(kEvenlyApart) ? usual : distance()) known[t] = true;
  known[frames - 1] = true;
}

}  // namespace

DynamicsData::DynamicsData(const std::string& kind, const std::string& folder, Split split)
    : kinds_(kind, folder, split), people_(kind == "person" && split == Split::Train) {
  Rng rng(1);
  const Rig rig = kinds_.draw(2, 30, rng).rig;
  for (const RigJoint& joint : rig.joints) parents_.push_back(joint.parent);
  bones_ = bones_of(rig);
}

void DynamicsData::draw_more(int frames, Rng& rng) {
  const double fps = kRates[static_cast<size_t>(rng.below(static_cast<int>(kRates.size())))];
  const int count = kDrawnFrames[static_cast<size_t>(rng.below(static_cast<int>(kDrawnFrames.size())))];
  const double tempo = people_ ? static_cast<double>(rng.uniform(kSlower, kQuicker)) : 1;
  RiggedMotion drawn = kinds_.draw(std::max(frames, count), fps / tempo, rng);
  drawn.motion.fps = fps;
  if (people_ && rng.chance(0.5f)) mirror_person(drawn.motion);
  const DynamicsRows rows(drawn.rig);
  Drawn one{rows.rows(drawn.motion), rows.rest(), fps};
  if (drawn_.size() < kMostDrawn)
    drawn_.push_back(std::move(one));
  else
    drawn_[next_++ % kMostDrawn] = std::move(one);
}

DynamicsBatch DynamicsData::batch(int count, int frames, Known known, Rng& rng) {
  do draw_more(drawn_.size() < kFirstDrawn ? frames : 0, rng);
  while (drawn_.size() < kFirstDrawn);
  for (int i = 1; i < kDrawnEachBatch; ++i) draw_more(0, rng);
  const int64_t joints = ssize(parents_);
  const int64_t width = 4 + 6 * joints;
  DynamicsBatch batch{torch::empty({count, frames, width}), torch::empty({count, frames}),
                      torch::empty({count, joints, 3}), torch::empty({count, frames}, torch::kBool)};
  for (int64_t i = 0; i < count; ++i) {
    const Drawn* one = nullptr;
    do one = &drawn_[static_cast<size_t>(rng.below(static_cast<int>(drawn_.size())))];
    while (one->rows.rows() < frames);
    const int first = rng.below(static_cast<int>(one->rows.rows()) - frames + 1);
    batch.rows[i].copy_(torch::from_blob(const_cast<float*>(one->rows.row(first).data()), {frames, width}));
    batch.rows[i][0].slice(0, 0, 3).zero_();
    batch.dt[i].fill_(1 / one->fps);
    batch.rest[i].copy_(torch::from_blob(const_cast<float*>(one->rest.data()), {joints, 3}));
    know(known, one->fps, batch.known[i].data_ptr<bool>(), frames, rng);
  }
  return batch;
}

}  // namespace understudy::training
