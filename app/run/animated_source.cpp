#include "app/run/animated_source.hpp"

#include "retarget/base/error.hpp"

namespace understudy::app {

std::optional<SourceFrame> AnimatedSource::next() {
  if (at_ >= count_) return std::nullopt;
  SourceFrame frame = frame_at(at_);
  frame.number = at_++;
  return frame;
}

void AnimatedSource::seek(int64_t frame) {
  US_CHECK(frame >= 0 && frame < count_, "there is no frame ", frame, " in a motion of ", count_);
  at_ = frame;
}

Mesh bone_shapes(const Joints& joints) {
  constexpr float kThickness = 0.09f, kRingAt = 0.15f;  // of a bone's length
  constexpr int kCorners = 6, kFaces = 8;
  Mesh mesh;
  mesh.vertices.resize((kJointCount - 1) * kCorners, 3);
  mesh.faces.resize((kJointCount - 1) * kFaces, 3);
  for (int j = 1; j < kJointCount; ++j) {
    const Vec3 from = joints.row(kParents[j]).transpose(), to = joints.row(j).transpose(), along = to - from;
    const Vec3 side = along.unitOrthogonal() * kThickness * along.norm();
    const Vec3 other = along.stableNormalized().cross(side), ring = from + kRingAt * along;
    const int first = (j - 1) * kCorners;
    int row = first;
    for (const Vec3& v :
         {from, to, Vec3(ring + side), Vec3(ring + other), Vec3(ring - side), Vec3(ring - other)})
      mesh.vertices.row(row++) = v.transpose();
    for (int i = 0; i < 4; ++i) {
      const int a = first + 2 + i, b = first + 2 + (i + 1) % 4, face = (j - 1) * kFaces + 2 * i;
      mesh.faces.row(face) << first, b, a;
      mesh.faces.row(face + 1) << first + 1, a, b;
    }
  }
  return mesh;
}

}  // namespace understudy::app
