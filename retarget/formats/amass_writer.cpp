#include "retarget/formats/amass_writer.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr size_t kPoseWidth = 156;  // 52 joints: the 22, and 15 of each hand
constexpr int64_t kBetas = 16;
enum AmassArray : size_t { Poses, Trans };

/// y up to z up: x stays.
Mat3 to_z_up() {
  Mat3 C;
  C << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return C;
}

}  // namespace

AmassWriter::AmassWriter(const std::string& path, double fps) : path_(path), npz_(path) {
  US_CHECK(fps > 0 && std::isfinite(fps), path, ": ", fps, " frames a second cannot be");
  npz_.add_frames("poses", {static_cast<int64_t>(kPoseWidth)});
  npz_.add_frames("trans", {3});
  npz_.add("betas", {kBetas}, std::vector<double>(kBetas, 0.0));
  npz_.add("gender", "neutral");
  npz_.add("mocap_framerate", {}, {fps});
}

void AmassWriter::push(const Pose& pose) {
  std::array<float, kPoseWidth> angles{};
  bool finite = pose.root.allFinite();
  for (size_t j = 0; j < kJointCount; ++j) {
    finite = finite && pose.local[j].allFinite();
    // The world turns, and with it the pelvis; all other joints turn relative to their parents.
    const Mat3 R = j == Pelvis ? Mat3(to_z_up() * pose.local[j]) : pose.local[j];
    const Vec3 turn = rotation_to_axis_angle(R);
    std::copy(turn.data(), turn.data() + 3, angles.data() + 3 * j);
  }
  US_CHECK(finite, path_, ": the pose of frame ", frames_, " is not finite");
  const Vec3 place = to_z_up() * pose.root;
  npz_.push(Poses, angles.data());
  npz_.push(Trans, place.data());
  ++frames_;
}

}  // namespace understudy
