#include "retarget/pose2d/face_marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace understudy {
namespace {

constexpr size_t kFewest = 24;    // vertices that make a head
constexpr float kFollows = 0.5f;  // of a vertex of the head
// a grown person's, metres, to whom the usual marks belong
constexpr float kUsualSpan = 1.4f;   // of legs and trunk
constexpr float kUsualNeck = 0.11f;  // from its joint to the head's

/// The box about the head but for stray hairs: a hundredth of the vertices on each side counts as none.
struct HeadBox {
  Vec3 low, high;
  Vec3 size() const { return high - low; }
  /// 0..1 from the chin to the top, from the person's right to the left, from the back to the front.
  Vec3 at(float x, float y, float z) const { return low + Vec3(x, y, z).cwiseProduct(size()); }
};

HeadBox box_of_head(const std::vector<Vec3>& head) {
  HeadBox box;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> along;
    along.reserve(head.size());
    for (const Vec3& point : head) along.push_back(point[axis]);
    std::sort(along.begin(), along.end());
    const size_t stray = along.size() / 100;
    box.low[axis] = along[stray], box.high[axis] = along[along.size() - 1 - stray];
  }
  return box;
}

/// The vertex that is farthest in a direction among those within `reach` of the box's size (0: any) of a
/// place in the box; the place itself where there is none.
Vec3 farthest_near(const std::vector<Vec3>& head, const HeadBox& box, const Vec3& place, const Vec3& reach,
                   const Vec3& direction) {
  Vec3 best = place;
  float most = -1e9f;
  for (const Vec3& point : head) {
    const Vec3 off = (point - place).cwiseAbs().cwiseQuotient(box.size());
    bool is_near = true;
    for (int axis = 0; axis < 3; ++axis) is_near &= reach[axis] == 0 || off[axis] <= reach[axis];
    if (!is_near || point.dot(direction) <= most) continue;
    most = point.dot(direction);
    best = point;
  }
  return best;
}

/// Sideways and up as wanted, as deep as the surface is there.
Vec3 eye_at(const std::vector<Vec3>& head, const HeadBox& box, float side) {
  const Vec3 place = box.at(0.5f + 0.2f * side, 0.46f, 0.85f);
  const Vec3 surface = farthest_near(head, box, place, Vec3(0.12f, 0.08f, 0), Vec3::UnitZ());
  return {place.x(), place.y(), surface.z()};
}

Vec3 ear_at(const std::vector<Vec3>& head, const HeadBox& box, float side) {
  const Vec3 place = box.at(0.5f + 0.5f * side, 0.42f, 0.45f);
  const Vec3 surface = farthest_near(head, box, place, Vec3(0, 0.1f, 0.25f), side * Vec3::UnitX());
  return {surface.x(), place.y(), place.z()};
}

}  // namespace

FaceMarks usual_face_marks(const Joints& rest) {
  const float trunk = (rest.row(Neck) - rest.row(Pelvis)).norm();
  const float neck = (rest.row(Head) - rest.row(Neck)).norm();
  // children's heads are larger than their legs, and their necks are, too
  const float s = std::sqrt((leg_length(rest) + trunk) / kUsualSpan * std::max(neck, 0.03f) / kUsualNeck);
  return {s * Vec3(0, -0.009f, 0.115f), s * Vec3(-0.034f, 0.035f, 0.094f), s * Vec3(0.034f, 0.035f, 0.094f),
          s * Vec3(-0.087f, 0.025f, -0.009f), s * Vec3(0.087f, 0.025f, -0.009f)};
}

FaceMarks face_marks(const Joints& rest, const Points& vertices,
                     const Eigen::Ref<const Eigen::VectorXf>& of_head) {
  std::vector<Vec3> head;  // from the joint
  for (Eigen::Index v = 0; v < vertices.rows(); ++v)
    if (of_head[v] > kFollows && vertices.row(v).allFinite())
      head.push_back((vertices.row(v) - rest.row(Head)).transpose());
  if (head.size() < kFewest) return usual_face_marks(rest);
  const HeadBox box = box_of_head(head);
  if (!(box.size().minCoeff() > 1e-4f)) return usual_face_marks(rest);
  FaceMarks marks;
  marks.nose = farthest_near(head, box, box.at(0.5f, 0.35f, 1), Vec3(0.15f, 0.17f, 0), Vec3::UnitZ());
  marks.nose.x() = box.at(0.5f, 0, 0).x();
  marks.right_eye = eye_at(head, box, -1), marks.left_eye = eye_at(head, box, 1);
  marks.right_ear = ear_at(head, box, -1), marks.left_ear = ear_at(head, box, 1);
  return marks;
}

std::string face_mark_label(FaceMark mark) {
  std::string label = kFaceMarkNames[static_cast<size_t>(mark)];
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

Vec3& place_of(FaceMark mark, FaceMarks& marks) {
  switch (mark) {
    case FaceMark::RightEye:
      return marks.right_eye;
    case FaceMark::LeftEye:
      return marks.left_eye;
    case FaceMark::RightEar:
      return marks.right_ear;
    case FaceMark::LeftEar:
      return marks.left_ear;
    case FaceMark::Nose:
      break;
  }
  return marks.nose;
}

int point_of(FaceMark mark) {
  return mark == FaceMark::Nose ? body25::Nose : body25::RightEye + static_cast<int>(mark) - 1;
}

FaceMove mirrored(const FaceMove& move, float centre) {
  constexpr std::array<FaceMark, 5> kOther = {FaceMark::Nose, FaceMark::LeftEye, FaceMark::RightEye,
                                              FaceMark::LeftEar, FaceMark::RightEar};
  FaceMove out{kOther[static_cast<size_t>(move.mark)], move.place};
  out.place.x() = move.mark == FaceMark::Nose ? centre : 2 * centre - move.place.x();
  return out;
}

void put(const FaceMove& move, std::vector<FaceMove>& among) {
  among.erase(
      std::remove_if(among.begin(), among.end(), [&](const FaceMove& old) { return old.mark == move.mark; }),
      among.end());
  among.push_back(move);
}

FaceMarks moved_marks(FaceMarks found, const Joints& rest, const std::vector<FaceMove>& moves) {
  for (const FaceMove& move : moves) place_of(move.mark, found) = move.place - rest.row(Head).transpose();
  return found;
}

}  // namespace understudy
