#include "retarget/pipeline/human_rest.hpp"

namespace understudy {

const Joints& human_rest() {
  static const Joints rest = (Joints() << 0.0000f, 0.0000f, 0.0000f,  // pelvis
                              0.1267f, -0.0182f, -0.0071f,            // left_hip
                              -0.1267f, -0.0182f, -0.0071f,           // right_hip
                              0.0000f, 0.0907f, -0.0461f,             // spine1
                              0.1702f, -0.5086f, 0.0023f,             // left_knee
                              -0.1702f, -0.5086f, 0.0023f,            // right_knee
                              0.0000f, 0.1735f, -0.0288f,             // spine2
                              0.1878f, -1.0153f, -0.0180f,            // left_ankle
                              -0.1878f, -1.0153f, -0.0180f,           // right_ankle
                              0.0000f, 0.2692f, -0.0288f,             // spine3
                              0.2131f, -1.0919f, 0.1248f,             // left_foot
                              -0.2131f, -1.0919f, 0.1248f,            // right_foot
                              0.0000f, 0.6582f, -0.0037f,             // neck
                              0.0282f, 0.5723f, 0.0167f,              // left_collar
                              -0.0282f, 0.5723f, 0.0167f,             // right_collar
                              0.0000f, 0.7797f, 0.0384f,              // head
                              0.2103f, 0.5817f, 0.0095f,              // left_shoulder
                              -0.2103f, 0.5817f, 0.0095f,             // right_shoulder
                              0.5101f, 0.5816f, 0.0095f,              // left_elbow
                              -0.5101f, 0.5816f, 0.0095f,             // right_elbow
                              0.8011f, 0.5816f, 0.0095f,              // left_wrist
                              -0.8011f, 0.5816f, 0.0095f              // right_wrist
                              )
                                 .finished();
  return rest;
}

Joints rest_with_lengths(const Joints& rest, const Eigen::Array<float, kJointCount, 1>& lengths) {
  Joints result = rest;
  for (int j = 1; j < kJointCount; ++j) {
    const int p = kParents[j];
    result.row(j) = result.row(p) + lengths[j] * (rest.row(j) - rest.row(p)).normalized();
  }
  return result;
}

Eigen::Array<float, kJointCount, 1> bone_lengths(const Joints& joints) {
  Eigen::Array<float, kJointCount, 1> lengths = Eigen::Array<float, kJointCount, 1>::Zero();
  for (int j = 1; j < kJointCount; ++j) lengths[j] = (joints.row(j) - joints.row(kParents[j])).norm();
  return lengths;
}

}  // namespace understudy
