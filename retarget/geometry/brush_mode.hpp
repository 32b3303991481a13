// What a brush does to weights on a surface.
#pragma once

#include "retarget/base/fields.hpp"

namespace understudy {

enum class BrushMode { Add, Subtract, Smooth };
constexpr Names<3> kBrushModeNames = {"add", "subtract", "smooth"};

}  // namespace understudy
