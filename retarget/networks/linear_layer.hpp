// Layers of trained networks, prepared once for the kernels: a forward pass without LibTorch.
#pragma once

#include <string>
#include <vector>

#include "retarget/math/types.hpp"
#include "retarget/networks/kernels/kernels.hpp"
#include "retarget/networks/weights_layout.hpp"

namespace understudy::nn {

/// y = x W^T + bias for rows x.
class LinearLayer {
 public:
  LinearLayer() = default;
  /// weight [outputs, inputs], bias [outputs, 1]
  LinearLayer(const Kernels& kernels, const RowMatrix& weight, const RowMatrix& bias);

  int inputs() const { return inputs_; }
  /// Columns of a result: the outputs, and zeros up to a whole panel.
  int width() const { return panels_ * kPanel; }
  /// Rows x [R, inputs() or more] into out [R, width()], which is made to fit unless it is added to.
  void apply(const RowMatrix& x, RowMatrix& out, Finish finish = Finish::Store, bool sparse = false) const;
  /// The same of rows that lie anywhere; what is wanted beyond that is changed before it goes to run().
  /// `next` is fetched into the cache while this layer is computed. Moving either changes nothing.
  void followed_by(const LinearLayer& next) {
    ahead_ = next.packed();
    ahead_size_ = static_cast<std::ptrdiff_t>(next.packed_.size()) * kLineFloats;
  }
  Product product(const float* x, std::ptrdiff_t stride, int rows, float* out) const;
  void run(const Product& product) const { kernels_->multiply(product); }

 private:
  static constexpr int kLineFloats = 16;
  struct alignas(64) Line {
    float numbers[kLineFloats];
  };
  const float* packed() const { return &packed_.data()->numbers[0]; }

  const Kernels* kernels_ = nullptr;
  int inputs_ = 0, panels_ = 0;
  std::vector<Line> packed_;
  std::vector<float> bias_;
  const float* ahead_ = nullptr;
  std::ptrdiff_t ahead_size_ = 0;
};

struct NormLayer {
  std::vector<float> gain, shift;
  /// out = normalised rows of x, plus `add` unless null
  void apply(const Kernels& kernels, const RowMatrix& x, const RowMatrix* add, RowMatrix& out) const;
};

/// A weights file, read layer by layer. Each throws Error naming the file when a tensor is missing or has
/// another shape.
class NetworkWeights {
 public:
  /// Throws Error naming the file when it is no weights file, or of another kind or version.
  NetworkWeights(const std::string& path, const std::string& kind, int version);
  bool has(const std::string& tensor) const { return stored_.tensors.count(tensor) > 0; }
  /// A tensor of that shape, sides of one left out.
  RowMatrix tensor(const std::string& name, Eigen::Index rows, Eigen::Index cols) const;
  LinearLayer linear(const Kernels& kernels, const std::string& name, int inputs, int outputs) const;
  NormLayer norm(const std::string& name, int width) const;

 private:
  std::string path_, bytes_;
  StoredWeights stored_;  // points into bytes_
};

}  // namespace understudy::nn
