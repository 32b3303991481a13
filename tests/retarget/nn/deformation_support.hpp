// A small person for tests of the deformation networks: an octahedron around every joint.
#pragma once

#include "retarget/body/body.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::testing {

/// T-pose joints of an adult, metres, symmetric.
Joints adult_joints();
/// 132 vertices; weights fade from joint to joint; pose_dirs bend the neighbourhood of each joint; one shape
/// parameter: size.
Body octahedron_body();
/// That body, three people and one clip of 40 frames.
training::TrainingData octahedron_data();
/// The same as a data folder with splits.json; train and dev alike.
void write_octahedron_data(const std::string& folder);

/// A random pose, up to about 40 degrees a joint.
Pose random_test_pose(uint64_t seed);

}  // namespace understudy::testing
