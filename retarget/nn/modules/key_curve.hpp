// A curve through the poses that a motion has to be in: what a network of dynamics corrects between them.
#pragma once

#include <torch/torch.h>

namespace understudy::nn {

/// Frames that come, as far as keys tell.
struct KeyCurve {
  torch::Tensor way;   ///< [B, T, width]; no matter what where no key is ahead
  torch::Tensor left;  ///< [B, T, 1] frames until the next key, 0 in it; -1 where there is none
};
/// Piecewise cubic in time through the known frames of `way` [B, T, width], whose columns may be anything
/// that is blended number by number. In each key it goes as the parabola through it and its two neighbours
/// does, which of frames that lie close is how fast they go; at its ends it does not bend: between two keys
/// alone it is a straight line.
/// known: [B, T] bool, on the CPU; the first frame of each sequence is.
KeyCurve curve_through(const torch::Tensor& way, const torch::Tensor& known);

}  // namespace understudy::nn
