// Transformer layers of trained networks, prepared for the kernels: attention that prefers near tokens. What
// DistanceAttention and EncoderLayer (nn/modules/skeleton_extractor) compute, to rounding.
#pragma once

#include <string>
#include <vector>

#include "retarget/networks/linear_layer.hpp"

namespace understudy::nn {

/// How much each head prefers near tokens; a head is kPanel numbers of a token.
using Nearness = std::vector<float>;

/// Weights and biases of projections of tokens that are computed together.
struct Projection {
  RowMatrix weight, bias;
  Projection scaled(float by) const { return {weight * by, bias * by}; }
  Projection with(const Projection& next) const;
};
/// Of the attention under that name in a file, for tokens of `width` numbers. Queries are scaled already.
Projection queries(const NetworkWeights& file, const std::string& attention, int width);
Projection keys_and_values(const NetworkWeights& file, const std::string& attention, int width);
Nearness nearness(const NetworkWeights& file, const std::string& attention, int width);

/// Two layers with a rectifier between.
struct TwoLayers {
  LinearLayer first, second;
  mutable RowMatrix hidden{};
  void apply(const RowMatrix& x, RowMatrix& out, Finish finish = Finish::Store) const {
    first.apply(x, hidden, Finish::Relu);
    second.apply(hidden, out, finish, /*sparse=*/true);
  }
};
/// `name`.0 and `name`.2 of a file.
TwoLayers two_layers(const NetworkWeights& file, const Kernels& with, const std::string& name, int inputs,
                     int hidden, int outputs);
/// `name`.up and `name`.down: twice as wide inside.
TwoLayers feed_forward(const NetworkWeights& file, const Kernels& with, const std::string& name, int width);

/// What a patch of points looks like: two rectified layers over each point, the largest of every number.
struct PatchLayers {
  LinearLayer first, second;
  mutable RowMatrix hidden{};
  /// `points` [count, 3]; `looks` begins as zeros, as many as the second layer's width().
  void apply(const float* points, int count, float* looks) const;
};

struct EncoderLayerWeights {
  NormLayer norm1, norm2;
  LinearLayer qkv, out;
  Nearness near;
  TwoLayers feed;
};
EncoderLayerWeights encoder_layer(const NetworkWeights& file, const Kernels& with, const std::string& name,
                                  int width);

/// [Q, 3], [K, 3] -> [Q, K], zeros up to a whole panel.
RowMatrix squared_distances(const Points& a, const Points& b);

/// Queries, keys and values in rows of their own strides; the heads' columns lie one behind the other.
struct Attended {
  const float *q, *k, *v;
  std::ptrdiff_t q_stride, kv_stride;
  int queries, keys;
};

/// Computes the layers; keeps its buffers between calls.
class Transformer {
 public:
  explicit Transformer(const Kernels& with) : kernels_(&with) {}
  /// What each query sees, [queries, width]; until the next call.
  const RowMatrix& attend(const Attended& a, const RowMatrix& squared, const Nearness& near);
  /// x [N, width] after a layer; `position` joins what is looked at.
  void encode(const EncoderLayerWeights& layer, const RowMatrix& position, const RowMatrix& squared,
              RowMatrix& x);

 private:
  const Kernels* kernels_;
  RowMatrix h_, qkv_, turned_keys_, scores_, mixed_;
};

}  // namespace understudy::nn
