#include "retarget/networks/lifter_network.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/networks/linear_layer.hpp"
#include "retarget/pose2d/lengths_so_far.hpp"
#include "retarget/pose2d/lift_input.hpp"
#include "retarget/pose2d/lifted_path.hpp"

namespace understudy::nn {
namespace {

constexpr int kGates = 3;  // of the recurrent layer: reset, update, new

float sigmoid(float x) {
  return 1 / (1 + std::exp(-x));
}

/// Row 0 of a pose, row 1 of its mirror image.
struct LiftedRows {
  RowMatrix numbers;
  float joint(int row, int joint, int axis) const { return numbers(row, 3 * joint + axis); }
  float log_off(int row, int joint) const {
    return std::clamp(numbers(row, kLifterDoubtsAt + joint), kLeastLogOff, kMostLogOff);
  }
  Vec6 turn(int row, int joint) const {
    return numbers.row(row).segment<6>(kLifterTurnsAt + 6 * joint).transpose();
  }
};

/// Beside the points that are seen, see kPointOfJoint.
void add_seen(const LiftFrame& frame, Eigen::Ref<Eigen::RowVectorXf> numbers) {
  if (!frame.has_hips) return;
  for (int j = 0; j < kJointCount; ++j)
    if (const int point = kPointOfJoint[static_cast<size_t>(j)]; point >= 0)
      numbers.segment<2>(3 * j) += frame.numbers.segment<2>(kLiftPointInputs * point) / kLiftPlaceScale;
}

/// None where a rotation is none.
std::optional<Rotations> turns_of(const LiftedRows& rows) {
  Vec6 in_mirror;
  in_mirror << 1, -1, -1, -1, 1, 1;  // M R M of a rotation R in its 6D form, M mirrors x
  Rotations turns;
  for (int j = 0; j < kJointCount; ++j) {
    const Vec6 both = (rows.turn(0, j) + rows.turn(1, kMirror[j]).cwiseProduct(in_mirror)) / 2;
    const Vec3 a = both.head<3>(), b = both.tail<3>();
    if (!both.allFinite() || a.cross(b).norm() < 1e-4f) return std::nullopt;
    turns[static_cast<size_t>(j)] = rotation_from_6d(both);
  }
  return turns;
}

LiftedPose both_sides(const LiftedRows& rows) {
  LiftedPose lifted;
  for (int j = 0; j < kJointCount; ++j) {
    const int m = kMirror[j];
    for (int axis = 0; axis < 3; ++axis)
      lifted.joints(j, axis) = (rows.joint(0, j, axis) + (axis == 0 ? -1 : 1) * rows.joint(1, m, axis)) / 2;
    lifted.off[j] = std::exp((rows.log_off(0, j) + rows.log_off(1, m)) / 2);
  }
  lifted.turns = turns_of(rows);
  lifted.pitch = (rows.numbers(0, kLifterPitchAt) + rows.numbers(1, kLifterPitchAt)) / 2;
  return lifted;
}

class NetworkLifter final : public Lifter {
 public:
  NetworkLifter(const NetworkWeights& file, std::unique_ptr<const LengthReader> lengths)
      : reader_(std::move(lengths)),
        embed_(file.linear(kernels(), "embed", kLiftInputs, kLifterEmbedded)),
        from_input_(kernels(), file.tensor("memory.weight_ih_l0", kGates * kLifterHidden, kLifterEmbedded),
                    file.tensor("memory.bias_ih_l0", kGates * kLifterHidden, 1)),
        from_memory_(kernels(), file.tensor("memory.weight_hh_l0", kGates * kLifterHidden, kLifterHidden),
                     file.tensor("memory.bias_hh_l0", kGates * kLifterHidden, 1)),
        head_(file.linear(kernels(), "head", kLifterEmbedded + kLifterHidden, kLifterHead)),
        last_(file.linear(kernels(), "last", kLifterHead, kLifterOutputs)) {}

  void reset(const LiftView& view) override { memory_ = Memory{{}, {}, {}, hidden_zero(), LiftedPath(view)}; }
  Extraction push(const FlatPose& seen, float dt) override {
    US_CHECK(memory_, "2D poses are lifted after a reset()");
    const FlatPose pose = liftable(seen);
    Memory next = *memory_;
    // Both sides of a person are alike, so that these are those of the mirror image too.
    const BoneLengths& lengths = next.lengths.push(pose, *reader_);
    const LiftFrame frame = next.plain.push(pose, lengths, dt),
                    mirrored = next.mirrored.push(in_mirror(pose), lengths, dt);
    LiftedPose lifted = both_sides(answer(frame, mirrored, next.hidden));
    lifted.origin = frame.origin, lifted.has_hips = frame.sees_hips, lifted.size = frame.size;
    Extraction extraction = next.path.push(lifted, pose, dt);
    memory_ = std::move(next);
    return extraction;
  }
  std::string name() const override { return "lifter"; }
  std::any memory() const override { return memory_; }
  void restore(const std::any& memory) override {
    memory_ = std::any_cast<const std::optional<Memory>&>(memory);
  }

 private:
  struct Memory {
    LengthsSoFar lengths;
    LiftInput plain, mirrored;
    RowMatrix hidden;  // [2, kLifterHidden]
    LiftedPath path;
  };
  static RowMatrix hidden_zero() { return RowMatrix::Zero(2, kLifterHidden); }

  LiftedRows answer(const LiftFrame& frame, const LiftFrame& mirrored, RowMatrix& hidden) const {
    RowMatrix x(2, kLiftInputs), embedded;
    x << frame.numbers, mirrored.numbers;
    embed_.apply(x, embedded, Finish::Relu);
    remember(embedded, hidden);
    RowMatrix both(2, kLifterEmbedded + kLifterHidden), between;
    both << embedded.leftCols(kLifterEmbedded), hidden;
    head_.apply(both, between, Finish::Relu);
    LiftedRows rows;
    last_.apply(between, rows.numbers);
    add_seen(frame, rows.numbers.row(0));
    add_seen(mirrored, rows.numbers.row(1));
    return rows;
  }

  /// A gated recurrent unit (Cho et al. 2014), as LibTorch has it.
  void remember(const RowMatrix& embedded, RowMatrix& hidden) const {
    RowMatrix in, kept;
    from_input_.apply(embedded, in);
    from_memory_.apply(hidden, kept);
    constexpr int H = kLifterHidden;
    for (int row = 0; row < 2; ++row)
      for (int i = 0; i < H; ++i) {
        const float reset = sigmoid(in(row, i) + kept(row, i)),
                    update = sigmoid(in(row, H + i) + kept(row, H + i)),
                    made = std::tanh(in(row, 2 * H + i) + reset * kept(row, 2 * H + i));
        hidden(row, i) = (1 - update) * made + update * hidden(row, i);
      }
  }

  std::unique_ptr<const LengthReader> reader_;
  LinearLayer embed_, from_input_, from_memory_, head_, last_;
  std::optional<Memory> memory_;
};

}  // namespace

std::unique_ptr<Lifter> load_network_lifter(const std::string& path,
                                            std::unique_ptr<const LengthReader> lengths) {
  return std::make_unique<NetworkLifter>(NetworkWeights(path, "lifter", kLifterVersion), std::move(lengths));
}

}  // namespace understudy::nn
