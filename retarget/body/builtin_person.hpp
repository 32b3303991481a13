// The built-in person: a parametric human made by code alone, in the same form as an SMPL body.
#pragma once

#include "retarget/body/body.hpp"

namespace understudy {

/// What a person looks like. Values outside the ranges are an Error.
struct PersonOptions {
  float stature = 1.70f;  ///< sole to crown, metres, 0.6 .. 2.5
  float girth = 1.0f;     ///< waist against the average, 0.75 (thin) .. 1.8 (very heavy)
  float sex = 0.0f;       ///< 0 male .. 1 female
  float age = 30.0f;      ///< years, 2 .. 100
};

/// The person in T-pose, pelvis joint at the origin, facing +z: one closed surface of 8 to 15 thousand
/// vertices, exactly mirror-symmetric in x = 0, with joints and skin weights; pose_dirs is null. The same
/// options give the same bytes. Throws Error when an option is out of its range.
ShapedBody builtin_person(const PersonOptions& options = {});

/// The T-pose joints of that person, without making the surface.
Joints builtin_joints(const PersonOptions& options = {});

/// About how far each point [N, 3] lies outside that person's skin in T-pose, metres, negative inside; the
/// surface is not made for it.
Eigen::VectorXf builtin_distances(const PersonOptions& options, const Points& points);

}  // namespace understudy
