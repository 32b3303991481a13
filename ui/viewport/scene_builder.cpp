#include "ui/viewport/scene_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tuple>

#include "app/session/follow.hpp"
#include "render/colors.hpp"
#include "retarget/base/index.hpp"

namespace understudy::ui {
namespace {

using app::Colouring;
using app::Session;
using render::SharedPoints;

constexpr float kGhostOpacity = 0.16f, kTimedGhostOpacity = 0.4f, kTrailSeconds = 1.2f;
constexpr std::array<int, 5> kFutureJoints = {Pelvis, LeftWrist, RightWrist, LeftFoot, RightFoot};
constexpr float kUnseen = 0.004f;  // an opacity that leaves nothing
constexpr float kDisc = 1.15f;     // a scan's discs against its spacing: few holes, edges still sharp
const Vec3 kScanColor(0.60f, 0.66f, 0.72f);

/// A member of something shared, shared with the whole.
template <class Whole, class Part>
std::shared_ptr<const Part> part_of(const std::shared_ptr<const Whole>& whole, const Part& part) {
  return {whole, &part};
}

template <class Array>
void append(std::vector<float>& values, const Array& array) {
  values.insert(values.end(), array.data(), array.data() + array.size());
}

/// Colours of the values along the legend's scale; none where there is no scale.
SharedPoints scale_colors(const SurfaceValues& surface) {
  if (surface.values == nullptr) return {};
  const float high = surface.legend.high;
  if (surface.legend.scale == Legend::Scale::Error)
    return render::colors_along(render::error_color, *surface.values, 0, high);
  if (surface.legend.scale == Legend::Scale::Uncertainty)
    return render::colors_along(render::diverging_color, *surface.values, -high, high);
  return render::colors_along(render::viridis, *surface.values, 0, high);
}

Vec3 trail_color(int joint, ThemeKind theme) {
  const size_t j = joint;
  const Vec3 side = kMirror[j] == joint        ? Vec3(0.52f, 0.56f, 0.62f)
                    : kJointNames[j][0] == 'l' ? render::kLeftColor
                                               : render::kRightColor;
  return theme == ThemeKind::Dark ? Vec3(0.65f * side + Vec3::Constant(0.35f)) : side;
}

/// The plain surface of a take.
Vec3 take_color(int k) {
  static const std::array<Vec3, 4> kTints = {Vec3(0.77f, 0.74f, 0.71f), Vec3(0.66f, 0.75f, 0.69f),
                                             Vec3(0.72f, 0.68f, 0.78f), Vec3(0.79f, 0.69f, 0.64f)};
  return kTints[std::max(0, k) % kTints.size()];
}

/// What has `kept` not 0, with the faces whose corners stay.
app::ScanPicture kept_picture(const app::ScanPicture& whole, const std::vector<char>& kept) {
  std::vector<int> which, renumbered(kept.size(), -1), faces;
  for (size_t v = 0; v < kept.size(); ++v)
    if (kept[v]) renumbered[v] = static_cast<int>(which.size()), which.push_back(static_cast<int>(v));
  const Mesh& mesh = whole.mesh;
  for (int f = 0; f < mesh.faces.rows(); ++f)
    if (std::all_of(mesh.faces.row(f).begin(), mesh.faces.row(f).end(), [&](int v) { return kept[v]; }))
      faces.push_back(f);
  app::ScanPicture part;
  part.spacing = whole.spacing;
  part.mesh.vertices = mesh.vertices(which, Eigen::all);
  part.mesh.faces = mesh.faces(faces, Eigen::all).unaryExpr([&](int v) { return renumbered[v]; });
  if (mesh.colors.rows() == mesh.vertices.rows()) part.mesh.colors = mesh.colors(which, Eigen::all);
  if (whole.normals.rows() == mesh.vertices.rows()) part.normals = whole.normals(which, Eigen::all);
  return part;
}

struct FrameSpan {
  int first = 0, last = 0;
};

class Builder {
 public:
  Builder(const SceneInput& input, SceneMemory& memory)
      : in_(input),
        session_(input.session),
        unposed_(shows_rest(session_, in_.pane) || shows_as_loaded(session_, in_.pane)),
        memory_(memory) {}

  PaneScene build();

 private:
  void add_unposed();
  void add_scan();
  void add_take(size_t i);
  void add_target_surface(size_t i, const std::shared_ptr<const app::PosedPicture>& posed, float opacity,
                          int ghost = -1);
  void add_surface(render::MeshView view, bool as_points, float radius);
  void add_skeleton(const Joints& joints, const app::Layers& layers, int person);
  void add_trails();
  void add_trail(int person, int joint);
  void add_ghosts();
  void add_made_ways();
  /// The ways of hands, feet and pelvis in frames first .. last of a take, as one of the motion space's
  /// answers has it: full where it is the chosen one.
  void add_ways(int take, const std::vector<Joints>& joints, FrameSpan span, bool chosen);
  void add_fan(int take, FrameSpan span, int chosen);
  float ghost_opacity() const { return session_.view.ghosts_by_time ? kTimedGhostOpacity : kGhostOpacity; }
  Vec3 ghost_color(int frame, const Vec3& plain) const;
  /// What was made and not captured, as in the timeline.
  Vec3 made_color() const {
    const ImVec4& violet = theme(in_.theme).series[4];
    return {violet.x, violet.y, violet.z};
  }
  void add_crop_box();
  void add_cropped_away();
  void set_ground();
  void set_background();
  Vec3 aside_of(int person) const { return aside(session_, in_.pane, person); }
  /// The points where the person stands.
  SharedPoints displaced(SharedPoints points, int person, MovedLayer layer, int number = 0);
  /// The colour behind everything, for what is drawn faintly.
  Vec3 air() const { return (out_.scene.background.top + out_.scene.background.bottom) / 2; }
  const SurfaceColours& take_colors(int k, const std::shared_ptr<const app::PosedPicture>& posed);
  const ShownScan& shown(ShownScan& made, const std::shared_ptr<const app::ScanPicture>& whole, int frame,
                         ShownScan::Part part) const;
  const ShownScan& shown_scan();
  const SurfaceColours& scan_colors();
  Points people_colors(const ShownScan& scan, const SharedPoints& plain) const;
  void explain(const SurfaceColours& made, int take);
  void explain_painted_bone();

  const SceneInput& in_;
  const Session& session_;
  const bool unposed_;  ///< in T-pose or as loaded instead of in a frame
  const bool overlaid_ = in_.pane.takes.size() + (in_.pane.source ? 1 : 0) > 1;
  SceneMemory& memory_;
  PaneScene out_;
};

PaneScene Builder::build() {
  set_background();
  out_.scene.light = light_of(session_.view.light);
  out_.values_take = in_.pane.takes.empty() ? -1 : in_.pane.takes[0];
  if (unposed_) {
    add_unposed();
  } else {
    if (in_.pane.source) add_scan();
    for (size_t i = 0; i < in_.pane.takes.size(); ++i) add_take(i);
    add_ghosts();
    add_trails();
    add_made_ways();
    add_crop_box();
  }
  if (in_.preview.gizmo) {
    out_.scene.gizmos.push_back(*in_.preview.gizmo);
    out_.scene.gizmos.back().position += aside_of(person_of_tool(session_, in_.pane));
  }
  set_ground();
  if (!in_.pane.source || in_.pictures.scan == nullptr) memory_.scan = {};
  memory_.ghosts.drop_unused();
  memory_.colours.drop_unused();
  memory_.moved.drop_unused();
  memory_.made.drop_unused();
  return std::move(out_);
}

void Builder::add_unposed() {
  const auto& takes = in_.pictures.takes;
  if (!takes.empty() && takes[0] != nullptr) add_target_surface(0, takes[0], 1);
  if (!shows_rest(session_, in_.pane) || session_.tool == app::Tool::Face) return;  // it is within the face
  const Joints joints = rest_joints(session_, in_.pane.takes[0]);
  out_.scene.skeletons.push_back(render::skeleton_view(in_.preview.take_joints.value_or(joints)));
}

SharedPoints Builder::displaced(SharedPoints points, int person, MovedLayer layer, int number) {
  const Vec3 offset = aside_of(person);
  if (offset.isZero()) return points;
  MovedPoints& kept = memory_.moved[{layer, number}];
  if (!(kept.in_place.pointer() == points.pointer() && kept.aside == offset)) {
    kept.in_place = points, kept.aside = offset;
    kept.moved = Points(points->rowwise() + offset.transpose());
  }
  return kept.moved;
}

/// As a lit mesh, or as discs of a radius in metres (0: of the usual one).
void Builder::add_surface(render::MeshView view, bool as_points, float radius) {
  if (view.opacity <= kUnseen) return;
  if (!as_points) return out_.scene.meshes.push_back(std::move(view));
  render::PointsView points;
  points.positions = view.vertices, points.normals = view.normals;
  points.colors = view.colors, points.color = view.color, points.opacity = view.opacity;
  if (radius > 0) points.radius = radius;
  out_.scene.clouds.push_back(std::move(points));
}

void Builder::add_scan() {
  const app::Layers& layers = session_.view.source;
  if (layers.surface && in_.pictures.scan != nullptr &&
      !bones_hide_scan(session_, in_.pane, in_.pictures.frame)) {
    const auto& scan = shown_scan().shown;
    const SurfaceColours& made = scan_colors();
    render::MeshView view;
    view.vertices = displaced(part_of(scan, scan->mesh.vertices), 0, MovedLayer::Scan);
    view.faces = part_of(scan, scan->mesh.faces);
    view.normals = part_of(scan, scan->normals);
    view.colors = made.colors->rows() > 0 ? made.colors : SharedPoints(part_of(scan, scan->mesh.colors));
    view.color = kScanColor, view.wireframe = layers.wireframe;
    if (overlaid_) view.opacity = session_.view.overlay.scan;
    add_surface(std::move(view), scan->mesh.is_cloud() || layers.as_points, kDisc * scan->spacing);
    explain(made, -1);
  }
  add_cropped_away();
  const Joints* joints = app::pane_joints(session_, 0, in_.pictures.frame);
  if (in_.preview.source_joints) joints = &*in_.preview.source_joints;
  if (joints != nullptr && !hides_person(session_)) add_skeleton(*joints, layers, 0);
  add_bones({session_, in_.pane, in_.pictures, in_.preview.found, aside_of(0)}, memory_.bones, out_.scene);
  explain_painted_bone();
  add_second_body(session_, in_.pictures.frame, aside_of(0), memory_.second, out_.scene);
  for (const app::ShownMotion& one : app::shown_motions(session_, in_.pictures.frame))
    add_made_motion(*session_.bones.rig, one, aside_of(0), memory_.made[one.made.get()], out_.scene);
}

void Builder::add_take(size_t i) {
  const app::Layers& layers = session_.view.take;
  const int k = in_.pane.takes[i];
  if (layers.surface && i < in_.pictures.takes.size() && in_.pictures.takes[i] != nullptr)
    add_target_surface(i, in_.pictures.takes[i], overlaid_ ? session_.view.overlay.results : 1);
  const Joints* joints = app::pane_joints(session_, k + 1, in_.pictures.frame);
  if (i == 0 && in_.preview.take_joints) joints = &*in_.preview.take_joints;
  const auto& performance = session_.map.performance;
  const int performing = performance ? performance->frame_at(session_.time, k) : -1;
  if (performing >= 0) joints = &performance->takes[k][performing].joints;
  if (joints != nullptr) add_skeleton(*joints, layers, k + 1);
}

void Builder::add_target_surface(size_t i, const std::shared_ptr<const app::PosedPicture>& posed,
                                 float opacity, int ghost) {
  const int k = in_.pane.takes[i];
  const app::TakeState* take = at_or_null(session_.takes, k);
  const auto target = take != nullptr ? shown_target(*take) : nullptr;
  if (target == nullptr || posed->vertices.rows() == 0 ||
      posed->vertices.rows() != target->mesh.vertices.rows())
    return;
  const Mesh& mesh = target->mesh;
  render::MeshView view;
  view.vertices = displaced(part_of(posed, posed->vertices), k + 1,
                            ghost < 0 ? MovedLayer::Take : MovedLayer::TakeGhost, ghost < 0 ? k : ghost);
  view.faces = part_of(target, mesh.faces), view.normals = part_of(posed, posed->normals);
  view.color = take_color(k), view.opacity = opacity;
  view.wireframe = session_.view.take.wireframe && ghost < 0;
  if (ghost >= 0) {
    const int frame = in_.pictures.ghosts[static_cast<size_t>(ghost)].frame;
    const float* const doubt_m = at_or_null(take->shown.doubt_m, frame);
    const bool made = doubt_m != nullptr && *doubt_m > 0;
    view.color = ghost_color(frame, made ? made_color() : view.color);
    view.wireframe = made && session_.view.ghosts_by_time;  // its colour tells the time
  }
  if (ghost < 0) {
    const SurfaceColours& made = take_colors(k, posed);
    view.colors = made.colors;
    if (made.colors->rows() == 0 && take_colouring(session_) == Colouring::Plain && mesh.colors.rows() > 0)
      view.colors = part_of(target, mesh.colors);
    if (i == 0 || out_.legend.title.empty()) explain(made, k);
  }
  const auto& look = i < in_.looks.size() ? in_.looks[i] : nullptr;
  if (look != nullptr) view.ambient = look->ambient, view.two_sided = !look->closed;
  add_surface(std::move(view), mesh.is_cloud(), look != nullptr ? look->spacing : 0);
}

/// Several people in one space each get their own shade of the two sides' colours.
void Builder::add_skeleton(const Joints& joints, const app::Layers& layers, int person) {
  if (!layers.skeleton) return;
  render::SkeletonView view = render::skeleton_view(joints);
  view.joints.rowwise() += aside_of(person).transpose();
  if (overlaid_) {
    view.opacity = session_.view.overlay.skeletons;
    if (view.opacity <= kUnseen) return;
    static const std::array<std::pair<Vec3, float>, 4> kShades = {{{Vec3(1, 1, 1), 0.55f},
                                                                   {Vec3(1, 1, 1), 0},
                                                                   {Vec3(0, 0, 0), 0.45f},
                                                                   {Vec3(0.55f, 0.2f, 0.6f), 0.5f}}};
    std::tie(view.tint, view.tint_share) = kShades[person == 0 ? 0 : 1 + (person - 1) % 3];
  }
  view.x_ray = layers.x_ray;
  out_.scene.skeletons.push_back(std::move(view));
}

/// By the place among all ghosts, where time is what colours tell.
Vec3 Builder::ghost_color(int frame, const Vec3& plain) const {
  if (!session_.view.ghosts_by_time) return plain;
  int first = in_.pictures.frame, last = first;
  for (const PanePictures::Ghost& ghost : in_.pictures.ghosts)
    first = std::min(first, ghost.frame), last = std::max(last, ghost.frame);
  return render::time_color(static_cast<float>(frame - first) /
                            static_cast<float>(std::max(1, last - first)));
}

/// Poses before and after, fainter than the one shown.
void Builder::add_ghosts() {
  for (size_t i = 0; i < in_.pictures.ghosts.size(); ++i) {
    const PanePictures::Ghost& ghost = in_.pictures.ghosts[i];
    const int number = static_cast<int>(i);
    if (ghost.take != nullptr && !in_.pane.takes.empty() && session_.view.take.ghosts)
      add_target_surface(0, ghost.take, ghost_opacity(), number);
    if (ghost.scan != nullptr && in_.pane.source && session_.view.source.ghosts) {
      const auto& scan =
          shown(memory_.ghosts[number], ghost.scan, ghost.frame, ShownScan::Part::Person).shown;
      const float spacing = scan->spacing > 0 ? scan->spacing : render::PointsView().radius;
      render::MeshView view;
      view.vertices = displaced(part_of(scan, scan->mesh.vertices), 0, MovedLayer::ScanGhost, number);
      view.normals = part_of(scan, scan->normals);
      view.color = 0.75f * air() + 0.25f * kScanColor;
      view.color = ghost_color(ghost.frame, view.color);
      add_surface(std::move(view), true, 0.6f * spacing);
    }
  }
}

/// Paths of the chosen joints up to now and from now on.
void Builder::add_trails() {
  for (const int joint : session_.view.trail_joints) {
    if (joint < 0 || joint >= kJointCount) continue;
    if (in_.pane.source && session_.view.source.trails) add_trail(0, joint);
    for (const int k : in_.pane.takes)
      if (session_.view.take.trails) add_trail(k + 1, joint);
  }
}

void Builder::add_trail(int person, int joint) {
  const int now = in_.pictures.frame,
            reach = static_cast<int>(std::lround(kTrailSeconds * session_.source.fps));
  const Vec3 color = trail_color(joint, in_.theme), offset = aside_of(person);
  // The past runs up to now, the future back to it: both fade outwards.
  for (const int step : {1, -1}) {
    std::vector<Vec3> path;
    for (int f = now - step * reach; f != now + step; f += step)
      if (const Joints* joints = app::pane_joints(session_, person, f))
        path.push_back(joints->row(joint).transpose() + offset);
    if (path.size() < 2) continue;
    const Points points = Eigen::Map<const Points>(path.front().data(), path.size(), 3);
    render::LinesView line = render::trail(points, color, step == 1 ? 3.f : 1.5f);
    line.x_ray = true;
    out_.scene.lines.push_back(std::move(line));
  }
}

void Builder::add_ways(int take, const std::vector<Joints>& joints, FrameSpan span, bool chosen) {
  const Vec3 color = chosen ? made_color() : Vec3(0.5f * (made_color() + air()));
  for (const int joint : kFutureJoints) {
    std::vector<Vec3> path;  // backwards: it fades the way that it goes
    for (int f = std::min(span.last, static_cast<int>(ssize(joints)) - 1); f >= std::max(span.first, 0); --f)
      path.push_back(joints[static_cast<size_t>(f)].row(joint).transpose() + aside_of(take + 1));
    if (path.size() < 2) continue;
    render::LinesView line = render::trail(Eigen::Map<const Points>(path.front().data(), ssize(path), 3),
                                           color, chosen ? 2.5f : 1.2f);
    line.x_ray = true;
    out_.scene.lines.push_back(std::move(line));
  }
}

void Builder::add_fan(int take, FrameSpan span, int chosen) {
  const app::TakeState& state = session_.takes[static_cast<size_t>(take)];
  for (int i = 0; i < ssize(state.alternatives); ++i)
    if (i != chosen) add_ways(take, state.alternatives[static_cast<size_t>(i)], span, false);
  add_ways(take, state.joints, span, true);
}

/// Where a take goes on beyond its last captured frame, from a little before it on, and in frames that are
/// filled, while one of them is shown: a fan of what it could be.
void Builder::add_made_ways() {
  const int reach = static_cast<int>(std::lround(kTrailSeconds * session_.source.fps));
  const int now = in_.pictures.frame;
  for (const int k : in_.pane.takes) {
    const app::TakeState* const state = at_or_null(session_.takes, k);
    const app::Take* const take = at_or_null(session_.document.takes, k);
    if (state == nullptr || take == nullptr || state->performed.empty()) continue;
    const int last = static_cast<int>(state->performed.size()) - 1,
              end = static_cast<int>(state->joints.size());
    const auto& go_on = take->pose_edits.go_on;
    if (end > last + 1 && now >= last - reach) add_fan(k, {last, end - 1}, go_on ? go_on->variation : 0);
    for (const FillEdit& fill : take->pose_edits.fill)
      if (fill.first <= now && now <= fill.last && !state->alternatives.empty())
        add_fan(k, {fill.first - 1, fill.last + 1}, fill.variation);
  }
}

/// Faint, while the box is being set.
void Builder::add_cropped_away() {
  const auto& scan = in_.pictures.scan;
  if (session_.tool != app::Tool::Crop || scan == nullptr || scan->cropped_away.rows() == 0) return;
  render::MeshView view;
  view.vertices = displaced(part_of(scan, scan->cropped_away), 0, MovedLayer::CroppedAway);
  view.color = 0.72f * air() + 0.28f * kScanColor;
  add_surface(std::move(view), true, 0.6f * scan->spacing);
}

void Builder::add_crop_box() {
  if (session_.tool != app::Tool::Crop || !in_.pane.source) return;
  const Box box = in_.preview.crop.value_or(app::shown_crop(session_));
  const Vec3 color = Vec3::Constant(air().mean() < 0.5f ? 0.96f : 0.12f), offset = aside_of(0);
  render::LinesView lines = render::box(box.low + offset, box.high + offset, color, 2);
  lines.x_ray = true, lines.opacity = 0.9f;
  out_.scene.lines.push_back(std::move(lines));
}

void Builder::set_background() {
  const app::View& view = session_.view;
  render::BackgroundView& background = out_.scene.background;
  background = background_of(in_.theme);
  if (view.background == app::Background::Theme) return;
  background.top = background.bottom = view.background == app::Background::White   ? Vec3(1, 1, 1)
                                       : view.background == app::Background::Black ? Vec3(0, 0, 0)
                                                                                   : view.background_color;
}

void Builder::set_ground() {
  render::GroundView& ground = out_.scene.ground;
  ground.visible = (in_.pane.source && session_.view.source.ground) ||
                   (!in_.pane.takes.empty() && session_.view.take.ground);
  if (in_.theme == ThemeKind::Dark) ground.line = Vec3(0.42f, 0.45f, 0.50f), ground.shadow = 0.8f;
  if (!unposed_) return;
  const Points& rest = shown_target(*first_take(session_, in_.pane))->mesh.vertices;
  if (rest.rows() > 0) ground.height = rest.col(1).minCoeff();
}

void Builder::explain(const SurfaceColours& made, int take) {
  if (made.values.legend.title.empty()) return;
  out_.legend = made.values.legend;
  out_.values = made.values.values;
  out_.values_take = take;
}

void Builder::explain_painted_bone() {
  if (memory_.bones.values == nullptr || !paints_found_bones(session_, in_.pane)) return;
  const auto& joints = session_.bones.rig->found.rig.joints;
  out_.legend = {};
  out_.legend.title = "Weight, " + joints[static_cast<size_t>(session_.bones.selected)].name;
  out_.legend.scale = Legend::Scale::Viridis, out_.legend.high = 1;
  out_.values = memory_.bones.values;
  out_.values_take = -1;
}

const SurfaceColours& Builder::take_colors(int k, const std::shared_ptr<const app::PosedPicture>& posed) {
  const app::TakeState& take = session_.takes[k];
  SurfaceColours now;
  const Colouring colouring = take_colouring(session_);
  now.settings = {static_cast<float>(colouring), session_.view.error_scale_mm,
                  static_cast<float>(weights_joint(session_))};
  if (colouring == Colouring::Weights || colouring == Colouring::Uncertainty) {  // the same in every frame
    now.kept = {take.weights, take.binding};
  } else if (colouring != Colouring::Plain) {
    now.kept = {posed, in_.pictures.reference, session_.truth};
    now.settings.push_back(static_cast<float>(in_.pictures.frame));
  }
  const int f = std::max(0, in_.pictures.frame);
  const auto& performed_by = app::performed_by(session_, k);
  if (colouring == Colouring::Confidence && f < ssize(performed_by) && f < ssize(take.joints)) {
    append(now.settings, performed_by[f].confidence_of);
    append(now.settings, take.joints[f]);
  }
  SurfaceColours& made = memory_.colours[k];
  if (made.kept == now.kept && made.settings == now.settings) return made;
  now.values = take_values(session_, k, in_.pictures, posed);
  const bool categories = colouring == Colouring::Weights && !now.values.legend.categories.empty();
  now.colors = categories ? SharedPoints(render::weight_colors(*take.weights)) : scale_colors(now.values);
  return made = std::move(now);
}

/// The part of a frame's scan that is shown; whose each of its points is.
const ShownScan& Builder::shown(ShownScan& made, const std::shared_ptr<const app::ScanPicture>& whole,
                                int frame, ShownScan::Part part) const {
  const app::KeptSource* seen = at_or_null(session_.source.frames, frame);
  const auto kept = seen != nullptr ? seen->owners : nullptr;
  const int alone =
      seen != nullptr && kept == nullptr && app::has_several_people(session_) ? seen->person : 0;
  if (made.whole == whole && made.kept == kept && made.part == part && made.alone == alone) return made;
  made = {whole, whole, kept, part, alone, {}};
  if (alone > 0) made.owner.assign(static_cast<size_t>(whole->mesh.vertices.rows()), alone);
  if (kept == nullptr) return made;
  made.owner = kept->owners(whole->mesh.vertices);
  if (part == ShownScan::Part::Whole || made.owner.empty()) return made;
  const auto stays = [&](int owner) {
    return part == ShownScan::Part::People ? owner > People::kScenery : owner == seen->person;
  };
  std::vector<char> flags(made.owner.size());
  std::transform(made.owner.begin(), made.owner.end(), flags.begin(), stays);
  made.shown = std::make_shared<const app::ScanPicture>(kept_picture(*whole, flags));
  made.owner.erase(std::remove_if(made.owner.begin(), made.owner.end(), std::not_fn(stays)),
                   made.owner.end());
  return made;
}

const ShownScan& Builder::shown_scan() {
  const bool scene = session_.view.source.scene;
  return shown(memory_.scan, in_.pictures.scan, in_.pictures.frame,
               scene ? ShownScan::Part::Whole : ShownScan::Part::People);
}

/// Several people each in their colour, all else grey. plain: the colours of one person's surface, [V, 3] or
/// none.
Points Builder::people_colors(const ShownScan& scan, const SharedPoints& plain) const {
  const Vec3 grey = 0.62f * air() + 0.38f * kScanColor;
  const bool by_number =
      app::has_several_people(session_) && session_.view.source.colouring == Colouring::Plain;
  const bool own = plain->rows() == ssize(scan.owner);
  Points colors(ssize(scan.owner), 3);
  for (Eigen::Index v = 0; v < colors.rows(); ++v) {
    const int owner = scan.owner[static_cast<size_t>(v)];
    Vec3 color = grey;
    if (by_number && owner > People::kScenery) {
      const ImVec4 tint = person_color(theme(in_.theme), owner);
      color = Vec3(tint.x, tint.y, tint.z);
    } else if (!by_number && owner > People::kScenery && owner == session_.source.person) {
      color = own ? Vec3(plain->row(v)) : kScanColor;
    }
    colors.row(v) = color;
  }
  return colors;
}

const SurfaceColours& Builder::scan_colors() {
  SurfaceColours now;
  const int f = std::max(0, in_.pictures.frame);
  const ShownScan& scan = shown_scan();
  now.kept = {scan.shown, scan.kept};
  now.settings = {static_cast<float>(session_.view.source.colouring),
                  app::has_several_people(session_) ? 1.f : 0, static_cast<float>(session_.source.person),
                  static_cast<float>(in_.theme)};
  append(now.settings, air());
  if (f < ssize(session_.source.frames)) {
    append(now.settings, session_.source.frames[f].confidence_of);
    append(now.settings, session_.source.frames[f].joints);
  }
  SurfaceColours& made = memory_.colours[-1];
  if (made.kept == now.kept && made.settings == now.settings) return made;
  now.values = scan_values(session_, scan.shown->mesh.vertices, in_.pictures.frame);
  now.colors = scale_colors(now.values);
  const SharedPoints own = part_of(scan.shown, scan.shown->mesh.colors);
  if (!scan.owner.empty()) now.colors = people_colors(scan, now.values.values != nullptr ? now.colors : own);
  return made = std::move(now);
}

}  // namespace

PaneScene build_scene(const SceneInput& input, SceneMemory& memory) {
  return Builder(input, memory).build();
}

Points face_centres(const Box& box) {
  Points centres = ((box.low + box.high) / 2).transpose().replicate(6, 1);
  for (int face = 0; face < 6; ++face) centres(face, face / 2) = box.side(face);
  return centres;
}

render::LightView light_of(const app::LightLook& look) {
  return render::turned_light(look.turn_deg, look.height_deg, look.brightness);
}

render::BackgroundView background_of(ThemeKind theme) {
  render::BackgroundView view;
  if (theme == ThemeKind::Dark) {
    view.top = Vec3(0.275f, 0.295f, 0.325f);
    view.bottom = Vec3(0.205f, 0.215f, 0.235f);
  }
  return view;
}

}  // namespace understudy::ui
