#include "app/run/flat_samples.hpp"

#include <utility>
#include <vector>

#include "render/image.hpp"
#include "render/surface_pictures.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"
#include "retarget/pose2d/flat_people.hpp"

namespace understudy::app {
namespace {

constexpr Canvas kFilm{1024, 768}, kPicture{1024, 768};
constexpr float kFilmRate = 30;
constexpr int kFilmFrames = 90;
constexpr int kFewest = 5;  // points of somebody

/// One of the built-in people, and what they do.
struct FlatActor {
  ShapedBody body;
  FlatPerson person;
  std::vector<Pose> poses;
};

/// From `from` seconds on, turned by `turn` about +y and moved.
FlatActor flat_actor(const PersonOptions& options, const char* motion, float from, float turn,
                     const Vec3& way) {
  FlatActor actor{builtin_person(options), {}, {}};
  actor.person = flat_person(actor.body.vertices, actor.body.joints,
                             head_vertices(actor.body.vertices, actor.body.joints));
  const Mat3 turned = Eigen::AngleAxisf(turn, Vec3::UnitY()).toRotationMatrix();
  const Motion all = builtin_motion(motion, actor.body.joints, kFilmRate);
  for (size_t i = static_cast<size_t>(from * kFilmRate); i < all.poses.size(); ++i) {
    Pose pose = all.poses[i];
    pose.local[Pelvis] = turned * pose.local[Pelvis];
    pose.root = turned * pose.root + way;
    actor.poses.push_back(pose);
  }
  return actor;
}

Pinhole sample_camera(const Vec3& target, float yaw, float pitch, float distance, float focal,
                      const Canvas& canvas) {
  Pinhole camera = looking_at(target, camera_axes(yaw, pitch), distance);
  camera.focal = focal;
  camera.centre = {static_cast<float>(canvas.width - 1) / 2, static_cast<float>(canvas.height - 1) / 2};
  return camera;
}

KeypointReading empty_film(const Canvas& canvas, int frames) {
  KeypointReading film;
  film.canvas = canvas;
  film.fps = static_cast<double>(kFilmRate);
  film.frames.resize(static_cast<size_t>(frames));
  for (size_t t = 0; t < film.frames.size(); ++t) film.frames[t].number = static_cast<int64_t>(t);
  return film;
}

/// Without what lies off the canvas: no detector sees it.
FlatPose in_picture(FlatPose pose, const Canvas& canvas) {
  for (int point = 0; point < kBodyPoints; ++point) {
    const Vec2 at = pose.at(point);
    if (at.minCoeff() < 0 || at.x() > static_cast<float>(canvas.width - 1) ||
        at.y() > static_cast<float>(canvas.height - 1))
      pose.forget(point);
  }
  return pose;
}

void add_track(const FlatActor& actor, const Pinhole& camera, const DetectorErrors& errors, Rng& rng,
               KeypointReading& film) {
  KeypointTrack track;
  track.person = static_cast<int64_t>(film.tracks.size()) + 1;
  for (size_t t = 0; t < film.frames.size() && t < actor.poses.size(); ++t) {
    const FlatSight sight = seen_flat(actor.person, actor.poses[t], camera);
    TrackedPose seen{static_cast<int64_t>(t), 1, in_picture(detected(sight, errors, rng), film.canvas)};
    if (points_seen(seen.pose) >= kFewest) track.poses.push_back(std::move(seen));
  }
  film.tracks.push_back(std::move(track));
}

/// Two people before a camera that looks a little down.
KeypointReading sample_film() {
  KeypointReading film = empty_film(kFilm, kFilmFrames);
  const FlatActor dancer = flat_actor({1.68f, 1.0f, 1, 28}, "dance", 1.2f, 0, Vec3::Zero()),
                  walker = flat_actor({1.80f, .95f, 0, 35}, "walk", 1, kPi / 2, Vec3(-3.5f, 0, -1.6f));
  const Pinhole camera = sample_camera(Vec3(0, 0.95f, 0), 0.3f, 0.12f, 4.6f, 1250, kFilm);
  DetectorErrors errors;
  errors.jitter_m = 0.006f;
  errors.missing = 0.01f;
  errors.hides_face = true;
  errors.confidence = DetectorErrors::Confidence::Honest;
  Rng rng(22);
  add_track(dancer, camera, errors, rng, film);
  add_track(walker, camera, errors, rng, film);
  return film;
}

Points posed_surface(const FlatActor& actor) {
  return linear_blend_skinning(actor.body.vertices, actor.body.weights, actor.body.joints,
                               forward_kinematics(actor.body.joints, actor.poses[0]));
}

/// What the camera sees under a lamp above it, before a plain wall.
render::Image lit_picture(const FlatActor& actor, const Pinhole& camera, const Canvas& canvas) {
  const Vec3 wall(0.82f, 0.84f, 0.86f), clay(0.62f, 0.68f, 0.75f);
  const Points surface = posed_surface(actor), normals = vertex_normals(surface, actor.body.faces);
  const SurfaceView seen = surface_view(camera, canvas.width, canvas.height, surface, actor.body.faces);
  const Vec3 lamp = camera.rotation * Vec3(-0.3f, 0.6f, 0.75f).normalized();
  render::Image picture(canvas.width, canvas.height, wall);
  for (int y = 0; y < canvas.height; ++y)
    for (int x = 0; x < canvas.width; ++x) {
      const size_t at = seen.at(x, y);
      if (seen.face[at] < 0) continue;
      Vec3 normal = Vec3::Zero();
      for (int k = 0; k < 3; ++k)
        normal += seen.shares[at][k] * normals.row(actor.body.faces(seen.face[at], k)).transpose();
      const float light = 0.45f + 0.6f * std::max(0.0f, normal.normalized().dot(lamp));
      for (int c = 0; c < 3; ++c)
        picture.at(x, y)[c] = static_cast<uint8_t>(std::min(255.0f, 255 * light * clay[c] + 0.5f));
    }
  return picture;
}

void write_reference(const std::string& folder) {
  FlatActor girl = flat_actor({1.15f, 1.0f, 1, 6}, "dance", 0, 0, Vec3::Zero());
  const Pinhole camera = sample_camera(Vec3(0.32f, 0.56f, 0), -0.1f, 0.08f, 4, 2000, kPicture);
  KeypointReading picture = empty_film(kPicture, 1);
  Rng rng(6);
  add_track(girl, camera, {}, rng, picture);
  write_controlnet(folder + "/reference.json", picture);
  render::write_png(folder + "/reference.png", lit_picture(girl, camera, kPicture));
}

}  // namespace

void write_flat_samples(const std::string& folder) {
  write_openpose_folder(folder + "/poses", sample_film());
  write_reference(folder);
}

}  // namespace understudy::app
