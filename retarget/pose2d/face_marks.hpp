// Nose, eyes and ears of any body, where a detector sees them on a person.
#pragma once

#include "retarget/keypoints/flat_pose.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// From the head's joint, in its frame (the T-pose's axes: the face looks along +z), metres.
struct FaceMarks {
  Vec3 nose, right_eye, left_eye, right_ear, left_ear;
};

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
