// Nose, eyes and ears of any body, where a detector sees them on a person.
#pragma once

#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/keypoints/flat_pose.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// From the head's joint, in its frame (the T-pose's axes: the face looks along +z), metres.
struct FaceMarks {
  Vec3 nose, right_eye, left_eye, right_ear, left_ear;
};
/// One of them, in their order, which is BODY_25's of the nose and of its points from the right eye.
enum class FaceMark { Nose, RightEye, LeftEye, RightEar, LeftEar };
constexpr Names<5> kFaceMarkNames{"nose", "right_eye", "left_eye", "right_ear", "left_ear"};
/// "left eye"
std::string face_mark_label(FaceMark mark);
Vec3& place_of(FaceMark mark, FaceMarks& marks);
/// The point of BODY_25 that it is seen as.
int point_of(FaceMark mark);

/// A mark put where the user wants it.
struct FaceMove {
  FaceMark mark = FaceMark::Nose;
  Vec3 place = Vec3::Zero();  ///< metres, in the T-pose
};
template <class V, class S>
FieldsOf<S, FaceMove> fields(V& visit, S& move) {
  visit("mark", move.mark, kFaceMarkNames);
  visit("place", move.place);
}
/// The same on the other side of the plane x = `centre`; the nose comes to lie in it.
FaceMove mirrored(const FaceMove& move, float centre);
/// Puts it among the others: one a mark.
void put(const FaceMove& move, std::vector<FaceMove>& among);
/// The moved marks over those that were found. rest: T-pose.
FaceMarks moved_marks(FaceMarks found, const Joints& rest, const std::vector<FaceMove>& moves);

/// Of a body of these T-pose joints of which nothing else is known: where a grown person has them, scaled
/// with legs, trunk and neck.
FaceMarks usual_face_marks(const Joints& rest);

/// Found on a head's surface. vertices [V, 3] in T-pose, of_head [V]: how much each follows the head, 0..1.
/// The nose is the most forward point of the face's middle, the eyes are nearly half-way up, the ears
/// at the widest place there. Where fewer than 24 vertices follow the head, or they have no size, the usual
/// ones.
FaceMarks face_marks(const Joints& rest, const Points& vertices,
                     const Eigen::Ref<const Eigen::VectorXf>& of_head);

}  // namespace understudy
