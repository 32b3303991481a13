#include "retarget/networks/linear_layer.hpp"

#include <algorithm>
#include <cstring>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"

namespace understudy::nn {

LinearLayer::LinearLayer(const Kernels& kernels, const RowMatrix& weight, const RowMatrix& bias)
    : kernels_(&kernels),
      inputs_(static_cast<int>(weight.cols())),
      panels_(static_cast<int>((weight.rows() + kPanel - 1) / kPanel)),
      packed_(static_cast<size_t>(panels_) * weight.cols() * kPanel / kLineFloats),
      bias_(static_cast<size_t>(panels_) * kPanel) {
  US_CHECK(bias.size() == weight.rows(), "a layer of ", weight.rows(), " outputs with ", bias.size(),
           " biases");
  float* const packed = &packed_.data()->numbers[0];
  for (Eigen::Index n = 0; n < weight.rows(); ++n) {
    bias_[n] = bias.data()[n];
    float* const column = packed + n / kPanel * inputs_ * kPanel + n % kPanel;
    for (int k = 0; k < inputs_; ++k) column[k * kPanel] = weight(n, k);
  }
}

Product LinearLayer::product(const float* x, std::ptrdiff_t stride, int rows, float* out) const {
  return {x,
          stride,
          rows,
          inputs_,
          packed(),
          kPanel,
          static_cast<std::ptrdiff_t>(inputs_) * kPanel,
          panels_,
          bias_.data(),
          out,
          width(),
          Finish::Store,
          ahead_,
          ahead_size_,
          false};
}

void LinearLayer::apply(const RowMatrix& x, RowMatrix& out, Finish finish, bool sparse) const {
  if (finish == Finish::Store || finish == Finish::Relu) out.resize(x.rows(), width());
  Product whole = product(x.data(), x.cols(), static_cast<int>(x.rows()), out.data());
  whole.finish = finish;
  whole.sparse = sparse;
  run(whole);
}

void NormLayer::apply(const Kernels& kernels, const RowMatrix& x, const RowMatrix* add,
                      RowMatrix& out) const {
  out.resize(x.rows(), x.cols());
  kernels.layer_norm({x.data(), static_cast<int>(x.rows()), static_cast<int>(x.cols()), gain.data(),
                      shift.data(), add ? add->data() : nullptr, out.data()});
}

namespace {

/// A shape without its sides of one.
std::vector<int64_t> long_sides(std::vector<int64_t> shape) {
  shape.erase(std::remove(shape.begin(), shape.end(), 1), shape.end());
  return shape;
}

}  // namespace

NetworkWeights::NetworkWeights(const std::string& path, const std::string& kind, int version)
    : path_(path), bytes_(read_file(path)), stored_(parse_weights(bytes_, path)) {
  US_CHECK(stored_.kind == kind, path, ": holds weights for '", stored_.kind, "', not for '", kind, "'");
  US_CHECK(stored_.version == version, path, ": weights of version ", stored_.version,
           ", this program needs version ", version);
}

RowMatrix NetworkWeights::tensor(const std::string& name, Eigen::Index rows, Eigen::Index cols) const {
  const auto found = stored_.tensors.find(name);
  US_CHECK(found != stored_.tensors.end(), path_, ": has no '", name, "'");
  const StoredTensor& from = found->second;
  US_CHECK(long_sides(from.shape) == long_sides({rows, cols}), path_, ": '", name, "' has another shape");
  const size_t count = static_cast<size_t>(rows * cols);  // as many as there are bytes for: parse_weights
  RowMatrix made(rows, cols);
  if (!from.half) {
    std::memcpy(made.data(), from.bytes.data(), from.bytes.size());
    return made;
  }
  for (size_t i = 0; i < count; ++i) {
    uint16_t bits;
    std::memcpy(&bits, from.bytes.data() + 2 * i, 2);
    made.data()[i] = Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(bits));
  }
  return made;
}

LinearLayer NetworkWeights::linear(const Kernels& kernels, const std::string& name, int inputs,
                                   int outputs) const {
  return {kernels, tensor(name + ".weight", outputs, inputs), tensor(name + ".bias", outputs, 1)};
}

NormLayer NetworkWeights::norm(const std::string& name, int width) const {
  const RowMatrix gain = tensor(name + ".weight", 1, width), shift = tensor(name + ".bias", 1, width);
  return {{gain.data(), gain.data() + width}, {shift.data(), shift.data() + width}};
}

}  // namespace understudy::nn
