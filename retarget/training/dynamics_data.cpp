#include "retarget/training/dynamics_data.hpp"

#include <array>

#include "retarget/base/index.hpp"
#include "retarget/marionette/dynamics_rows.hpp"

namespace understudy::training {
namespace {

constexpr int kPieces = 3;  // of one body's motion: bodies are costly
constexpr std::array<double, 8> kRates = {30, 30, 30, 30, 15, 20, 25, 60};

}  // namespace

DynamicsData::DynamicsData(const std::string& kind, const std::string& folder, Split split)
    : kinds_(kind, folder, split) {
  Rng rng(1);
  const Rig rig = kinds_.draw(2, 30, rng).rig;
  for (const RigJoint& joint : rig.joints) parents_.push_back(joint.parent);
  bones_ = bones_of(rig);
}

DynamicsBatch DynamicsData::batch(int count, int frames, Rng& rng) const {
  const int64_t joints = ssize(parents_);
  const int64_t width = 4 + 6 * joints;
  DynamicsBatch batch{torch::empty({count, frames, width}), torch::empty({count, frames}),
                      torch::empty({count, joints, 3})};
  for (int64_t i = 0; i < count;) {
    const double fps = kRates[static_cast<size_t>(rng.below(static_cast<int>(kRates.size())))];
    const RiggedMotion drawn = kinds_.draw(kPieces * frames, fps, rng);
    const DynamicsRows rows(drawn.rig);
    const RowMatrix all = rows.rows(drawn.motion);
    const Points rest = rows.rest();
    for (int piece = 0; piece < kPieces && i < count; ++piece, ++i) {
      auto own = torch::from_blob(
          const_cast<float*>(all.row(static_cast<Eigen::Index>(piece) * frames).data()), {frames, width});
      batch.rows[i].copy_(own);
      batch.rows[i][0].slice(0, 0, 3).zero_();
      batch.dt[i].fill_(1 / fps);
      batch.rest[i].copy_(torch::from_blob(const_cast<float*>(rest.data()), {joints, 3}));
    }
  }
  return batch;
}

}  // namespace understudy::training
