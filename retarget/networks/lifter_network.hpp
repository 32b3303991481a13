// 2D poses lifted into space by a small recurrent network.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "retarget/keypoints/flat_pose.hpp"
#include "retarget/pipeline/keypoint_transfer.hpp"
#include "retarget/pipeline/lifter.hpp"

namespace understudy::nn {

/// Of the network's form and what it sees; weights of another version are refused.
constexpr int kLifterVersion = 2;
constexpr int kLifterEmbedded = 256, kLifterHidden = 208, kLifterHead = 224;
/// Its answer: places of the joints (x, y, z; around the middle of the hips, of LiftFrame::size), logarithms
/// of how far each is off, world rotations in 6D, the sine of the camera's pitch.
constexpr int kLifterDoubtsAt = 3 * kJointCount, kLifterTurnsAt = kLifterDoubtsAt + kJointCount,
              kLifterPitchAt = kLifterTurnsAt + 6 * kJointCount, kLifterOutputs = kLifterPitchAt + 1;
/// What the logarithms are kept between.
constexpr float kLeastLogOff = -7, kMostLogOff = 1;
/// The point of the picture beside which each joint's place is told, where point and hips are seen; -1: none,
/// it is told around the hips.
constexpr std::array<int, kJointCount> kPointOfJoint = {-1,
                                                        body25::LeftHip,
                                                        body25::RightHip,
                                                        -1,
                                                        body25::LeftKnee,
                                                        body25::RightKnee,
                                                        -1,
                                                        body25::LeftAnkle,
                                                        body25::RightAnkle,
                                                        -1,
                                                        body25::LeftBigToe,
                                                        body25::RightBigToe,
                                                        body25::Neck,
                                                        -1,
                                                        -1,
                                                        body25::Nose,
                                                        body25::LeftShoulder,
                                                        body25::RightShoulder,
                                                        body25::LeftElbow,
                                                        body25::RightElbow,
                                                        body25::LeftWrist,
                                                        body25::RightWrist};

/// Without LibTorch. It lifts each pose and its mirror image, of a person whose lengths the reader tells from
/// the poses so far. Throws Error naming the file when it is missing, damaged, of another network or of
/// another version.
std::unique_ptr<Lifter> load_network_lifter(const std::string& path,
                                            std::unique_ptr<const LengthReader> lengths);

}  // namespace understudy::nn
