// Bodies of a kind that move, as the network of their dynamics (paper 3) sees them.
#pragma once

#include <torch/torch.h>

#include <string>
#include <vector>

#include "retarget/math/types.hpp"
#include "retarget/training/kind_data.hpp"

namespace understudy::training {

struct DynamicsBatch {
  torch::Tensor rows;  ///< [B, T, 4 + 6 J], see nn::RotationVrnn; the first frame does not know its speeds: 0
  torch::Tensor dt;    ///< [B, T] seconds since the frame before
  torch::Tensor rest;  ///< [B, J, 3] joints at rest about the root, sizes
  torch::Tensor known;  ///< [B, T] bool, on the CPU: frames that are given, and keys
};

/// What is known of a batch's sequences.
enum class Known {
  Beginning,  ///< two to ten frames
  Keys        ///< the first frame, or so many; then one after 2 frames to about a second, and the last
};

class DynamicsData {
 public:
  /// Throws Error as KindData does.
  DynamicsData(const std::string& kind, const std::string& folder, Split split);
  /// Pieces of motions, most of which were drawn before: bodies are costly, so a few new ones come with each
  /// batch, in the place of old ones.
  DynamicsBatch batch(int count, int frames, Known known, Rng& rng);
  const std::vector<int>& parents() const { return parents_; }
  /// See bones_of().
  const std::string& bones() const { return bones_; }

 private:
  struct Drawn {
    RowMatrix rows;
    Points rest;
    double fps;
  };
  void draw_more(int frames, Rng& rng);

  KindData kinds_;
  bool people_;  // to learn from: as many are seen in a mirror, all in another tempo
  std::vector<int> parents_;
  std::string bones_;
  std::vector<Drawn> drawn_;
  size_t next_ = 0;  // to be replaced
};

}  // namespace understudy::training
