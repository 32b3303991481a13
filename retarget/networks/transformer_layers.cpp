#include "retarget/networks/transformer_layers.hpp"

#include <cmath>

namespace understudy::nn {
namespace {

Projection projection(const NetworkWeights& file, const std::string& name, int width) {
  return {file.tensor(name + ".weight", width, width), file.tensor(name + ".bias", width, 1)};
}

RowMatrix stacked(const RowMatrix& a, const RowMatrix& b) {
  RowMatrix both(a.rows() + b.rows(), a.cols());
  both << a, b;
  return both;
}

}  // namespace

Projection Projection::with(const Projection& next) const {
  return {stacked(weight, next.weight), stacked(bias, next.bias)};
}

Projection queries(const NetworkWeights& file, const std::string& attention, int width) {
  return projection(file, attention + ".to_q", width).scaled(1 / std::sqrt(static_cast<float>(kPanel)));
}

Projection keys_and_values(const NetworkWeights& file, const std::string& attention, int width) {
  return projection(file, attention + ".to_k", width).with(projection(file, attention + ".to_v", width));
}

/// softplus of what was learned
Nearness nearness(const NetworkWeights& file, const std::string& attention, int width) {
  const RowMatrix learned = file.tensor(attention + ".nearness", 1, width / kPanel);
  Nearness found;
  for (Eigen::Index head = 0; head < learned.cols(); ++head)
    found.push_back(std::log1p(std::exp(learned(0, head))));
  return found;
}

TwoLayers two_layers(const NetworkWeights& file, const Kernels& with, const std::string& name, int inputs,
                     int hidden, int outputs) {
  return {file.linear(with, name + ".0", inputs, hidden), file.linear(with, name + ".2", hidden, outputs)};
}

TwoLayers feed_forward(const NetworkWeights& file, const Kernels& with, const std::string& name, int width) {
  return {file.linear(with, name + ".up", width, 2 * width),
          file.linear(with, name + ".down", 2 * width, width)};
}

void PatchLayers::apply(const float* points, int count, float* looks) const {
  hidden.resize(count, first.width());
  Product one = first.product(points, 3, count, hidden.data());
  one.finish = Finish::Relu;
  first.run(one);
  Product two = second.product(hidden.data(), hidden.cols(), count, looks);
  two.finish = Finish::Max;
  second.run(two);
}

EncoderLayerWeights encoder_layer(const NetworkWeights& file, const Kernels& with, const std::string& name,
                                  int width) {
  const std::string attention = name + ".attention";
  const Projection qkv = queries(file, attention, width).with(keys_and_values(file, attention, width));
  return {file.norm(name + ".norm1", width),       file.norm(name + ".norm2", width),
          LinearLayer(with, qkv.weight, qkv.bias), file.linear(with, attention + ".to_out", width, width),
          nearness(file, attention, width),        feed_forward(file, with, name + ".feed", width)};
}

RowMatrix squared_distances(const Points& a, const Points& b) {
  RowMatrix squared(a.rows(), (b.rows() + kPanel - 1) / kPanel * kPanel);
  squared.setZero();
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    squared.row(i).head(b.rows()) = (b.rowwise() - a.row(i)).rowwise().squaredNorm().transpose();
  return squared;
}

const RowMatrix& Transformer::attend(const Attended& a, const RowMatrix& squared, const Nearness& near) {
  const int panels = (a.keys + kPanel - 1) / kPanel, padded = panels * kPanel;
  const auto width = static_cast<Eigen::Index>(near.size()) * kPanel;
  turned_keys_.setZero(panels * kPanel, kPanel);
  scores_.resize(a.queries, padded);
  mixed_.resize(a.queries, width);
  for (size_t head = 0; head < near.size(); ++head) {
    const size_t column = head * kPanel;
    for (int n = 0; n < a.keys; ++n) {
      const float* const key = a.k + n * a.kv_stride + column;
      float* const to = turned_keys_.data() + n / kPanel * kPanel * kPanel + n % kPanel;
      for (int i = 0; i < kPanel; ++i) to[i * kPanel] = key[i];
    }
    kernels_->multiply({a.q + column, a.q_stride, a.queries, kPanel, turned_keys_.data(), kPanel,
                        kPanel * kPanel, panels, nullptr, scores_.data(), padded, Finish::Store, nullptr, 0,
                        false});
    kernels_->softmax(
        {scores_.data(), padded, squared.data(), squared.cols(), a.queries, a.keys, near[head]});
    kernels_->multiply({scores_.data(), padded, a.queries, a.keys, a.v + column, a.kv_stride, 0, 1, nullptr,
                        mixed_.data() + column, width, Finish::Store, nullptr, 0, false});
  }
  return mixed_;
}

void Transformer::encode(const EncoderLayerWeights& layer, const RowMatrix& position,
                         const RowMatrix& squared, RowMatrix& x) {
  const auto tokens = static_cast<int>(x.rows());
  const auto width = static_cast<std::ptrdiff_t>(x.cols());
  layer.norm1.apply(*kernels_, x, &position, h_);
  layer.qkv.apply(h_, qkv_);
  const float* const q = qkv_.data();
  layer.out.apply(
      attend({q, q + width, q + 2 * width, 3 * width, 3 * width, tokens, tokens}, squared, layer.near), x,
      Finish::Add);
  layer.norm2.apply(*kernels_, x, nullptr, h_);
  layer.feed.apply(h_, x, Finish::Add);
}

}  // namespace understudy::nn
