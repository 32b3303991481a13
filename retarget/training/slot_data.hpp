// What the network of slots learns from: short windows of scans of one body that moves.
#pragma once

#include "retarget/nn/modules/slot_net.hpp"
#include "retarget/training/kind_data.hpp"

namespace understudy::training {

constexpr int kSlotWindow = 4;  ///< frames of a window

/// W windows of kSlotWindow frames; then each window's first frame once more, of other points, turned.
struct SlotBatch {
  nn::SlotInput input;  ///< of (kSlotWindow + 1) W scans: [W][T], then [W]
  torch::Tensor moved;  ///< [W, T, 3] where the middle of the scans goes, a second, in the window's scale
  torch::Tensor
      turned;  ///< [W, 3, 3] what the last ones have gone through: turned about the vertical, mirrored
  torch::Tensor
      side;  ///< [W, 3, 3] the mirror alone, in the body's own frame; the identity where there is none
};

class SlotData {
 public:
  SlotData(const std::string& kind, const std::string& folder, Split split)
      : data_(kind, folder, split), two_sided_(kind == "hand") {}
  /// apart: the most frames, of 30 a second, between two of a window.
  SlotBatch batch(int windows, int apart, Rng& rng) const;
  const KindData& bodies() const { return data_; }

 private:
  KindData data_;
  bool two_sided_;  // there are left ones and right ones, which are to have the same keypoints
};

/// So many of the rows, any.
Points some_rows(const Points& points, int count, Rng& rng);

}  // namespace understudy::training
