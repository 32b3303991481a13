#include "ui/viewport/view_cube.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "app/session/view.hpp"

namespace understudy::ui {
namespace {

constexpr int kFaces = 6;                                       // the first of app::kViewPresets
constexpr float kCubeSide = 84, kCubeAway = 8;                  // points, of the corner it takes
constexpr float kLeastViewWidth = 240, kLeastViewHeight = 190;  // points
constexpr float kLargestShare = 0.28f;                  // of a view, where text is large in a small window
constexpr float kHalfEdge = 0.285f;                     // of the corner's side
constexpr float kLeastSeen = 0.02f, kReadable = 0.45f;  // of a face turned to the viewer

/// A face as it is seen: flat, from afar.
struct SeenFace {
  std::array<ImVec2, 4> corners;
  ImVec2 middle;
  float towards = 0;  ///< cosine to the viewer
};

/// From the cube's middle, in the world.
Vec3 normal_of(const app::ViewPreset& face) {
  const float yaw = face.yaw_deg * kPi / 180, pitch = face.pitch_deg * kPi / 180;
  return {std::round(std::sin(yaw) * std::cos(pitch)), std::round(std::sin(pitch)),
          std::round(std::cos(yaw) * std::cos(pitch))};
}

SeenFace seen_face(const app::ViewPreset& face, const Rect& place, const render::Camera& camera) {
  const Vec3 out = normal_of(face);
  const Mat3 axes = render::axes(camera);
  const float half = kHalfEdge * place.width();
  const Vec3 u = std::abs(out.y()) > 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0), v = out.cross(u);
  const auto project = [&](const Vec3& point) {
    const Vec3 seen = half * (axes.transpose() * point);
    const ImVec2 centre = place.at(0.5f, 0.5f);
    return ImVec2(centre.x + seen.x(), centre.y - seen.y());
  };
  SeenFace seen;
  seen.corners = {project(out + u + v), project(out + u - v), project(out - u - v), project(out - u + v)};
  seen.middle = project(out);
  seen.towards = out.dot(axes.col(2));
  return seen;
}

/// In pixels, of what lies level in it.
float width_of(const SeenFace& face) {
  const auto between = [&](size_t a, size_t b) {  // the middles of two opposite edges
    return std::abs(face.corners[a].x + face.corners[a + 1].x - face.corners[b].x -
                    face.corners[(b + 1) % 4].x) /
           2;
  };
  return std::max(between(0, 2), between(1, 3));
}

bool contains(const SeenFace& face, const ImVec2& at) {
  bool left = false, right = false;
  for (size_t i = 0; i < 4; ++i) {
    const ImVec2 &a = face.corners[i], &b = face.corners[(i + 1) % 4];
    const float side = (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
    left |= side<0, right |= side> 0;
  }
  return left != right;
}

}  // namespace

std::optional<Rect> cube_place(const Ui& ui, const Rect& view) {
  if (view.width() < ui.px(kLeastViewWidth) || view.height() < ui.px(kLeastViewHeight)) return std::nullopt;
  const float most = kLargestShare * std::min(view.width(), view.height());
  const float side = std::round(std::min(ui.px(kCubeSide), most)), away = std::round(ui.px(kCubeAway));
  const ImVec2 corner(view.max.x - away, view.min.y + away);
  return Rect{{corner.x - side, corner.y}, {corner.x, corner.y + side}};
}

int cube_face_at(const Rect& place, const render::Camera& camera, const ImVec2& at) {
  for (int i = 0; i < kFaces; ++i) {
    const SeenFace seen = seen_face(app::kViewPresets[i], place, camera);
    if (seen.towards > kLeastSeen && contains(seen, at)) return i;
  }
  return -1;
}

void draw_cube(Ui& ui, const std::string& name, const Rect& place, const render::Camera& camera,
               int hovered) {
  const Theme& t = ui.theme();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const FontScope small(ui.fonts().small);
  ui.mark(name, place);
  ui.explain({place, "View cube",
              "Shows where the view looks from. Click a face to look from there, drag to turn."});
  for (int i = 0; i < kFaces; ++i) {
    const SeenFace seen = seen_face(app::kViewPresets[i], place, camera);
    if (seen.towards <= kLeastSeen) continue;
    const bool lit = i == hovered;
    const ImVec4 fill = lit ? t.accent : mix(t.field_hover, t.raised, 1 - seen.towards);
    list.AddConvexPolyFilled(seen.corners.data(), 4, color(fill, lit ? 0.95f : 0.85f));
    list.AddPolyline(seen.corners.data(), 4, color(t.text_dim, 0.8f), ImDrawFlags_Closed, ui.px(1));
    const float reach = ui.px(4);
    ui.mark(name + "." + app::kViewPresets[i].name,
            {{seen.middle.x - reach, seen.middle.y - reach}, {seen.middle.x + reach, seen.middle.y + reach}});
    const char* const label = app::kViewPresets[i].label;
    const ImVec2 size = ImGui::CalcTextSize(label);
    if (seen.towards < kReadable || size.x > width_of(seen)) continue;
    list.AddText({std::round(seen.middle.x - size.x / 2), std::round(seen.middle.y - size.y / 2)},
                 color(lit ? t.on_accent : t.text), label);
  }
}

}  // namespace understudy::ui
