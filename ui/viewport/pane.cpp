#include "ui/viewport/pane.hpp"

#include <algorithm>

#include "render/gl/program.hpp"
#include "retarget/base/index.hpp"
#include "ui/panels/panel.hpp"

namespace understudy::ui {
namespace {

using app::Session;

constexpr size_t kAsked = 3;        // frames asked for that may still be shown when they come late
constexpr int kAhead = 4;           // frames made before playback comes to them
constexpr float kNearScan = 0.02f;  // metres around the pointer's ray in which a point of a scan is met

bool wants_scan(const Session& session, const PaneContent& pane) {
  return pane.source && (session.view.source.surface || session.tool == app::Tool::Crop);
}

bool wants_take(const Session& session, int k, int frame) {
  const app::TakeState* take = at_or_null(session.takes, k);
  return take != nullptr && take->ready && session.view.take.surface &&
         at_or_null(take->joints, frame) != nullptr;
}

app::FrameCache::Wanted wanted(const Session& session, int k, int frame) {
  return {k, frame, take_colouring(session) == app::Colouring::Offsets};
}

/// In what it performs while a step of the map is pointed at, else in a frame.
std::shared_ptr<const app::PosedPicture> take_picture(const Session& session, app::FrameCache& cache, int k,
                                                      int frame) {
  const app::TakeState& take = session.takes[k];
  const auto& performance = session.map.performance;
  const int now = performance ? performance->frame_at(session.time, k) : -1;
  return now < 0 ? cache.posed(take, wanted(session, k, frame))
                 : cache.performing(take, k, performance->takes[k], now);
}

std::vector<PanePictures::Ghost> ghosts_of(const Session& session, app::FrameCache& cache,
                                           const PaneContent& pane, int frame) {
  const app::View& view = session.view;
  std::vector<PanePictures::Ghost> ghosts;
  for (int side = -1; side <= 1; side += 2)
    for (int i = 1; i <= view.ghost_count; ++i) {
      const int f = frame + side * i * view.ghost_step;
      if (f < 0 || f >= frame_count(session, pane)) continue;
      PanePictures::Ghost ghost;
      ghost.frame = f;
      if (view.source.ghosts && wants_scan(session, pane)) ghost.scan = cache.scan(f);
      if (view.take.ghosts && !session.map.performance && !pane.takes.empty() &&
          wants_take(session, pane.takes[0], f))
        ghost.take = cache.posed(*first_take(session, pane), {pane.takes[0], f, false});
      ghosts.push_back(std::move(ghost));
    }
  return ghosts;
}

std::optional<render::SurfaceHit> point_under(const Points& points, const render::Ray& ray) {
  const auto vertex = render::point_near(points, ray, kNearScan);
  if (!vertex) return std::nullopt;
  render::SurfaceHit hit;
  hit.vertex = *vertex, hit.position = points.row(*vertex);
  return hit;
}

std::optional<render::SurfaceHit> scan_under(const Session& session, const Pane& pane,
                                             const render::Ray& ray) {
  const auto& scan = pane.memory.scan.shown ? pane.memory.scan.shown : pane.keeper.pictures().scan;
  if (scan == nullptr || !session.view.source.surface) return std::nullopt;
  return point_under(scan->mesh.vertices, ray);
}

std::string weight_words(const Session& session, const Pane& pane, int vertex) {
  const auto& weights = first_take(session, pane.content)->weights;
  if (weights == nullptr || vertex >= weights->rows()) return "";
  Eigen::Index joint = 0;
  const float most = weights->row(vertex).maxCoeff(&joint);
  return joint_label(joint) + "  " + figure(static_cast<double>(most), "");
}

}  // namespace

std::optional<PanePictures> pictures_of(const Session& session, app::FrameCache& cache,
                                        const PaneContent& pane, int frame) {
  PanePictures out;
  out.frame = frame;
  if (frame < 0) return out;
  bool whole = true;
  if (wants_scan(session, pane)) whole = (out.scan = cache.scan(frame)) != nullptr;
  for (const int k : pane.takes) {
    out.takes.push_back(nullptr);
    if (!wants_take(session, k, frame)) continue;
    out.takes.back() = take_picture(session, cache, k, frame);
    whole = out.takes.back() != nullptr && whole;
  }
  if (take_colouring(session) == app::Colouring::Difference && !pane.takes.empty() &&
      wants_take(session, 0, frame))
    whole = (out.reference = cache.posed(session.takes[0], wanted(session, 0, frame))) != nullptr && whole;
  if (!whole) return std::nullopt;
  const bool ghosts = (pane.source && session.view.source.ghosts) ||
                      (!pane.takes.empty() && session.view.take.ghosts && !session.map.performance);
  if (ghosts) out.ghosts = ghosts_of(session, cache, pane, frame);
  return out;
}

bool ghosts_ready(const Session& session, const PaneContent& pane, const PanePictures& pictures) {
  return std::all_of(pictures.ghosts.begin(), pictures.ghosts.end(), [&](const PanePictures::Ghost& ghost) {
    return (ghost.scan != nullptr || !session.view.source.ghosts || !pane.source) &&
           (ghost.take != nullptr || !session.view.take.ghosts || session.map.performance ||
            pane.takes.empty());
  });
}

void prefetch(const Session& session, app::FrameCache& cache, const PaneContent& pane) {
  const int frame = pane_frame(session, pane), count = frame_count(session, pane);
  if (frame < 0) return;
  const app::Playback& playback = session.playback;
  const app::FrameRange range = play_range(playback, count);
  for (int i = 1; i <= kAhead; ++i) {
    int f = playback.playing ? frame + i : i % 2 == 1 ? frame + (i + 1) / 2 : frame - i / 2;
    if (playback.playing && playback.loop && !range.empty() && f > range.last)
      f = range.first + (f - range.last - 1);
    if (f < 0 || f >= count) continue;
    if (wants_scan(session, pane)) cache.prefetch_scan(f);
    for (const int k : pane.takes)
      if (wants_take(session, k, f)) cache.prefetch_posed(session.takes[k], wanted(session, k, f));
  }
}

std::vector<std::shared_ptr<const TargetLook>> looks_of(const Session& session, TargetLooks& looks,
                                                        const PaneContent& pane) {
  std::vector<std::shared_ptr<const TargetLook>> found;
  for (const int k : pane.takes) {
    const app::TakeState* take = at_or_null(session.takes, k);
    found.push_back(take != nullptr ? looks.of(take->target) : nullptr);
  }
  return found;
}

std::optional<std::shared_ptr<const TargetLook>> unposed_look(const Session& session, TargetLooks& looks,
                                                              const PaneContent& pane) {
  if (shows_rest(session, pane)) return looks.of(first_take(session, pane)->target);
  if (shows_as_loaded(session, pane)) return looks.plain_of(first_take(session, pane)->as_loaded);
  return std::nullopt;
}

std::shared_ptr<const app::PosedPicture> rest_picture(const Session& session, app::FrameCache& cache,
                                                      const PaneContent& pane, const TargetLook& look) {
  const app::TakeState& take = *first_take(session, pane);
  const bool turned = session.tool == app::Tool::RestPose && shows_rest(session, pane) &&
                      !session.document.takes[pane.takes[0]].target_edits.rest_pose.empty();
  if (!turned || take.weights == nullptr) return look.rest;
  return cache.rest(take, pane.takes[0], rest_pose(session, pane.takes[0]));
}

const PanePictures& PictureKeeper::update(const Session& session, app::FrameCache& cache, TargetLooks& looks,
                                          const PaneContent& pane) {
  forget_others(session, pane);
  if (show_unposed(session, cache, looks, pane)) return pictures_;
  const int frame = pane_frame(session, pane);
  waiting_ = false;
  if (frame < 0) return pictures_ = {};
  if (asked_.empty() || asked_.front() != frame) asked_.push_front(frame);
  if (asked_.size() > kAsked) asked_.pop_back();
  for (size_t i = 0; i < asked_.size(); ++i) {
    auto pictures = pictures_of(session, cache, pane, asked_[i]);
    if (!pictures) continue;
    pictures_ = std::move(*pictures);
    asked_.resize(i + 1);  // what is older will never be shown again
    break;
  }
  waiting_ = pictures_.frame != frame || !ghosts_ready(session, pane, pictures_);
  return pictures_;
}

/// The look in T-pose or as loaded; the one shown before stays until it is ready.
bool PictureKeeper::show_unposed(const Session& session, app::FrameCache& cache, TargetLooks& looks,
                                 const PaneContent& pane) {
  const auto look = unposed_look(session, looks, pane);
  if (!look) return false;
  asked_.clear();
  waiting_ = *look == nullptr || (!(*look)->shaded && shows_rest(session, pane));
  if (*look == nullptr && pictures_.frame < 0) return true;
  const bool rested = pictures_.frame < 0 && !pictures_.takes.empty();
  const auto before = rested ? pictures_.takes[0] : nullptr;
  pictures_ = {};
  if (*look == nullptr || !session.view.take.surface) return true;
  auto rest = rest_picture(session, cache, pane, **look);
  waiting_ = waiting_ || rest == nullptr;
  if (rest == nullptr) rest = before != nullptr ? before : (*look)->rest;
  pictures_.takes = {std::move(rest)};
  return true;
}

/// Pictures of another source or target are not shown any longer.
void PictureKeeper::forget_others(const Session& session, const PaneContent& pane) {
  std::vector<std::shared_ptr<const Target>> targets;
  for (const int k : pane.takes) {
    const app::TakeState* take = at_or_null(session.takes, k);
    targets.push_back(take != nullptr ? shown_target(*take) : nullptr);
  }
  const bool same =
      source_ == session.document.source.path &&
      std::equal(targets.begin(), targets.end(), targets_.begin(), targets_.end(),
                 [](const auto& a, const auto& b) { return a == b || same_surface(a.get(), b.get()); });
  targets_ = std::move(targets), source_ = session.document.source.path;
  if (!same) pictures_ = {}, asked_.clear();
}

bool PaneCanvas::shows(const render::Scene& scene, const render::Camera& camera,
                       render::PixelSize size) const {
  return seen_from(camera, size) && same(scene, scene_);
}

bool PaneCanvas::seen_from(const render::Camera& camera, render::PixelSize size) const {
  return drawn_ && same(size, size_) && same(camera, camera_);
}

void PaneCanvas::draw(render::Renderer& renderer, const render::Scene& scene, const render::Camera& camera,
                      render::PixelSize size, bool fine) {
  if (!same(size, size_))
    render::gl::attach(framebuffer_, texture_,
                       {size.width, size.height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST});
  renderer.draw(scene, camera, {framebuffer_.name(), size});
  size_ = size, scene_ = scene, camera_ = camera;
  drawn_ = true, fine_ = fine;
}

std::optional<render::SurfaceHit> take_under(const Session& session, const PaneContent& pane,
                                             const PanePictures& pictures, const render::Ray& ray) {
  const app::TakeState* take = first_take(session, pane);
  const auto posed = pictures.takes.empty() ? nullptr : pictures.takes[0];
  if (take == nullptr || take->target == nullptr || posed == nullptr) return std::nullopt;
  const Mesh& mesh = take->target->mesh;
  if (mesh.is_cloud() || mesh.vertices.rows() != posed->vertices.rows()) return std::nullopt;
  return render::surface_under(ray, posed->vertices, mesh.faces);
}

/// Where a ray meets a body of that surface where it was drawn last, of a cloud its point.
std::optional<render::SurfaceHit> body_under(const Mesh& rest, const BonesMemory& drawn,
                                             const render::Ray& ray) {
  if (drawn.vertices->rows() == 0) return std::nullopt;
  return rest.is_cloud() ? point_under(*drawn.vertices, ray)
                         : render::surface_under(ray, *drawn.vertices, rest.faces);
}

std::optional<render::SurfaceHit> found_under(const Session& session, const BonesMemory& drawn,
                                              const render::Ray& ray) {
  if (!session.bones.rig || drawn.of != session.bones.rig) return std::nullopt;
  return body_under(session.bones.rig->found.rig.surface, drawn, ray);
}

std::string value_under(const Session& session, const Pane& pane, const ImVec2& at) {
  const Legend& legend = pane.made.legend;
  const auto& values = pane.made.values;
  if (legend.title.empty() || (values == nullptr && legend.categories.empty())) return "";
  const int person = pane.made.values_take + 1;
  const render::Ray ray = pane.view.shifted(aside(session, pane.content, person)).ray(at);
  const auto hit =
      paints_found_bones(session, pane.content) ? found_under(session, pane.memory.bones, pane.view.ray(at))
      : pane.made.values_take < 0               ? scan_under(session, pane, ray)
                                  : take_under(session, pane.content, pane.keeper.pictures(), ray);
  if (!hit) return "";
  if (values == nullptr) return weight_words(session, pane, hit->vertex);
  return hit->vertex < values->size() ? figure(static_cast<double>((*values)[hit->vertex]), legend.unit) : "";
}

int person_under(const Session& session, const Pane& pane, const ImVec2& at) {
  const std::vector<int>& owner = pane.memory.scan.owner;
  if (!pane.content.source || owner.empty() || !app::has_several_people(session)) return 0;
  const auto hit = scan_under(session, pane, pane.view.shifted(aside(session, pane.content, 0)).ray(at));
  return hit && hit->vertex < ssize(owner) ? std::max(0, owner[static_cast<size_t>(hit->vertex)]) : 0;
}

int bone_under(const Session& session, const Pane& pane, const ImVec2& at) {
  constexpr float kBoneReach = 9;  // pixels
  const auto bones = posed_bones(session, pane.content, pane.keeper.pictures().frame);
  return bones ? bone_at(pane.view.shifted(aside(session, pane.content, 0)), *bones, at, kBoneReach) : -1;
}

std::optional<uint64_t> offered_under(const Session& session, const Pane& pane, const ImVec2& at) {
  if (!pane.content.source) return std::nullopt;
  const render::Ray ray = pane.view.ray(at);
  std::optional<uint64_t> seed;
  float least = 0;
  for (const app::ShownMotion& one : app::shown_motions(session, pane.keeper.pictures().frame)) {
    const BonesMemory* const drawn = pane.memory.made.find(one.made.get());
    if (drawn == nullptr) continue;
    const auto hit = body_under(session.bones.rig->found.rig.surface, *drawn, ray);
    if (!hit) continue;
    const float away = (hit->position - ray.origin).norm();
    if (seed && away >= least) continue;
    least = away;
    seed = one.clip < 0 ? std::optional(one.seed()) : std::nullopt;
  }
  return seed;
}

std::optional<Vec3> surface_place(const Session& session, const Pane& pane, const ImVec2& at) {
  const auto& takes = pane.content.takes;
  const Vec3 of_take = aside(session, pane.content, takes.empty() ? 0 : takes[0] + 1),
             of_scan = aside(session, pane.content, 0);
  const auto hit =
      take_under(session, pane.content, pane.keeper.pictures(), pane.view.shifted(of_take).ray(at));
  if (hit) return hit->position + of_take;
  const auto point = scan_under(session, pane, pane.view.shifted(of_scan).ray(at));
  return point ? std::optional<Vec3>(point->position + of_scan) : std::nullopt;
}

}  // namespace understudy::ui
