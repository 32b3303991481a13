// What networks of this size are computed with: products of a few rows with a prepared matrix, and what lies
// between them. Compiled for several instruction sets; the processor decides which one runs. No header but
// this one may be seen by those files: an inline function compiled for one processor would serve all.
#pragma once

#include <cstddef>

namespace understudy::nn {

constexpr int kPanel = 32;       ///< columns of a prepared matrix lie together by so many
constexpr int kRowBlock = 8;     ///< rows that are computed together, at most
constexpr int kMostInner = 512;  ///< longest row of a left factor whose zeros are skipped

enum class Finish {
  Store,  ///< c = a b + bias
  Relu,   ///< c = max(0, a b + bias)
  Add,    ///< c += a b + bias
  Max     ///< c [1, N] = max(c, every row of a b + bias)
};

/// a [rows, inner] times b [inner, panels * kPanel]. Strides are in floats. b lies by panels: row k of panel
/// p begins at b + p * panel_stride + k * b_stride.
struct Product {
  const float* a;
  std::ptrdiff_t a_stride;
  int rows, inner;
  const float* b;
  std::ptrdiff_t b_stride, panel_stride;
  int panels;
  const float* bias;  ///< [panels * kPanel] or null
  float* c;
  std::ptrdiff_t c_stride;
  Finish finish;
  /// What is needed next, [ahead_size] floats: fetched into the cache meanwhile; null: nothing.
  const float* ahead;
  std::ptrdiff_t ahead_size;
  bool sparse;  ///< many of a's numbers are 0: those that are so in a whole block of rows are skipped
};

/// Each row of x [rows, width] normalised, times gain, plus shift, and plus `add` [rows, width] unless null.
/// Rows lie without gaps; width is a multiple of kPanel.
struct LayerNormed {
  const float* x;
  int rows, width;
  const float *gain, *shift, *add;
  float* out;
};

/// Rows of scores [rows, stride]: exp(score - factor * squared), over their sum; the first `count` of each.
/// Those behind them become 0. count <= stride, a multiple of kPanel.
struct Softmaxed {
  float* scores;
  std::ptrdiff_t stride;
  const float* squared;
  std::ptrdiff_t squared_stride;
  int rows, count;
  float factor;
};

struct Kernels {
  const char* name;
  void (*multiply)(const Product&);
  void (*layer_norm)(const LayerNormed&);
  void (*softmax)(const Softmaxed&);
  void (*silu)(float* x, std::ptrdiff_t count);  ///< x / (1 + exp(-x)) in place; count: a multiple of kPanel
};

/// The fastest that this processor can run.
const Kernels& kernels();
const Kernels& plain_kernels();   ///< for any processor
const Kernels* avx2_kernels();    ///< null where they were not compiled
const Kernels* avx512_kernels();  ///< null where they were not compiled

}  // namespace understudy::nn
