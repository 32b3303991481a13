#include "retarget/training/slot_data.hpp"

#include <Eigen/Geometry>
#include <numeric>

#include "retarget/math/types.hpp"

namespace understudy::training {
namespace {

constexpr int kDrawnPoints = 1500;  // of a body; each scan has other ones of them

/// What the scans of a window are divided by: the points' distance from their middle, root of the mean
/// square.
float spread_of(const std::vector<Points>& frames) {
  float sum = 0;
  for (const Points& points : frames) {
    const Eigen::RowVector3f middle = points.colwise().mean();
    sum += (points.rowwise() - middle).rowwise().squaredNorm().mean();
  }
  return std::sqrt(sum / static_cast<float>(frames.size()));
}

/// How fast the middle of the scans goes: from the frame before to the one after.
void put_moved(const std::vector<Points>& frames, float rate, float* to) {
  std::vector<Eigen::RowVector3f> middles;
  for (const Points& points : frames) middles.push_back(points.colwise().mean());
  for (size_t t = 0; t < frames.size(); ++t) {
    const size_t a = t == 0 ? 0 : t - 1, b = std::min(t + 1, frames.size() - 1);
    Eigen::Map<Eigen::RowVector3f>(to + 3 * t) = (middles[b] - middles[a]) * rate / static_cast<float>(b - a);
  }
}

void put_scan(const Points& frame, float scale, const Mat3& turn, int64_t row, nn::SlotInput& input,
              Rng& rng) {
  Points points = some_rows(frame, nn::kSlotPoints, rng);
  const Eigen::RowVector3f middle = points.colwise().mean();
  points = ((points.rowwise() - middle) / scale * turn.transpose()).eval();
  nn::put_slot_points(points, row, input);
}

}  // namespace

Points some_rows(const Points& points, int count, Rng& rng) {
  std::vector<int> order(static_cast<size_t>(points.rows()));
  std::iota(order.begin(), order.end(), 0);
  Points some(count, 3);
  for (int i = 0; i < count; ++i) {
    std::swap(order[static_cast<size_t>(i)],
              order[static_cast<size_t>(i + rng.below(static_cast<int>(points.rows()) - i))]);
    some.row(i) = points.row(order[static_cast<size_t>(i)]);
  }
  return some;
}

SlotBatch SlotData::batch(int windows, int apart, Rng& rng) const {
  SlotBatch batch{nn::empty_slot_input((kSlotWindow + 1) * windows), torch::empty({windows, kSlotWindow, 3}),
                  torch::empty({windows, 3, 3}), torch::eye(3).repeat({windows, 1, 1})};
  for (int w = 0; w < windows; ++w) {
    const double fps = 30.0 / (1 + rng.below(apart));
    const RiggedMotion body = data_.draw(kSlotWindow, fps, rng);
    const SkinnedPoints drawn = points_on(body.rig, kDrawnPoints, rng);
    std::vector<Points> frames;
    for (const RigPose& pose : body.motion.poses)
      frames.push_back(skinned(drawn.rest, drawn.skin, bone_motions(body.rig, pose)));
    const float scale = spread_of(frames);
    for (int t = 0; t < kSlotWindow; ++t)
      put_scan(frames[static_cast<size_t>(t)], scale, Mat3::Identity(), w * kSlotWindow + t, batch.input,
               rng);
    put_moved(frames, static_cast<float>(fps) / scale, batch.moved[w].data_ptr<float>());
    using RowMat3 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
    const Vec3 side(two_sided_ && rng.chance(0.5f) ? -1 : 1, 1, 1);
    const Mat3 turn = Eigen::AngleAxisf(rng.uniform(-kPi, kPi), Vec3::UnitY()) * side.asDiagonal();
    put_scan(frames[0], scale, turn, kSlotWindow * windows + w, batch.input, rng);
    Eigen::Map<RowMat3>(batch.turned[w].data_ptr<float>()) = turn;
    Eigen::Map<RowMat3>(batch.side[w].data_ptr<float>()) = side.asDiagonal();
  }
  return batch;
}

}  // namespace understudy::training
