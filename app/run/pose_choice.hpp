// What pose pictures of a performed motion are to show: camera, canvas, moments, drawing.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "render/pose_picture.hpp"
#include "retarget/geometry/pinhole.hpp"

namespace understudy::app {

/// A camera as a user says it. What is left open: level, before the front of the first frame,
/// so far away that the whole take is in the picture.
struct PictureCamera {
  std::optional<float> yaw_deg;                         ///< 0 looks at the front of a T-pose; 90 from +x
  std::optional<float> pitch_deg, distance_m, fov_deg;  ///< fov: vertical
  std::optional<Vec3> target;                           ///< metres
  bool orthographic = false;
  std::string reference;  ///< a file of 2D poses: the camera that lays the first frame onto its first
};
/// "yaw=30,pitch=10,distance=4,fov=40", "orthographic" among it, or the path of a JSON: an object of yaw_deg,
/// pitch_deg, distance_m, fov_deg, target [x, y, z] and orthographic, or of 2D poses, which is then the
/// reference. Throws Error, a sentence that names what is wrong, or the file.
PictureCamera picture_camera(const std::string& words);

/// Sees all points (of all frames, in the world) where the camera leaves it open. front: radians about +y,
/// where who is filmed faces first. Pixels as files of 2D poses count them.
Pinhole film_camera(const PictureCamera& camera, const Points& points, float front, const Canvas& canvas);

/// A size that generators of pictures and films take.
struct CanvasPreset {
  const char* words;  ///< for whom
  Canvas canvas;
};
extern const std::array<CanvasPreset, 9> kCanvasPresets;

/// How many pictures.
struct PictureCount {
  int count = 0;  ///< 0: as many as the take lasts
  bool is_4n_plus_1 =
      false;  ///< the take is cut to the most that is 1, 5, 9, ...: film generators ask for it
};
/// "81" or "4n+1". Throws Error for anything else.
PictureCount picture_count(const std::string& text);

/// What is written beside the pictures.
enum class PoseFile { ControlNet, OpenPose, None };
constexpr Names<3> kPoseFileNames{"controlnet", "openpose", "none"};

struct PoseChoice {
  std::optional<Canvas> canvas;  ///< none: the reference's, else 832 x 480
  PictureCamera camera;
  double rate = 0;     ///< pictures a second; 0: the source's
  PictureCount count;  ///< more than the take lasts: its last pose stays
  render::PosePictureOptions drawing;
  bool hides_face = true;    ///< what of the face is turned away vanishes
  bool hides_limbs = false;  ///< what another part of the body hides vanishes; detectors guess it
  PoseFile file = PoseFile::ControlNet;
  bool depth = false, normals = false, mask = false;  ///< films of the same view, beside it
};
/// Whether nothing in it was chosen.
bool is_usual(const PoseChoice& poses);

}  // namespace understudy::app
