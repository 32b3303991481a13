// The surface of an animated character, frame by frame.
#pragma once

#include "retarget/character/character.hpp"

namespace understudy {

/// All parts as one mesh. Keeps no more than which vertices are one; the character must outlive it.
class MovingSurface {
 public:
  explicit MovingSurface(const Character& character);
  /// In the file's units and axes.
  Mesh at(const PosedNodes& posed) const;

 private:
  const Character& character_;
  MergedSurface merged_;
};

}  // namespace understudy
