#include "app/run/pose_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "render/surface_pictures.hpp"
#include "render/video_writer.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"
#include "retarget/pose2d/camera_fit.hpp"
#include "retarget/skeleton/pose_curve.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr Canvas kUsualCanvas{832, 480};
constexpr int kHeldSurfaces = 48;    // frames whose surface the picture is sure to hold
constexpr float kBodyDepth = 0.25f;  // metres: how far the surface is from the joints, at most
constexpr int kFilmQuality = 8;      // sticks are four pixels wide

/// An MP4 or a folder of PNGs; there when it is whole.
class PictureFilm {
 public:
  PictureFilm(const std::string& path, const Canvas& canvas, double fps,
              PartFolder::Frames appear = PartFolder::Frames::Together) {
    if (is_picture_folder(path)) {
      folder_ = std::make_unique<PartFolder>(path, appear);
      return;
    }
    render::VideoOptions options;
    options.width = canvas.width, options.height = canvas.height;
    options.fps = fps;
    options.quality = kFilmQuality;
    options.repeatable = true;
    film_ = std::make_unique<render::VideoWriter>(path, options);
  }
  void push(const render::Image& image) {
    if (film_) film_->push(image);
    if (folder_) folder_->add(printed("frame_%05d.png", frames_), render::png_file(image, PartFolder::kMark));
    ++frames_;
  }
  void finish() {
    if (film_) film_->finish();
    if (folder_) folder_->finish();
  }

 private:
  std::unique_ptr<render::VideoWriter> film_;
  std::unique_ptr<PartFolder> folder_;
  int frames_ = 0;
};

/// Of the path without its suffix and its last slash.
fs::path stem_of(const std::string& path) {
  fs::path stem = fs::path(path).lexically_normal();
  if (!stem.has_filename()) stem = stem.parent_path();
  return is_picture_folder(path) ? stem : stem.replace_extension();
}

/// "control.mp4", "_depth": "control_depth.mp4".
std::string beside(const std::string& path, const std::string& what) {
  return stem_of(path).string() + what + (is_picture_folder(path) ? "" : file_suffix(path));
}

/// Where the points are written beside pictures; empty: none are wanted.
std::string pose_file_of(const std::string& path, PoseFile file) {
  if (file_suffix(path) == ".json") return path;
  if (file == PoseFile::None) return "";
  return stem_of(path).string() + (file == PoseFile::ControlNet ? ".json" : "_openpose");
}

void write_poses_beside(const std::string& pictures, const KeypointReading& reading, PoseFile file) {
  const std::string path = pose_file_of(pictures, file);
  if (path.empty()) return;
  if (file_suffix(path) == ".json")
    write_controlnet(path, reading);
  else
    write_openpose_folder(path, reading);
}

/// All people of a frame.
render::Image picture_of(const KeypointReading& reading, int64_t frame, const PoseChoice& choice) {
  std::vector<FlatPose> people;
  for (const KeypointTrack& track : reading.tracks)
    if (const FlatPose* pose = track.at(frame)) people.push_back(*pose);
  return render::pose_picture(people, reading.canvas, choice.drawing);
}

/// The poses at other moments than those of their frames.
std::vector<Pose> poses_at_rate(const std::vector<Pose>& poses, double fps, const PoseChoice& choice) {
  const double rate = choice.rate > 0 ? choice.rate : fps;
  const double last = static_cast<double>(poses.size() - 1);
  int count = static_cast<int>(std::floor(last / fps * rate + 1e-6)) + 1;
  if (choice.count.is_4n_plus_1) count = count - (count - 1) % 4;
  if (choice.count.count > 0) count = choice.count.count;
  std::vector<Pose> out;
  for (int i = 0; i < count; ++i) {
    const double at = std::min(i / rate * fps, last);
    const auto before = static_cast<size_t>(std::floor(at + 1e-9));
    const size_t after = std::min(before + 1, poses.size() - 1);
    const double share = std::max(0.0, at - static_cast<double>(before));
    out.push_back(between(poses[before], poses[after], static_cast<float>(share)));
  }
  return out;
}

/// The first pose of who performs in a reference, moved onto the canvas: as large as fits, in its middle.
FlatPose reference_pose(const KeypointReading& reading, const Canvas& canvas) {
  FlatPose pose = reading.performing().poses.at(0).pose;
  const Vec2 from(static_cast<float>(reading.canvas.width), static_cast<float>(reading.canvas.height));
  const Vec2 to(static_cast<float>(canvas.width), static_cast<float>(canvas.height));
  const float scale = to.cwiseQuotient(from).minCoeff();
  const Vec2 half(0.5f, 0.5f);  // a pixel's middle is half a pixel from its corner
  for (int point = 0; point < kBodyPoints; ++point)
    if (pose.has(point))
      pose.set(point, scale * (pose.at(point) + half - from / 2) + to / 2 - half, pose.confidence(point));
  return pose;
}

/// Who faces where: radians about +y, 0 along +z.
float front_of(const Joints& joints) {
  const Vec3 across = (joints.row(LeftHip) - joints.row(RightHip)).transpose();
  const Vec3 ahead = across.cross(Vec3::UnitY());
  return std::atan2(ahead.x(), ahead.z());
}

class PosePictures final : public MotionOutput {
 public:
  PosePictures(std::string path, const ExportBody& body, std::string name, double fps)
      : path_(std::move(path)), body_(body), choice_(body.poses), name_(std::move(name)), fps_(fps) {
    rest_ = body.file.joints.value_or(body.character->target.joints);
    marks_ = marks_of(body);
    check_choice();
  }
  void push(const ExportFrame& frame) override {
    Pose pose = frame.pose;
    if (body_.file.in_place) pose.root = Vec3(rest_(Pelvis, 0), pose.root.y(), rest_(Pelvis, 2));
    poses_.push_back(pose);
  }
  bool is_written_at_end() const override { return true; }
  ExportCost finish() override;

 private:
  struct Filmed {
    Pose pose;
    BodyPlaces places;
    Mat3 head;
  };
  void check_choice();
  void film_poses();
  Pinhole find_camera() const;
  Points held_points() const;
  void see_people();
  void check_anybody() const;
  void write_pictures();
  void write_surfaces(const Filmed& frame, std::array<std::unique_ptr<PictureFilm>, 3>& films) const;
  void write_pose_file() const;
  bool has_surface() const { return body_.character->target.mesh.faces.rows() > 0; }
  SurfaceView seen(const Points& vertices) const {
    return surface_view(camera_, canvas_.width, canvas_.height, vertices, body_.character->target.mesh.faces);
  }
  void progress(double done) const {
    if (body_.file.progress) body_.file.progress(static_cast<float>(done));
  }
  double rate() const { return choice_.rate > 0 ? choice_.rate : fps_; }

  std::string path_;
  ExportBody body_;
  PoseChoice choice_;
  std::string name_;
  double fps_;
  Joints rest_;
  BodyMarks marks_;
  Canvas canvas_ = kUsualCanvas;
  std::optional<KeypointReading> reference_;
  std::vector<Pose> poses_;     // as they come
  std::vector<Filmed> frames_;  // a picture each
  Pinhole camera_;
  render::DepthRange depth_;
  std::vector<FlatPose> seen_;  // of each picture
};

void PosePictures::check_choice() {
  US_CHECK(std::isfinite(choice_.rate) && (choice_.rate == 0 || (choice_.rate >= 1 && choice_.rate <= 1000)),
           path_, ": pictures come at 1 to 1000 a second, not ", choice_.rate);
  check_not_read(pose_file_of(path_, choice_.file), {choice_.camera.reference});
  if (!choice_.camera.reference.empty()) reference_ = read_keypoints(choice_.camera.reference);
  if (choice_.canvas)
    canvas_ = *choice_.canvas;
  else if (reference_)
    canvas_ = reference_->canvas;
  constexpr int kLargest = 16384;
  US_CHECK(canvas_.is_known() && canvas_.width <= kLargest && canvas_.height <= kLargest, path_,
           ": a canvas has sides of 1 to 16384 pixels, not ", canvas_text(canvas_));
  const bool wants_surface = choice_.depth || choice_.normals || choice_.mask || choice_.hides_limbs;
  US_CHECK(!wants_surface || has_surface(), path_,
           ": depth, normals, mask and hidden limbs need a target with a surface, this one is points");
  US_CHECK(file_suffix(path_) != ".json" || !(choice_.depth || choice_.normals || choice_.mask), path_,
           ": holds no pictures, so no depth, normals or mask beside them");
}

void PosePictures::film_poses() {
  for (const Pose& pose : poses_at_rate(poses_, fps_, choice_)) {
    const PosedSkeleton posed = forward_kinematics(rest_, pose);
    frames_.push_back({pose, body_places(posed, marks_), posed.global[Head]});
  }
}

/// The points of all frames, and the surface of some.
Points PosePictures::held_points() const {
  const Eigen::Index per_frame = kBodyPoints;
  Points points(per_frame * static_cast<Eigen::Index>(frames_.size()), 3);
  for (size_t t = 0; t < frames_.size(); ++t)
    points.middleRows(static_cast<Eigen::Index>(t) * per_frame, per_frame) = frames_[t].places;
  const size_t step = std::max<size_t>(1, frames_.size() / kHeldSurfaces);
  for (size_t t = 0; t < frames_.size(); t += step) {
    const Points surface = body_.screen->deform(frames_[t].pose);
    const Vec3 low = surface.colwise().minCoeff().transpose(),
               high = surface.colwise().maxCoeff().transpose();
    const Eigen::Index at = points.rows();
    points.conservativeResize(at + surface.rows(), 3);
    points.bottomRows(surface.rows()) = surface;
    if (!low.allFinite() || !high.allFinite()) points.conservativeResize(at, 3);
  }
  return points;
}

Pinhole PosePictures::find_camera() const {
  const Joints first = forward_kinematics(rest_, frames_[0].pose).joints;
  Pinhole whole = film_camera(choice_.camera, held_points(), front_of(first), canvas_);
  if (!reference_) return whole;
  CameraFitOptions options;
  options.focal = whole.focal;
  options.centre = whole.centre;
  options.pitch = choice_.camera.pitch_deg.value_or(0) * kPi / 180;
  options.orthographic = choice_.camera.orthographic;
  try {
    return fit_camera(frames_[0].places, reference_pose(*reference_, canvas_), options).camera;
  } catch (const Error& error) {
    throw Error(choice_.camera.reference + ": " + error.what());
  }
}

void PosePictures::see_people() {
  const BodyViewOptions view{canvas_, choice_.hides_face};
  const std::vector<int> joints =
      choice_.hides_limbs ? joints_of_vertices(body_.screen->weights()) : std::vector<int>();
  depth_ = {SurfaceView::kNothing, 0};
  for (const Filmed& frame : frames_) {
    FlatPose pose = seen_pose(frame.places, frame.head, camera_, view);
    if (choice_.hides_limbs) {
      const SurfaceView surface = seen(body_.screen->deform(frame.pose));
      forget_hidden(pose, frame.places, camera_, {surface, body_.character->target.mesh.faces, joints});
    }
    seen_.push_back(std::move(pose));
    for (int point = 0; point < kBodyPoints; ++point) {
      const float depth = camera_.project(Vec3(frame.places.row(point).transpose())).z();
      depth_.near = std::min(depth_.near, depth - kBodyDepth);
      depth_.far = std::max(depth_.far, depth + kBodyDepth);
    }
    progress(0.3 * static_cast<double>(seen_.size()) / static_cast<double>(frames_.size()));
  }
  if (!camera_.orthographic) depth_.near = std::max(depth_.near, 0.0f);
}

void PosePictures::check_anybody() const {
  const bool is_anybody =
      std::any_of(seen_.begin(), seen_.end(), [](const FlatPose& pose) { return points_seen(pose) > 1; });
  US_CHECK(is_anybody, path_, ": nobody is in the camera's view in any of ", grouped(seen_.size()),
           " pictures; without distance and target it is placed so that the whole take is seen");
}

void PosePictures::write_surfaces(const Filmed& frame,
                                  std::array<std::unique_ptr<PictureFilm>, 3>& films) const {
  const Faces& faces = body_.character->target.mesh.faces;
  const Points vertices = body_.screen->deform(frame.pose);
  const SurfaceView surface = seen(vertices);
  if (films[0]) films[0]->push(render::depth_picture(surface, depth_));
  if (films[1])
    films[1]->push(render::normal_picture(surface, camera_, faces, vertex_normals(vertices, faces)));
  if (films[2]) films[2]->push(render::mask_picture(surface));
}

void PosePictures::write_pictures() {
  if (file_suffix(path_) == ".json") return;
  PictureFilm poses(path_, canvas_, rate());
  std::array<std::unique_ptr<PictureFilm>, 3> films;  // depth, normals, mask
  const std::array<std::pair<bool, const char*>, 3> wanted = {
      {{choice_.depth, "_depth"}, {choice_.normals, "_normals"}, {choice_.mask, "_mask"}}};
  bool any = false;
  for (size_t k = 0; k < films.size(); ++k) {
    if (!wanted[k].first) continue;
    films[k] = std::make_unique<PictureFilm>(beside(path_, wanted[k].second), canvas_, rate());
    any = true;
  }
  for (size_t t = 0; t < frames_.size(); ++t) {
    poses.push(render::pose_picture({seen_[t]}, canvas_, choice_.drawing));
    if (any) write_surfaces(frames_[t], films);
    progress(0.3 + 0.7 * static_cast<double>(t) / static_cast<double>(frames_.size()));
  }
  poses.finish();
  for (const auto& film : films)
    if (film) film->finish();
}

void PosePictures::write_pose_file() const {
  KeypointReading reading;
  reading.path = name_;
  reading.canvas = canvas_;
  reading.fps = rate();
  reading.fps_is_guessed = false;
  KeypointTrack track;
  track.person = 1;
  for (size_t t = 0; t < seen_.size(); ++t) {
    const auto number = static_cast<int64_t>(t);
    reading.frames.push_back({number, ""});
    if (!is_nobody(seen_[t])) track.poses.push_back({number, 1, seen_[t]});
  }
  reading.tracks.push_back(std::move(track));
  write_poses_beside(path_, reading, choice_.file);
}

ExportCost PosePictures::finish() {
  US_CHECK(!poses_.empty(), path_, ": there is no motion to export");
  film_poses();
  camera_ = find_camera();
  see_people();
  check_anybody();
  write_pictures();
  write_pose_file();
  progress(1);
  ExportCost cost;
  cost.frames = static_cast<int64_t>(frames_.size());
  cost.bytes = bytes_at(path_);
  return cost;
}

}  // namespace

void write_pose_pictures(const std::string& path, const KeypointReading& reading, const PoseChoice& choice) {
  if (file_suffix(path) != ".json") {
    PictureFilm film(path, reading.canvas, reading.fps);
    for (int64_t frame = 0; frame < static_cast<int64_t>(reading.frames.size()); ++frame)
      film.push(picture_of(reading, frame, choice));
    film.finish();
  }
  write_poses_beside(path, reading, choice.file);
}

class ComingPictures::Files {
 public:
  Files(const std::string& folder, const KeypointReading& first, PoseFile file)
      : film_(folder, first.canvas, first.fps, PartFolder::Frames::AsTheyCome) {
    if (file == PoseFile::OpenPose)
      poses_.emplace(pose_file_of(folder, file), PartFolder::Frames::AsTheyCome);
  }
  void push(const KeypointReading& one, const PoseChoice& choice) {
    film_.push(picture_of(one, 0, choice));
    if (poses_) poses_->add(openpose_file_name(poses_->path(), one.frames[0].number), openpose_json(one, 0));
  }
  void finish() {
    film_.finish();
    if (poses_) poses_->finish();
  }

 private:
  PictureFilm film_;
  std::optional<PartFolder> poses_;
};

ComingPictures::ComingPictures(std::string folder, const PoseChoice& choice)
    : folder_(std::move(folder)), choice_(choice) {}
ComingPictures::~ComingPictures() = default;

void ComingPictures::push(const KeypointReading& one) {
  waiting_.push_back(one);
  if (one.canvas.is_known()) write(one.canvas);
}

void ComingPictures::write(const Canvas& canvas) {
  for (KeypointReading& one : waiting_) {
    one.canvas = canvas;
    if (!files_) files_ = std::make_unique<Files>(folder_, one, choice_.file);
    files_->push(one, choice_);
  }
  waiting_.clear();
}

void ComingPictures::finish(const KeypointReading& all) {
  write(all.canvas);
  US_CHECK(files_, folder_, ": there are no frames to write");
  files_->finish();
  if (choice_.file == PoseFile::ControlNet) write_poses_beside(folder_, all, choice_.file);
}

bool is_picture_folder(const std::string& path) {
  const std::string suffix = file_suffix(path);
  return suffix != ".mp4" && suffix != ".json";
}

BodyMarks marks_of(const ExportBody& body) {
  const Joints rest = body.file.joints.value_or(body.character->target.joints);
  const Points& vertices = body.character->target.mesh.vertices;
  const RowMatrix& weights = body.screen->weights();
  BodyMarks marks{usual_face_marks(rest), foot_marks(rest)};
  if (weights.rows() == vertices.rows() && weights.cols() == kJointCount)
    marks.face = face_marks(rest, vertices, Eigen::VectorXf(weights.col(Head)));
  marks.face = moved_marks(marks.face, rest, body.face);
  return marks;
}

std::unique_ptr<MotionOutput> open_pose_pictures(const std::string& path, const ExportBody& body,
                                                 const std::string& name, double fps) {
  return std::make_unique<PosePictures>(path, body, name, fps);
}

}  // namespace understudy::app
