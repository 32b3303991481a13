#include "app/stimuli/stage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/run/retargeted_source.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/geometry/ambient_occlusion.hpp"
#include "retarget/motion/read_motion.hpp"

namespace understudy::app {
namespace {

const Vec3 kScanColor = render::PointsView().color;

/// The work's result; an error of it begins with whose it is.
template <class Work>
auto naming(const std::string& who, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(who + ": " + error.what());
  }
}

/// Shares the faces of the frame before where they are the same.
void share_faces(SurfaceFrame& frame, const MovingSurface& surface) {
  if (surface.frames.empty() || frame.faces->rows() == 0) return;
  const render::SharedFaces& before = surface.frames.back().faces;
  if (before->rows() == frame.faces->rows() && *before == *frame.faces) frame.faces = before;
}

/// Frames that somebody else made: points without faces are the target's vertices, where as many.
Mesh with_faces_of(const PreparedCharacter& character, Mesh mesh) {
  const MergedSurface& surface = character.surface;
  const Mesh& target = character.target.mesh;
  if (!mesh.is_cloud() || target.is_cloud()) return mesh;
  if (mesh.vertices.rows() == ssize(surface.in_file)) {
    Points merged(target.vertices.rows(), 3);
    for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v)
      merged.row(surface.in_file[static_cast<size_t>(v)]) = mesh.vertices.row(v);
    mesh.vertices = std::move(merged);
  }
  if (mesh.vertices.rows() != target.vertices.rows()) return mesh;
  return {std::move(mesh.vertices), target.faces, target.colors};
}

SeenExtent no_extent(const StudyPicture& picture) {
  return SeenExtent(picture.yaw_deg * kPi / 180, picture.pitch_deg * kPi / 180);
}

SeenExtent extent_of(const MovingSurface& surface, const StudyPicture& picture) {
  SeenExtent extent = no_extent(picture);
  for (const SurfaceFrame& frame : surface.frames) extent.add(seen_points(frame));
  return extent;
}

/// Of a scan what is somebody's: a stray or a piece of floor must neither make everybody small nor be cut off
/// at an edge.
Mesh body_part(const Mesh& scan, const Observation& seen) {
  constexpr float kReach = 0.5f;  // metres from a joint to fingertips, toes, hair and hems
  if (!seen.problem.empty() || !seen.joints.allFinite()) return scan;
  Eigen::ArrayXf nearest = Eigen::ArrayXf::Constant(scan.vertices.rows(), 1e9f);
  for (int j = 0; j < kJointCount; ++j)
    nearest = nearest.min((scan.vertices.rowwise() - seen.joints.row(j)).rowwise().squaredNorm().array());
  std::vector<char> kept(static_cast<size_t>(scan.vertices.rows()));
  for (Eigen::Index v = 0; v < scan.vertices.rows(); ++v)
    kept[static_cast<size_t>(v)] = nearest[v] <= kReach * kReach ? 1 : 0;
  return kept_part(scan, kept);
}

bool is_bones_alone(const SourceOptions& options) {
  if (options.blend) return true;
  if (!options.motion.empty() || options.as_scan) return false;
  const std::optional<Character> moving = read_motion(options.path);
  return moving && moving->vertex_count() == 0;
}

}  // namespace

/// A motion's source as one extractor sees it, from its first frame on.
struct StageMaker::Watched {
  MovingSurface source;           // from `first` on
  std::vector<Observation> seen;  // of all frames
  size_t first = 0;               // that is shown
  SeenExtent extent;              // of who is in it
};

StageMaker::StageMaker(Study study, StimulusServices services)
    : study_(std::move(study)), services_(std::move(services)), blender_(services_.motion_coder) {}
StageMaker::~StageMaker() = default;

void StageMaker::tell(const std::string& what, int64_t done, int64_t total) const {
  if (services_.progress) services_.progress(what, done, total);
}

const Method& StageMaker::first_method() const {
  static const Method usual;
  for (const Condition& condition : study_.conditions)
    if (condition.kind == ConditionKind::Method) return condition.method;
  return usual;
}

Networks StageMaker::networks_of(const Method& method) {
  const auto [at, is_new] = networks_.try_emplace(networks_key(method));
  NetworkParts parts = NetworkParts::all();
  parts.style = false;
  if (is_new) at->second = services_.networks(method, parts);
  return at->second;
}

const StageMaker::Watched& StageMaker::watch(int motion, const Method& method) {
  if (std::exchange(motion_, motion) != motion) watched_.clear();
  std::unique_ptr<Watched>& kept = watched_[extraction_key(method)];
  if (kept == nullptr) {
    const StudyMotion& one = study_.motions[static_cast<size_t>(motion)];
    kept =
        naming("motion '" + one.name + "'", [&] { return std::make_unique<Watched>(watched(one, method)); });
  }
  return *kept;
}

StageMaker::Watched StageMaker::watched(const StudyMotion& motion, const Method& method) {
  SourceOptions options = motion.source;
  options.edits = motion.edits;
  options.quiet = watched_.size() > 1;  // another extractor
  const auto source = open_source(options, &blender_);
  const bool bones_alone = is_bones_alone(options);
  Networks seeing;
  seeing.extractor = networks_of(method).extractor;
  Retargeter observer(seeing, retarget_options(method));
  RetargetedSource frames(*source, observer, options);
  const double fps = source->fps(), longest = study_.clip.seconds * static_cast<double>(study_.clip.speed);
  const double shown_s = std::min(longest, static_cast<double>(motion.seconds.value_or(1e9f)));
  Watched out;
  out.source.fps = fps, out.source.color = kScanColor;
  out.first = static_cast<size_t>(std::lround(motion.from_s * fps));
  const size_t end = out.first + static_cast<size_t>(std::max(1L, std::lround(shown_s * fps)));
  out.extent = no_extent(study_.picture);
  SurfaceFrame last;
  while (out.seen.size() < end) {
    const auto frame = frames.next();
    if (!frame) break;
    out.seen.push_back(frame->result.observed);
    tell("motion '" + motion.name + "'", ssize(out.seen), static_cast<int64_t>(end));
    if (out.seen.size() <= out.first) continue;
    if (frame->scan.usable) last = surface_frame(body_part(frame->scan.mesh, out.seen.back()));
    if (bones_alone && frame->scan.skeleton) last.skeleton = frame->scan.skeleton->joints;
    share_faces(last, out.source);
    out.source.frames.push_back(last);
    out.extent.add(seen_points(last));
  }
  US_CHECK(!out.source.frames.empty(), "it starts at ", motion.from_s, " s, its source lasts ",
           printed("%.2f", static_cast<double>(out.seen.size()) / fps), " s");
  for (const Condition& condition : study_.conditions)
    if (condition.kind == ConditionKind::Method) {
      frames.check_used();
      break;
    }
  return out;
}

/// A target that stands ready to perform.
struct StageMaker::Body {
  std::shared_ptr<const PreparedCharacter> character;
  MovingSurface surface;  // in T-pose, one frame

  /// Vertices of the target in a frame.
  SurfaceFrame posed(Points vertices) const {
    if (character->target.mesh.is_cloud())
      return surface_frame({std::move(vertices), {}, character->target.mesh.colors});
    SurfaceFrame frame = surface.frames[0];
    frame.vertices = std::move(vertices);
    return frame;
  }
};

StageMaker::Body StageMaker::open_body(const StudyTarget& target, const Method& method) {
  Body body;
  body.character = open_target(target.target, networks_of(method));
  const Mesh& mesh = body.character->target.mesh;
  body.surface.frames = {surface_frame(mesh)};
  if (mesh.is_cloud()) return body;
  body.surface.closed = is_closed(mesh.faces);
  body.surface.ambient =
      ambient_occlusion(mesh.vertices, mesh.faces, vertex_normals(mesh.vertices, mesh.faces));
  return body;
}

MovingSurface StageMaker::performed(const Body& body, const Method& method, const Stage& stage) {
  const StudyTarget& target = study_.targets[static_cast<size_t>(stage.target)];
  const Watched& watched = watch(stage.motion, method);
  Networks networks =
      networks_for(networks_of(method), *body.character, on_their_rig(target.target, *body.character));
  NetworkParts style;  // others of the same networks have another
  style.style = true;
  if (method.style.any()) networks.style = services_.networks(method, style).style;
  Retargeter retargeter(std::move(networks), retarget_options(method));
  retargeter.set_target(body.character->target);
  retargeter.restart();
  MovingSurface surface = body.surface;
  surface.fps = watched.source.fps;
  surface.frames.clear();
  size_t performed = 0;
  const auto take_in = [&] {
    while (auto frame = retargeter.next()) {
      if (performed++ >= watched.first) surface.frames.push_back(body.posed(std::move(frame->vertices)));
      tell("target '" + target.name + "'", static_cast<int64_t>(performed), ssize(watched.seen));
    }
  };
  for (const Observation& seen : watched.seen) {
    retargeter.send(seen, static_cast<float>(1 / surface.fps));
    take_in();
  }
  retargeter.finish();
  take_in();
  return surface;
}

/// The animation begins where the motion does.
MovingSurface StageMaker::read(const Body& body, const std::string& path, const Stage& stage) {
  SourceOptions options;
  options.path = path;
  options.quiet = true;
  if (file_suffix(path) == ".npz" && !is_motion_file(path)) {  // as the program writes results and truths
    options.import.units = "m", options.import.up = "y";
    options.import.floor = 0;
  }
  const auto source = open_source(options);
  MovingSurface surface = body.surface;
  surface.frames.clear();
  surface.fps =
      source->clips().empty() ? stage.source.fps : source->fps();  // scans have no rate of their own
  const auto most = static_cast<size_t>(std::ceil(stage.motion_s * surface.fps)) + 1;
  const bool bones_alone = is_bones_alone(options);
  const Faces& faces = body.character->target.mesh.faces;
  SurfaceFrame last;
  while (surface.frames.size() < most) {
    const auto frame = source->next();
    if (!frame) break;
    if (frame->usable) last = surface_frame(with_faces_of(*body.character, frame->mesh));
    if (bones_alone && frame->skeleton) last.skeleton = frame->skeleton->joints;
    share_faces(last, surface);
    if (surface.frames.empty() && (last.faces->rows() != faces.rows() || *last.faces != faces))
      surface.ambient = {}, surface.closed = false;
    surface.frames.push_back(last);
    tell(file_name(path), ssize(surface.frames), static_cast<int64_t>(most));
  }
  US_CHECK(!surface.frames.empty(), path, ": has no frame");
  return surface;
}

std::shared_ptr<const Stage> StageMaker::stage(int motion, int target) {
  const StudyMotion& of = study_.motions[static_cast<size_t>(motion)];
  const StudyTarget& on = study_.targets[static_cast<size_t>(target)];
  const std::string where = "', motion '" + of.name + "', target '" + on.name + "'";
  Stage stage;
  stage.motion = motion, stage.target = target;
  const Watched& seen = watch(motion, first_method());
  stage.source = seen.source;
  stage.extents.source = seen.extent;
  stage.extents.result = no_extent(study_.picture);
  stage.motion_s = static_cast<double>(stage.source.frames.size()) / stage.source.fps;
  std::map<std::string, Body> bodies;  // by extraction_key(): the extractor may have found their joints
  const auto body_for = [&](const Method& method) -> const Body& {
    const auto [at, is_new] = bodies.try_emplace(extraction_key(method));
    if (is_new) at->second = naming("target '" + on.name + "'", [&] { return open_body(on, method); });
    return at->second;
  };
  const Body& body = body_for(first_method());
  stage.standing = body.surface;
  stage.extents.target = extent_of(stage.standing, study_.picture);
  for (const Condition& condition : study_.conditions) {
    stage.results.push_back(naming("condition '" + condition.name + where, [&] {
      if (condition.kind == ConditionKind::Method)
        return performed(body_for(condition.method), condition.method, stage);
      return read(body, file_for(condition, of, on)->path, stage);
    }));
    stage.extents.result.add(extent_of(stage.results.back(), study_.picture));
  }
  return std::make_shared<const Stage>(std::move(stage));
}

}  // namespace understudy::app
