// Sources whose frames can be made in any order and are counted: motions of bodies and skeletons.
#pragma once

#include "app/run/source.hpp"

namespace understudy::app {

/// Frames of an animation: it counts them.
class AnimatedSource : public Source {
 public:
  AnimatedSource(double fps, int64_t frames) : Source(fps), count_(frames) {}
  std::optional<SourceFrame> next() final;
  void seek(int64_t frame) final;
  std::optional<int64_t> count() const final { return count_; }

 private:
  virtual SourceFrame frame_at(int64_t frame) = 0;

  int64_t count_, at_ = 0;
};

/// An octahedron from each joint to each of its children: something to look at.
Mesh bone_shapes(const Joints& joints);

}  // namespace understudy::app
