#include "ui/viewport/flat_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/pose_picture.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/draw_pass.hpp"

namespace understudy::ui {
namespace {

using app::Session;
using render::Image;

constexpr float kFaint = 0.3f;          // of the colours of who does not perform
constexpr float kPointReach = 11;       // points around the pointer in which a point of the body is met
constexpr float kPersonReach = 24;      // the same of a person
constexpr float kZoomNotch = 1.13636f;  // a notch of the wheel
constexpr float kWeak = 0.5f;           // confidence
constexpr float kMargin = 0.97f;        // of the pane that a whole canvas takes

const app::FlatResult* result_of(const Session& session, const PaneContent& pane) {
  const app::TakeState* const take = pane.source ? nullptr : first_take(session, pane);
  return take == nullptr ? nullptr : take->flat.get();
}

FlatPose scaled(FlatPose pose, float by) {
  for (FlatPoints* points : {&pose.left_hand, &pose.right_hand, &pose.face}) points->leftCols<2>() *= by;
  pose.body.leftCols<2>() *= by;
  return pose;
}

/// A picture brought to the canvas's size, as bright as it is wanted.
Image backdrop(const Pixels& pixels, int width, int height, float brightness) {
  Image image(width, height, Vec3::Zero());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto column = static_cast<int64_t>(x) * pixels.width / width,
                 row = static_cast<int64_t>(y) * pixels.height / height;
      const uint8_t* const from = pixels.rgb.get() + 3 * (row * pixels.width + column);
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = static_cast<uint8_t>(brightness * static_cast<float>(from[c]));
    }
  return image;
}

/// What is not black of `picture` over `below`.
void put_over(const Image& picture, Image& below) {
  for (size_t i = 0; i + 2 < picture.pixels.size(); i += 3)
    if ((picture.pixels[i] | picture.pixels[i + 1] | picture.pixels[i + 2]) != 0)
      std::copy_n(picture.pixels.begin() + static_cast<std::ptrdiff_t>(i), 3,
                  below.pixels.begin() + static_cast<std::ptrdiff_t>(i));
}

void dim(Image& image, float by) {
  for (uint8_t& value : image.pixels) value = static_cast<uint8_t>(by * static_cast<float>(value));
}

/// As large as it is shown at most, and how much smaller than the canvas that is.
Image blank(const Canvas& canvas, float& scale) {
  scale = std::min(
      1.0f, static_cast<float>(kLargestPicture) / static_cast<float>(std::max(canvas.width, canvas.height)));
  const auto side = [scale = scale](int pixels) {
    return std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(pixels))));
  };
  return {side(canvas.width), side(canvas.height), Vec3::Zero()};
}

Image source_picture(const app::FlatPoses& poses, int frame, const std::optional<MovedPoint>& moved) {
  float scale = 1;
  Image image = blank(poses.reading.canvas, scale);
  const int performer = poses.reading.performer;
  for (int k = 0; k < ssize(poses.reading.tracks); ++k)
    if (const FlatPose* other =
            k == performer ? nullptr : poses.reading.tracks[static_cast<size_t>(k)].at(frame))
      render::draw_pose(image, scaled(*other, scale));
  dim(image, kFaint);
  FlatPose pose = poses.clean[static_cast<size_t>(frame)].pose;
  if (moved) pose.set(moved->first, moved->second, 1);
  render::draw_pose(image, scaled(pose, scale));
  return image;
}

Image take_picture(const app::FlatResult& result, const Canvas& canvas, int frame, float brightness) {
  float scale = 1;
  Image image = blank(canvas, scale);
  const bool on_reference = canvas == result.reference->target.canvas;
  Image behind = result.reference->picture && on_reference
                     ? backdrop(*result.reference->picture, image.width, image.height, brightness)
                     : Image(image.width, image.height, Vec3::Zero());
  const FlatPose* const pose = at_or_null(result.poses, frame);
  const auto& standing = result.reference->target.standing;
  if (pose != nullptr)
    render::draw_pose(image, scaled(*pose, scale));
  else if (standing)
    render::draw_pose(image, scaled(*standing, scale));
  put_over(image, behind);
  return behind;
}

ImVec2 on_screen(const Vec2& point, const Rect& place, const Canvas& canvas) {
  return {place.min.x + (point.x() + 0.5f) * place.width() / static_cast<float>(canvas.width),
          place.min.y + (point.y() + 0.5f) * place.height() / static_cast<float>(canvas.height)};
}

Vec2 on_canvas(const ImVec2& at, const Rect& place, const Canvas& canvas) {
  return {(at.x - place.min.x) * static_cast<float>(canvas.width) / place.width() - 0.5f,
          (at.y - place.min.y) * static_cast<float>(canvas.height) / place.height() - 0.5f};
}

float apart(const ImVec2& a, const ImVec2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// The performer's point under the pointer; -1: none.
int point_under(const FlatPose& pose, const Rect& place, const Canvas& canvas, const ImVec2& at,
                float reach) {
  int nearest = -1;
  for (int point = 0; point < kBodyPoints; ++point) {
    if (!pose.has(point)) continue;
    const float distance = apart(on_screen(pose.at(point), place, canvas), at);
    if (distance < reach) reach = distance, nearest = point;
  }
  return nearest;
}

/// The number of the person under the pointer in the frame; 0: nobody.
int64_t person_under(const app::FlatPoses& poses, int frame, const Rect& place, const ImVec2& at,
                     float reach) {
  int64_t nearest = 0;
  for (const KeypointTrack& track : poses.reading.tracks) {
    const FlatPose* const pose = track.at(frame);
    for (int point = 0; pose != nullptr && point < kBodyPoints; ++point) {
      if (!pose->has(point)) continue;
      const float distance = apart(on_screen(pose->at(point), place, poses.reading.canvas), at);
      if (distance < reach) reach = distance, nearest = track.person;
    }
  }
  return nearest;
}

bool drags_points(const Session& session, const PaneContent& pane) {
  return pane.source && session.tool == app::Tool::Joints && session.flat.poses;
}

const CleanPose* clean_at(const Session& session, int frame) {
  return session.flat.poses ? at_or_null(session.flat.poses->clean, frame) : nullptr;
}

std::string point_words(int point) {
  std::string words = kBodyPointNames[static_cast<size_t>(point)];
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

void upload(const render::gl::Texture& texture, const Image& image) {
  const auto& gl = render::gl::api();
  gl.BindTexture(GL_TEXTURE_2D, texture.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                image.pixels.data());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.BindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace

Canvas canvas_of_pane(const Session& session, const PaneContent& pane) {
  if (pane.source) return session.flat.poses ? session.flat.poses->reading.canvas : Canvas{};
  const app::FlatResult* const result = result_of(session, pane);
  if (result == nullptr) return {};
  return result->made.canvas.is_known() ? result->made.canvas : result->reference->target.canvas;
}

Image canvas_picture(const Session& session, const PaneContent& pane,
                     const std::optional<MovedPoint>& moved) {
  const int frame = pane_frame(session, pane);
  const Canvas canvas = canvas_of_pane(session, pane);
  if (!canvas.is_known()) return {};
  if (pane.source) {  // of a source that is just opened, frames may be known and poses still the old ones
    const bool is_there = clean_at(session, frame) != nullptr;
    return is_there ? source_picture(*session.flat.poses, frame, moved) : Image();
  }
  return take_picture(*result_of(session, pane), canvas, frame, session.view.reference);
}

Rect canvas_place(const Rect& pane, const Canvas& canvas, const app::CanvasView& view) {
  const float width = static_cast<float>(canvas.width), height = static_cast<float>(canvas.height);
  const float scale = kMargin * view.zoom * std::min(pane.width() / width, pane.height() / height);
  const ImVec2 middle(0.5f * (pane.min.x + pane.max.x), 0.5f * (pane.min.y + pane.max.y));
  const ImVec2 min(middle.x - view.x * scale * width, middle.y - view.y * scale * height);
  return {min, {min.x + scale * width, min.y + scale * height}};
}

void FlatCanvas::interact(const Session& session, const PaneContent& pane, const Rect& rect,
                          PanelContext& context) {
  const Pointer now = pointer_of_item();
  hovered_ = -1;
  const bool steers = now.turning || now.panning || now.wheel != 0;
  if ((now.pressed || steers || now.asks) && pane.number != session.view.active_pane)
    context.ask("view.pane", {std::to_string(pane.number)});
  if (!canvas_of_pane(session, pane).is_known()) return;
  use_left(session, pane, rect, now, context);
  if (!dragged_) steer(session, pane, rect, now, context);
}

void FlatCanvas::use_left(const Session& session, const PaneContent& pane, const Rect& rect,
                          const Pointer& now, PanelContext& context) {
  const Canvas canvas = canvas_of_pane(session, pane);
  const Rect place = canvas_place(rect, canvas, app::canvas_of(session.view, pane.number));
  const int frame = pane_frame(session, pane);
  const CleanPose* const clean = clean_at(session, frame);
  if (drags_points(session, pane) && clean != nullptr) {
    hovered_ = dragged_   ? dragged_->first
               : now.over ? point_under(clean->pose, place, canvas, now.at, context.ui.px(kPointReach))
                          : -1;
    if (now.pressed && hovered_ >= 0) dragged_ = {hovered_, clean->pose.at(hovered_)}, is_moved_ = false;
    return drag(frame, now, place, canvas, context);
  }
  if (std::exchange(dragged_, std::nullopt)) context.ask("flat.dragging", {"none"});
  const ImGuiIO& io = ImGui::GetIO();
  const bool clicked = now.released && now.over && session.tool == app::Tool::Look &&
                       io.MouseDragMaxDistanceSqr[0] < io.MouseDragThreshold * io.MouseDragThreshold;
  if (!clicked || !pane.source || !session.flat.poses || frame < 0) return;
  const int64_t person = person_under(*session.flat.poses, frame, place, now.at, context.ui.px(kPersonReach));
  if (person > 0 && person != session.flat.poses->reading.performing().person)
    context.ask("source.person", {std::to_string(person)});
}

/// Shown by those who perform, too, while it goes on; an edit when the point is let go.
void FlatCanvas::drag(int frame, const Pointer& now, const Rect& place, const Canvas& canvas,
                      PanelContext& context) {
  if (!dragged_) return;
  const bool moves = now.moved.x != 0 || now.moved.y != 0;
  if (moves) dragged_->second = on_canvas(now.at, place, canvas), is_moved_ = true;
  const auto [point, to] = *dragged_;
  if (!now.held) dragged_.reset();
  if (!is_moved_ || (now.held && !moves)) return;
  context.ask(now.held ? "flat.dragging" : "flat.drag",
              {std::to_string(frame), kBodyPointNames[static_cast<size_t>(point)],
               argument(static_cast<double>(to.x())), argument(static_cast<double>(to.y()))});
}

/// The wheel zooms about the pointer; what is dragged otherwise moves it; a double click shows all of it.
void FlatCanvas::steer(const Session& session, const PaneContent& pane, const Rect& rect, const Pointer& now,
                       PanelContext& context) {
  const Canvas canvas = canvas_of_pane(session, pane);
  app::CanvasView view = app::canvas_of(session.view, pane.number);
  const app::CanvasView before = view;
  const bool pans = now.panning || now.turning || (now.held && !now.pressed && hovered_ < 0);
  if (now.wheel != 0) {
    const Rect place = canvas_place(rect, canvas, view);
    const float x = (now.at.x - place.min.x) / place.width(), y = (now.at.y - place.min.y) / place.height();
    view.zoom = std::clamp(view.zoom * std::pow(kZoomNotch, now.wheel), 0.1f, 50.0f);
    const float kept = before.zoom / view.zoom;
    view.x = x + (view.x - x) * kept, view.y = y + (view.y - y) * kept;
  } else if (now.doubled) {
    view = {};
  } else if (pans && (now.moved.x != 0 || now.moved.y != 0)) {
    const Rect place = canvas_place(rect, canvas, view);
    view.x -= now.moved.x / place.width(), view.y -= now.moved.y / place.height();
  }
  if (same(view, before)) return;
  const auto word = [](float value) { return argument(static_cast<double>(value)); };
  context.ask("view.canvas", {std::to_string(pane.number), word(view.x), word(view.y), word(view.zoom)});
}

void FlatCanvas::draw(const Session& session, const PaneContent& pane, const Rect& rect, const Rect& part,
                      PanelContext& context) {
  if (part.empty()) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(part.min, part.max, true);
  list.AddRectFilled(part.min, part.max, color(context.ui.theme().panel));
  const Canvas canvas = canvas_of_pane(session, pane);
  Rect place = rect;
  show_picture(session, pane);
  if (canvas.is_known() && image_.width > 0) {
    const bool is_wipe = session.view.layout == app::Layout::Wipe;
    place = canvas_place(rect, canvas, app::canvas_of(session.view, is_wipe ? 1 : pane.number));
    list.AddImage(texture_id(texture_->name()), place.min, place.max);
    list.AddRect(place.min, place.max, color(context.ui.theme().line));
    draw_points(session, pane, place, context);
  }
  list.PopClipRect();
  draw_words(session, pane, place, part, context);
}

void FlatCanvas::show_picture(const Session& session, const PaneContent& pane) {
  const app::FlatResult* const result = result_of(session, pane);
  std::string wanted = key_of(pane.number, pane_frame(session, pane), session.view.reference,
                              session.flat.generation, reinterpret_cast<uintptr_t>(result));
  if (const app::TakeState* take = first_take(session, pane)) wanted += key_of(take->generation);
  if (dragged_) wanted += key_of(dragged_->first, dragged_->second);
  if (wanted == shown_ && texture_) return;
  shown_ = wanted;
  image_ = canvas_picture(session, pane, dragged_);
  if (image_.width == 0) return;
  if (!texture_) texture_.emplace();
  upload(*texture_, image_);
}

/// Handles where points can be dragged; otherwise only what is missing, hollow.
void FlatCanvas::draw_points(const Session& session, const PaneContent& pane, const Rect& place,
                             PanelContext& context) {
  const int frame = pane_frame(session, pane);
  const CleanPose* const clean = pane.source ? clean_at(session, frame) : nullptr;
  if (clean == nullptr) return;
  const Canvas canvas = canvas_of_pane(session, pane);
  const FlatPose* const seen = session.flat.poses->reading.performing().at(frame);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool drags = drags_points(session, pane);
  for (int point = 0; point < kBodyPoints; ++point) {
    if (!clean->pose.has(point)) continue;
    const bool is_dragged = dragged_ && dragged_->first == point;
    const ImVec2 at = on_screen(is_dragged ? dragged_->second : clean->pose.at(point), place, canvas);
    const bool is_made = seen == nullptr || !seen->has(point);
    const float opacity = clean->pose.confidence(point) < kWeak ? 0.45f : 0.95f;
    const ImU32 ink = color(ImVec4(1, 1, 1, 1), opacity);
    const float radius = context.ui.px(point == hovered_ ? 6.5f : 4);
    if (drags) {
      list.AddCircleFilled(at, radius, color(ImVec4(0, 0, 0, 1), is_made ? 0.25f : 0.6f));
      list.AddCircle(at, radius, ink, 0, context.ui.px(1.5f));
      const std::string name = kBodyPointNames[static_cast<size_t>(point)];
      context.ui.mark("view.0.point." + name, {{at.x - 2, at.y - 2}, {at.x + 2, at.y + 2}});
    } else if (is_made) {
      list.AddCircle(at, context.ui.px(5), ink, 0, context.ui.px(1.5f));
    }
  }
}

void FlatCanvas::draw_words(const Session& session, const PaneContent& pane, const Rect& place,
                            const Rect& part, PanelContext& context) {
  Overlay overlay;
  overlay.rect = part;
  overlay.title_right =
      session.view.layout == app::Layout::Wipe && part.min.x > place.min.x && pane.number == 2;
  overlay.title = pane_title(session, pane);
  overlay.hint = pane_hint(session, pane);
  const int frame = pane_frame(session, pane);
  if (overlay.hint.empty()) {
    overlay.subtitle = frame < 0 ? "the person, nothing to perform yet" : "frame " + std::to_string(frame);
    const app::Take* const take = pane.source ? nullptr : at_or_null(session.document.takes, pane.takes[0]);
    if (take != nullptr && take->flat) overlay.subtitle += " \u00b7 " + take->flat->engine;
    const CleanPose* const clean = clean_at(session, frame);
    if (clean != nullptr) overlay.warning = clean->problem;
  }
  overlay.active = session.view.layout == app::Layout::SideBySide && !session.takes.empty() &&
                   pane.number == session.view.active_pane;
  const auto& poses = session.flat.poses;
  if (pane.source && poses && frame >= 0 && poses->reading.tracks.size() > 1)
    for (const KeypointTrack& track : poses->reading.tracks)
      if (const FlatPose* pose = track.at(frame)) {
        const FlatBox box = box_of(*pose);
        if (box.isEmpty()) continue;
        const Vec2 top(box.center().x(), box.min().y());
        const std::string number = std::to_string(track.person);
        overlay.tags.push_back({on_screen(top, place, poses->reading.canvas), "Person " + number,
                                person_color(context.ui.theme(), static_cast<int>(track.person)),
                                track.person == poses->reading.performing().person,
                                "view.0.person." + number});
      }
  if (hovered_ >= 0) overlay.tip_at = ImGui::GetIO().MousePos, overlay.tip = point_words(hovered_);
  draw_overlay(context.ui, overlay);
}

}  // namespace understudy::ui
