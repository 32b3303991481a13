#include "ui/viewport/views.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/run/step_index.hpp"
#include "app/session/follow.hpp"
#include "render/gizmo.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/draw_pass.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/panel.hpp"
#include "ui/viewport/view_cube.hpp"

namespace understudy::ui {
namespace {

using app::Session;

constexpr float kLeastSide = 24;  // pixels; a smaller pane is not drawn
constexpr float kGap = 2;         // points between panes
constexpr float kTurn = 0.0075f;  // radians a point of dragging

/// Cells of one size, in one row, in two where there are many.
std::vector<Rect> cells(const Rect& area, int count, float gap) {
  const int columns = count <= 3 ? count : (count + 1) / 2, rows = (count + columns - 1) / columns;
  const float width =
      std::floor((area.width() - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns));
  const float height =
      std::floor((area.height() - gap * static_cast<float>(rows - 1)) / static_cast<float>(rows));
  std::vector<Rect> all;
  for (int i = 0; i < count; ++i) {
    const int column = i % columns, row = i / columns;
    const ImVec2 at(area.min.x + static_cast<float>(column) * (width + gap),
                    area.min.y + static_cast<float>(row) * (height + gap));
    all.push_back({at, {at.x + width, at.y + height}});
  }
  return all;
}

/// The item that the mouse uses in a picture.
void picture_button(const char* name, const Rect& rect) {
  ImGui::SetCursorScreenPos(rect.min);
  ImGui::InvisibleButton(name, {rect.width(), rect.height()},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
}

/// Above the heads, where there are several people.
std::vector<Overlay::Tag> person_tags(const Session& session, const Pane& pane, int frame,
                                      const Theme& look) {
  const app::KeptSource* seen = at_or_null(session.source.frames, frame);
  std::vector<Overlay::Tag> tags;
  if (!pane.content.source || seen == nullptr || !seen->owners || !session.view.source.surface ||
      !app::has_several_people(session))
    return tags;
  const PaneView view = pane.view.shifted(aside(session, pane.content, 0));
  for (const auto& [id, box] : seen->owners->people()) {
    const Vec3 top(0.5f * (box.low.x() + box.high.x()), box.high.y(), 0.5f * (box.low.z() + box.high.z()));
    const auto at = view.project(top);
    if (!at || !view.rect.contains(*at)) continue;
    const std::string number = std::to_string(id);
    tags.push_back(
        {*at, "Person " + number, person_color(look, id), id == seen->person, "view.0.person." + number});
  }
  return tags;
}

void draw_cube_of(Ui& ui, const Pane& pane) {
  if (!pane.cube) return;
  draw_cube(ui, "view." + std::to_string(pane.content.number) + ".cube", *pane.cube, pane.view.camera,
            pane.cube_face);
}

}  // namespace

void Views::forget() {
  hand_.let_go();
  under_ = nullptr;
  panes_.clear();
  looks_.forget();
}

bool Views::waiting() const {
  return std::any_of(panes_.begin(), panes_.end(), [this](const auto& pane) {
    return !pane->is_flat && (pane->keeper.waiting() || (!pane->canvas.fine() && !performing_));
  });
}

bool Views::shows_take(int k) const {
  return std::any_of(panes_.begin(), panes_.end(), [k](const auto& pane) {
    const auto& takes = pane->content.takes;
    const auto& shown = pane->keeper.pictures().takes;
    for (size_t i = 0; i < takes.size() && i < shown.size(); ++i)
      if (takes[i] == k && shown[i] != nullptr) return true;
    return false;
  });
}

void Views::draw(const Session& session, app::FrameCache& cache, PanelContext& context) {
  const Frame f{session, cache, context};
  performing_ = session.map.performance.has_value();
  constexpr int kFlags = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav;
  if (ImGui::BeginChild("##views", {0, 0}, false, kFlags)) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
    Rect area{{std::floor(at.x), std::floor(at.y)}, {std::floor(at.x + size.x), std::floor(at.y + size.y)}};
    const std::vector<PaneContent> contents = panes_of(f.session);
    prepare(f, contents.size());
    keep_view_when_following_changes(f);
    place_legend(f, area);
    if (area.width() >= kLeastSide && area.height() >= kLeastSide) {
      if (f.session.view.layout == app::Layout::Wipe && contents.size() == 2)
        draw_wipe(f, contents, area);
      else
        draw_row(f, contents, area);
    }
    draw_menu(f);
  }
  ImGui::EndChild();
}

void Views::prepare(const Frame& f, size_t count) {
  if (!renderer_ || samples_ != f.session.settings.samples) {
    samples_ = f.session.settings.samples;
    renderer_.emplace(render::RendererOptions{samples_, render::Quality::Interactive});
    sketcher_.reset();
    // One sample, and no smoothing of its edges: a third of the time on software OpenGL.
    if (samples_ > 1) sketcher_.emplace(render::RendererOptions{1, render::Quality::Interactive, false});
    for (auto& pane : panes_) pane->canvas.forget();
  }
  if (panes_.size() != count) hand_.let_go();
  while (panes_.size() < count) panes_.push_back(std::make_unique<Pane>());
  panes_.resize(count);
  if (tool_ != f.session.tool || (hand_.busy() && key_pressed(render::Key::Escape, false))) hand_.let_go();
  tool_ = f.session.tool;
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  const bool shares = is_live(f.session) && !steering() && (moved.x != 0 || moved.y != 0);
  turn_ = shares ? (turn_ + 1) % std::max(2, static_cast<int>(count)) : -1;
  under_ = nullptr;
}

/// The joints' colours, once, at the right of all views; takes its place from their area where that is wide.
void Views::place_legend(const Frame& f, Rect& area) {
  const Legend legend = joints_legend(f.session);
  const ImVec2 size = legend_size(f.context.ui, legend);
  const float width = std::ceil(size.x + f.context.ui.px(16));
  legend_beside_ = !legend.title.empty() && !f.session.takes.empty() && size.y <= area.height() &&
                   4 * width <= area.width();
  if (!legend_beside_) return;
  area.max.x -= width;
  draw_legend(f.context.ui, legend, {{area.max.x, area.min.y}, {area.max.x + width, area.max.y}});
}

void Views::draw_row(const Frame& f, const std::vector<PaneContent>& contents, const Rect& area) {
  const auto rects = cells(area, contents.size(), f.context.ui.px(kGap));
  for (size_t i = 0; i < contents.size(); ++i) {
    if (rects[i].width() < kLeastSide || rects[i].height() < kLeastSide) continue;
    Pane& pane = *panes_[i];
    pane.is_flat = app::is_canvas(f.session, contents[i].number);
    if (pane.is_flat) {
      draw_canvas(f, pane, contents[i], rects[i]);
      continue;
    }
    set_up(f, pane, contents[i], {rects[i], pane_camera(f.session, contents[i])});
    use_cube(f, pane, rects[i]);
    const std::string name = "view." + std::to_string(contents[i].number);
    picture_button(name.c_str(), rects[i]);
    f.context.ui.mark(name);
    interact(f, pane);
    make_picture(f, pane);
    show(f, pane, rects[i], false);
    draw_cube_of(f.context.ui, pane);
  }
}

void Views::draw_canvas(const Frame& f, Pane& pane, const PaneContent& content, const Rect& rect) {
  pane.content = content;
  pane.cube.reset();
  const std::string name = "view." + std::to_string(content.number);
  picture_button(name.c_str(), rect);
  f.context.ui.mark(name);
  pane.flat.interact(f.session, content, rect, f.context);
  pane.flat.draw(f.session, content, rect, rect, f.context);
}

/// Two canvases over each other; both are moved together.
void Views::draw_flat_wipe(const Frame& f, const std::vector<PaneContent>& contents, const Rect& area) {
  const float line = wipe_line(f, area);
  picture_button("view.both", area);
  panes_[0]->flat.interact(f.session, contents[0], area, f.context);
  for (size_t i = 0; i < 2; ++i) {
    panes_[i]->content = contents[i], panes_[i]->is_flat = true;
    panes_[i]->cube.reset();
    const Rect part = i == 0 ? Rect{area.min, {line, area.max.y}} : Rect{{line, area.min.y}, area.max};
    f.context.ui.mark("view." + std::to_string(contents[i].number), part);
    panes_[i]->flat.draw(f.session, contents[i], area, part, f.context);
  }
  draw_wipe_line(f, area, line);
}

void Views::draw_wipe_line(const Frame& f, const Rect& area, float line) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float middle = area.min.y + 0.5f * area.height();
  list.AddLine({line, area.min.y}, {line, area.max.y}, color(f.context.ui.theme().text, 0.85f),
               f.context.ui.px(1.5f));
  list.AddCircleFilled({line, middle}, f.context.ui.px(7), color(f.context.ui.theme().text), 24);
}

/// Two pictures over each other in one place, seen through the camera of the first.
void Views::draw_wipe(const Frame& f, const std::vector<PaneContent>& contents, const Rect& area) {
  const auto is_flat = [&](const PaneContent& content) { return app::is_canvas(f.session, content.number); };
  if (is_flat(contents[0]) && is_flat(contents[1])) return draw_flat_wipe(f, contents, area);
  if (is_flat(contents[0]) || is_flat(contents[1])) return draw_row(f, contents, area);
  for (auto& pane : panes_) pane->is_flat = false;
  const float line = wipe_line(f, area);
  const render::Camera camera = pane_camera(f.session, contents[0]);
  for (size_t i = 0; i < 2; ++i) set_up(f, *panes_[i], contents[i], {area, camera});
  panes_[1]->cube.reset();
  use_cube(f, *panes_[0], area);
  picture_button("view.both", area);
  const size_t mouse_in = ImGui::GetIO().MousePos.x < line ? 0 : 1;
  const size_t gripped = hand_.pane() == contents[0] ? 0 : 1;
  interact(f, *panes_[hand_.busy() ? gripped : mouse_in]);
  for (size_t i = 0; i < 2; ++i) {
    make_picture(f, *panes_[i]);
    const Rect part = i == 0 ? Rect{area.min, {line, area.max.y}} : Rect{{line, area.min.y}, area.max};
    f.context.ui.mark("view." + std::to_string(contents[i].number), part);
    show(f, *panes_[i], part, i == 1);
  }
  draw_wipe_line(f, area, line);
  draw_cube_of(f.context.ui, *panes_[0]);
}

/// The handle comes before the picture's item, so that it is met first.
float Views::wipe_line(const Frame& f, const Rect& area) {
  const float line = std::floor(area.min.x + std::clamp(f.session.view.wipe, 0.f, 1.f) * area.width());
  const float reach = f.context.ui.px(6);
  ImGui::SetCursorScreenPos({line - reach, area.min.y});
  ImGui::InvisibleButton("view.wipe", {2 * reach, area.height()});
  f.context.ui.mark("view.wipe");
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActive() && ImGui::GetIO().MouseDelta.x != 0) {
    const float share = (ImGui::GetIO().MousePos.x - area.min.x) / area.width();
    f.context.queue.push_back({"view.wipe", {argument(static_cast<double>(std::clamp(share, 0.f, 1.f)))}});
  }
  return line;
}

void Views::set_up(const Frame& f, Pane& pane, const PaneContent& content, const PaneView& view) {
  if (!(pane.content == content)) pane.memory = {};
  const render::Camera before = pane.view.camera;
  const bool held = (hold_ || waits(pane)) && pane.content == content && !pane.view.rect.empty();
  pane.content = content;
  pane.view = view;
  if (held) pane.view.camera = before;
  pane.keeper.update(f.session, f.cache, looks_, content);
  prefetch(f.session, f.cache, content);
}

/// The item just made is the pane's.
void Views::interact(const Frame& f, Pane& pane) {
  const Pointer now = pointer_of_item();
  const PaneView seen = tool_view(f.session, pane);
  const HandPlace place{f.session,         pane.content, seen, pane.keeper.pictures(), f.context.ui.scale(),
                        &pane.memory.bones};
  const bool taken = hand_.work(place, now, f.context.queue);
  if (now.over || now.held) {
    pointer_ = now, under_ = &pane;
    const bool steering = now.turning || now.lighting || now.panning || now.wheel != 0;
    if (now.pressed || steering || now.asks) activate(f, pane);
  }
  if (now.asks && !hand_.busy()) ask_what_to_do(f, pane, now);
  if (now.released && !taken) choose_person(f, pane, now);
  steer(f, pane, now, !taken);
}

PaneView Views::tool_view(const Session& session, const Pane& pane) {
  return pane.view.shifted(aside(session, pane.content, person_of_tool(session, pane.content)));
}

/// A click, not a drag, on a bone that was found in the scan chooses it; on a motion that is offered it keeps
/// that; on somebody it makes them the source.
void Views::choose_person(const Frame& f, const Pane& pane, const Pointer& now) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool dragged = io.MouseDragMaxDistanceSqr[0] >= io.MouseDragThreshold * io.MouseDragThreshold;
  if (dragged || !now.over || f.session.tool != app::Tool::Look) return;
  if (const int bone = bone_under(f.session, pane, now.at); bone >= 0)
    return f.context.queue.push_back(
        {"bones.select", {bone == f.session.bones.selected ? "none" : std::to_string(bone)}});
  if (const auto seed = offered_under(f.session, pane, now.at))
    return f.context.queue.push_back({"generate.keep", {std::to_string(*seed)}});
  const int person = person_under(f.session, pane, now.at);
  if (person > 0 && person != f.session.source.person)
    f.context.queue.push_back({"source.person", {std::to_string(person)}});
}

/// Commands are about it from now on.
void Views::activate(const Frame& f, const Pane& pane) {
  if (pane.content.number != f.session.view.active_pane)
    f.context.queue.push_back({"view.pane", {std::to_string(pane.content.number)}});
}

void Views::point_camera(const Frame& f, const Pane& pane, const render::Camera& camera) {
  f.context.queue.push_back({"view.camera_state", camera_arguments(f.session, pane.content, camera)});
}

void Views::ask_what_to_do(const Frame& f, const Pane& pane, const Pointer& now) {
  menu_ = {pane.content, hand_.hovered_joint(pane.content), {}};
  if (const auto place = surface_place(f.session, pane, now.at)) {
    render::Camera camera = pane.view.camera;
    camera.target = *place;
    menu_.centred = camera_arguments(f.session, pane.content, camera);
  }
  ImGui::OpenPopup("view.menu");
}

void Views::draw_menu(const Frame& f) {
  if (!ImGui::BeginPopup("view.menu")) return;
  draw_menu_items(f.session, f.context, view_menu_items(f.session, menu_));
  ImGui::EndPopup();
}

/// Comes before the picture's item, so that it is met first. Beside its faces the picture is met.
void Views::use_cube(const Frame& f, Pane& pane, const Rect& part) {
  pane.cube = f.session.view.cube ? cube_place(f.context.ui, part) : std::nullopt;
  const bool held = std::exchange(pane.cube_held, false);
  pane.cube_face = -1;
  if (!pane.cube || hand_.busy()) return;
  const ImGuiIO& io = ImGui::GetIO();
  const int face = cube_face_at(*pane.cube, pane.view.camera, io.MousePos);
  if (face < 0 && !held) return;
  ImGui::SetCursorScreenPos(pane.cube->min);
  const std::string name = "view." + std::to_string(pane.content.number) + ".cube";
  const bool clicked = ImGui::InvisibleButton(name.c_str(), {pane.cube->width(), pane.cube->height()});
  pane.cube_held = ImGui::IsItemActive();
  const bool dragged = io.MouseDragMaxDistanceSqr[0] >= io.MouseDragThreshold * io.MouseDragThreshold;
  if (ImGui::IsItemHovered() && !(pane.cube_held && dragged)) pane.cube_face = face;
  if (pane.cube_held && dragged) {
    const float turned = kTurn * f.session.settings.mouse_sensitivity / f.context.ui.scale();
    activate(f, pane);
    point_camera(f, pane,
                 render::orbited(pane.view.camera, -turned * io.MouseDelta.x, turned * io.MouseDelta.y));
  } else if (clicked && !dragged && face >= 0) {
    activate(f, pane);
    f.context.queue.push_back({"view.preset", {app::kViewPresets[face].name}});
  }
}

void Views::steer(const Frame& f, Pane& pane, const Pointer& now, bool free_left) {
  const float turn = kTurn * f.session.settings.mouse_sensitivity / f.context.ui.scale();
  std::optional<render::Camera> camera;
  if (!hand_.busy()) camera = navigated(pane.view, now, free_left, turn);
  if (now.doubled && free_left) {
    if (const auto place = surface_place(f.session, pane, now.at)) {
      camera = pane.view.camera;
      camera->target = *place;
    }
  }
  if (camera) point_camera(f, pane, *camera);
  if (now.lighting && !hand_.busy()) turn_light(f, now);
}

/// The light goes the way the pointer goes.
void Views::turn_light(const Frame& f, const Pointer& now) {
  const app::LightLook& light = f.session.view.light;
  const float turn = kTurn * f.session.settings.mouse_sensitivity / f.context.ui.scale() * 180 / kPi;
  const auto ask = [&](const char* what, float degrees) {
    f.context.queue.push_back({"view.light", {what, argument(static_cast<double>(degrees))}});
  };
  if (now.moved.x != 0) ask("turn", std::remainder(light.turn_deg + turn * now.moved.x, 360.f));
  if (now.moved.y != 0) ask("height", std::clamp(light.height_deg - turn * now.moved.y, -90.f, 90.f));
}

bool Views::waits(const Pane& pane) const {
  return turn_ >= 0 && (turn_ >= ssize(panes_) || panes_[turn_].get() != &pane);
}

void Views::make_picture(const Frame& f, Pane& pane) {
  if (waits(pane) && pane.canvas.seen_from(pane.view.camera, pane.view.size())) return;
  const PaneView seen = tool_view(f.session, pane);
  const HandPlace place{f.session,         pane.content, seen, pane.keeper.pictures(), f.context.ui.scale(),
                        &pane.memory.bones};
  PanePictures pictures = pane.keeper.pictures();
  pane.preview = hand_.preview(place);
  if (const auto turned = hand_.turned_picture(place); turned != nullptr && !pictures.takes.empty())
    pictures.takes[0] = turned;
  auto found = looks_of(f.session, looks_, pane.content);
  if (shows_as_loaded(f.session, pane.content)) found = {*unposed_look(f.session, looks_, pane.content)};
  const SceneInput input{f.session, pane.content, pictures, found, pane.preview, f.context.ui.theme().kind};
  pane.made = build_scene(input, pane.memory);
  draw_picture(f, pane);
}

/// What has changed is drawn quickly first, and well as soon as nothing moves.
void Views::draw_picture(const Frame& f, Pane& pane) {
  const render::PixelSize size = pane.view.size();
  const bool changed = !pane.canvas.shows(pane.made.scene, pane.view.camera, size);
  const bool fine = samples_ <= 1 || (!changed && !moving(f.session));
  if (!changed && (pane.canvas.fine() || !fine)) return;
  pane.canvas.draw(fine ? *renderer_ : *sketcher_, pane.made.scene, pane.view.camera, size, fine);
  ++drawn_;
}

bool Views::is_live(const Session& session) {
  return session.working && !session.paused && session.playback.live && app::shown_frame(session) >= 0;
}

bool Views::steering() const {
  return (under_ != nullptr && (pointer_.held || pointer_.turning || pointer_.panning)) || hand_.busy() ||
         std::any_of(panes_.begin(), panes_.end(), [](const auto& pane) { return pane->cube_held; });
}

bool Views::moving(const Session& session) const {
  return session.playback.playing || session.map.performance || is_live(session) || steering() ||
         session.view.turntable_deg_s != 0;
}

void Views::show(const Frame& f, Pane& pane, const Rect& part, bool right) {
  const Rect& rect = pane.view.rect;
  const float from = (part.min.x - rect.min.x) / rect.width(), to = (part.max.x - rect.min.x) / rect.width();
  if (part.empty()) return;
  ImGui::GetWindowDrawList()->AddImage(texture_id(pane.canvas.texture()), part.min, part.max, {from, 1},
                                       {to, 0});
  Overlay overlay;
  overlay.rect = part, overlay.title_right = right;
  const auto& cube = pane.cube ? pane.cube : panes_.front()->cube;  // a wipe has one
  if (cube && cube->max.x <= part.max.x) overlay.right_taken = cube->width();
  describe(f.session, pane, f.context.ui.theme(), overlay);
  overlay.active = panes_.size() > 1 && f.session.view.layout == app::Layout::SideBySide &&
                   pane.content.number == f.session.view.active_pane;
  mark_made_motions(f, pane, overlay);
  draw_overlay(f.context.ui, overlay);
  draw_brush(f, pane);
  mark_rings(f, pane);
  mark_bones(f, pane);
}

/// The words and labels over a pane.
void Views::describe(const Session& session, const Pane& pane, const Theme& look, Overlay& overlay) const {
  const int frame = pane.keeper.pictures().frame;
  const bool rest = shows_rest(session, pane.content);
  overlay.title = pane_title(session, pane.content);
  overlay.hint = pane_hint(session, pane.content);
  if (overlay.hint.empty()) {
    overlay.subtitle = shows_as_loaded(session, pane.content) ? "as loaded \u00b7 binding\u2026"
                       : rest && session.tool == app::Tool::RestPose
                           ? "rest pose \u00b7 turn a bone by its rings"
                       : rest && session.tool == app::Tool::Face ? "T-pose \u00b7 drag a mark over the head"
                       : rest                                    ? "T-pose"
                       : frame >= 0                              ? "frame " + std::to_string(frame)
                                                                 : "";
    const std::string method = rest ? "" : pane_method(session, pane.content);
    if (!method.empty()) overlay.subtitle += (overlay.subtitle.empty() ? "" : " \u00b7 ") + method;
    if (!legend_beside_ || pane.made.legend.categories.empty()) overlay.legend = pane.made.legend;
  }
  const auto& performance = session.map.performance;
  if (!rest && performance && !pane.content.takes.empty() &&
      performance->frame_at(session.time, pane.content.takes[0]) >= 0)
    overlay.subtitle = "performs " + app::step_words(*session.map.map, performance->step);
  const app::KeptSource* seen = at_or_null(session.source.frames, frame);
  const std::string made = rest ? "" : pane_made(session, pane.content, frame);
  if (!made.empty()) overlay.subtitle += " \u00b7 " + made;
  if (seen != nullptr && seen->flagged && made.empty() && !hides_person(session))
    overlay.warning = seen->reason;
  const app::Layers& layers = pane.content.source ? session.view.source : session.view.take;
  const int person = person_of_tool(session, pane.content);
  const PaneView view = tool_view(session, pane);
  const Joints* joints = app::pane_joints(session, person, frame);
  std::optional<Joints> at_rest;
  if (rest) joints = &at_rest.emplace(rest_joints(session, pane.content.takes[0]));
  const auto& moved = person == 0 ? pane.preview.source_joints : pane.preview.take_joints;
  if (moved) joints = &*moved;
  const bool on_joints = pane.preview.gizmo && !tool_on_found_bones(session, pane.content);
  const int selected = on_joints ? session.selected_joint : -1;
  const bool no_joints = person == 0 && hides_person(session);
  if (joints != nullptr && !no_joints)
    overlay.labels = joint_labels(view, *joints, layers.joint_names && layers.skeleton,
                                  hand_.hovered_joint(pane.content), selected);
  label_bones(session, pane, overlay);
  if (session.tool == app::Tool::Crop && pane.content.source) {
    const Points centres = face_centres(pane.preview.crop.value_or(app::shown_crop(session)));
    for (int face = 0; face < 6; ++face)
      if (const auto at = view.project(centres.row(face)))
        overlay.handles.push_back(
            {*at, std::string("view.crop.") + kBoxSides[face], face == pane.preview.crop_face});
  }
  for (Overlay::Handle& handle : hand_.face().handles(session, pane.content, view))
    overlay.handles.push_back(std::move(handle));
  overlay.tags = person_tags(session, pane, frame, look);
  if (under_ != &pane) return;
  overlay.tip_at = pointer_.at;
  overlay.tip = words_at_pointer(session, pane);
}

/// The bone that was found in the scan and lies under the pointer; -1: none.
int Views::bone_at_pointer(const Session& session, const Pane& pane) const {
  if (session.tool != app::Tool::Look) return hand_.hovered_bone(pane.content);
  return under_ == &pane ? bone_under(session, pane, pointer_.at) : -1;
}

void Views::label_bones(const Session& session, const Pane& pane, Overlay& overlay) const {
  const auto bones = posed_bones(session, pane.content, pane.keeper.pictures().frame, pane.preview.found);
  if (!bones) return;
  for (Overlay::Label& label : bone_labels(session, pane.view.shifted(aside(session, pane.content, 0)),
                                           *bones, bone_at_pointer(session, pane)))
    overlay.labels.push_back(std::move(label));
}

std::string Views::words_at_pointer(const Session& session, const Pane& pane) const {
  std::string words = hand_.tip();
  if (!words.empty() || session.playback.playing) return words;
  if (const int bone = bone_at_pointer(session, pane); bone >= 0) return bone_words(session, bone);
  if (const auto seed = offered_under(session, pane, pointer_.at); seed && session.tool == app::Tool::Look)
    return "Motion " + std::to_string(*seed) + ": click, and it becomes a clip";
  words = value_under(session, pane, pointer_.at);
  if (!words.empty() || session.tool != app::Tool::Look) return words;
  if (const int number = person_under(session, pane, pointer_.at); number > 0)
    words = "Person " + std::to_string(number) +
            (number == session.source.person ? ": performs" : ": click, and they perform");
  return words;
}

/// Where each ring of the gizmo is farthest from its middle, as seen.
void Views::mark_rings(const Frame& f, const Pane& pane) const {
  const auto& gizmo = pane.preview.gizmo;
  if (!gizmo || gizmo->kind != render::GizmoView::Kind::Turn) return;
  const PaneView view = tool_view(f.session, pane);
  const Vec3 to_eye = render::eye(view.camera) - gizmo->position;
  for (int axis = 0; axis < gizmo->rings; ++axis) {
    const Vec3 side = gizmo->axes.col(axis).cross(to_eye).normalized();
    const auto at = view.project(gizmo->position + render::gizmo_reach(*gizmo, view.camera) * side);
    if (!at) continue;
    const Rect place{{at->x - 1, at->y - 1}, {at->x + 1, at->y + 1}};
    f.context.ui.mark(std::string("view.ring.") + "xyz"[axis], place);
  }
}

/// In the middle of each bone that was found in the scan.
void Views::mark_bones(const Frame& f, const Pane& pane) {
  const auto bones = posed_bones(f.session, pane.content, pane.keeper.pictures().frame);
  if (!bones) return;
  for (const auto& [joint, at] : bone_middles(pane.view.shifted(aside(f.session, pane.content, 0)), *bones))
    f.context.ui.mark("view.bone." + std::to_string(joint), {{at.x - 1, at.y - 1}, {at.x + 1, at.y + 1}});
}

/// On the surface of each motion that is shown, its seed over its head.
void Views::mark_made_motions(const Frame& f, const Pane& pane, Overlay& overlay) {
  if (!pane.content.source) return;
  for (const app::ShownMotion& one : app::shown_motions(f.session, pane.keeper.pictures().frame)) {
    const BonesMemory* const drawn = pane.memory.made.find(one.made.get());
    if (drawn == nullptr || drawn->vertices->rows() == 0) continue;
    const Points& points = *drawn->vertices;
    const Vec3 middle = points.colwise().mean().transpose();
    Eigen::Index nearest = 0;
    (points.rowwise() - middle.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    if (const auto at = pane.view.project(points.row(nearest)))
      f.context.ui.mark("view.made." + std::to_string(one.seed()),
                        {{at->x - 1, at->y - 1}, {at->x + 1, at->y + 1}});
    const Vec3 above(middle.x(), points.col(1).maxCoeff(), middle.z());
    const std::string name = one.clip < 0
                                 ? "Motion " + std::to_string(one.seed())
                                 : f.session.document.bones.clips[static_cast<size_t>(one.clip)].name;
    if (const auto at = pane.view.project(above)) overlay.labels.push_back({*at, name, one.clip >= 0});
  }
}

/// The brush's circle, flat on the surface.
void Views::draw_brush(const Frame& f, const Pane& pane) {
  const auto brush = hand_.brush(pane.content);
  if (!brush) return;
  const Vec3 u = brush->normal.unitOrthogonal(), v = brush->normal.cross(u);
  const PaneView view = tool_view(f.session, pane);
  std::vector<ImVec2> circle;
  for (int i = 0; i < 48; ++i) {
    const float angle = 2 * kPi * static_cast<float>(i) / 48;
    const Vec3 at = brush->position + f.session.brush.radius_m * (std::cos(angle) * u + std::sin(angle) * v);
    if (const auto seen = view.project(at)) circle.push_back(*seen);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddPolyline(circle.data(), circle.size(), color(ImVec4(0, 0, 0, 0.5f)), ImDrawFlags_Closed,
                   f.context.ui.px(3));
  list.AddPolyline(circle.data(), circle.size(), color(ImVec4(1, 1, 1, 0.9f)), ImDrawFlags_Closed,
                   f.context.ui.px(1.5f));
}

/// Switching the following camera on or off keeps the current picture.
void Views::keep_view_when_following_changes(const Frame& f) {
  const bool now = f.session.view.follow;
  hold_ = followed_ && *followed_ != now;
  followed_ = now;
  if (!hold_) return;
  for (size_t i = 0; i < panes_.size(); ++i) {
    const Pane& pane = *panes_[i];
    if (i > 0 && f.session.view.linked) break;
    if (pane.is_flat || pane.view.rect.empty() || shows_rest(f.session, pane.content)) continue;
    f.context.queue.push_back(
        {"view.camera_state", camera_arguments(f.session, pane.content, pane.view.camera)});
  }
}

}  // namespace understudy::ui
