#include "ui/panels/motion_map.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "app/run/step_index.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

constexpr size_t kMostSmallFigures = 60;
constexpr float kDotCell = 3, kFigureHeight = 46, kReach = 12;  // pixels at scale 1
constexpr float kPreviewHeight = 132, kTall_m = 1.85f;
constexpr float kMargin = 0.08f;  // about the map

/// Seen from their right side, a little from the front, as on the plots of the map.
ImVec2 seen(const Eigen::RowVector3f& joint, const FigureLook& look) {
  constexpr float kAside = 0.34f, kAlong = 0.94f;
  return {look.at.x + look.pixels_a_metre * (kAlong * joint.z() - kAside * joint.x()),
          look.at.y - look.pixels_a_metre * (joint.y() + 0.05f * joint.x())};
}

struct Bone {
  int from, to;
  float width;  // metres
};
constexpr Bone kMiddle[] = {{Pelvis, Spine3, 0.25f},
                            {Spine3, Neck, 0.19f},
                            {LeftHip, RightHip, 0.17f},
                            {LeftShoulder, RightShoulder, 0.12f},
                            {Neck, Head, 0.1f}};
constexpr Bone kLeft[] = {{LeftHip, LeftKnee, 0.14f},
                          {LeftKnee, LeftAnkle, 0.1f},
                          {LeftAnkle, LeftFoot, 0.08f},
                          {LeftShoulder, LeftElbow, 0.1f},
                          {LeftElbow, LeftWrist, 0.075f}};

void draw_bone(ImDrawList& list, const ImVec2& a, const ImVec2& b, float width, ImU32 color_of) {
  list.AddLine(a, b, color_of, std::max(1.0f, width));
  if (width < 2.5f) return;
  for (const ImVec2& end : {a, b}) list.AddCircleFilled(end, 0.5f * width, color_of, 10);
}

}  // namespace

void draw_figure(ImDrawList& list, const Joints& joints, const FigureLook& look) {
  const auto bone = [&](int from, int to, float width, const ImVec4& of) {
    draw_bone(list, seen(joints.row(from), look), seen(joints.row(to), look), width * look.pixels_a_metre,
              color(of));
  };
  for (const Bone& one : kLeft) bone(one.from, one.to, one.width, look.far_color);
  for (const Bone& one : kMiddle) bone(one.from, one.to, one.width, look.color);
  for (const Bone& one : kLeft)
    bone(kMirror[static_cast<size_t>(one.from)], kMirror[static_cast<size_t>(one.to)], one.width, look.color);
  const Eigen::RowVector3f up = joints.row(Head) - joints.row(Neck);
  list.AddCircleFilled(seen(joints.row(Head) + 0.35f * up, look), 0.11f * look.pixels_a_metre,
                       color(look.color), 16);
}

ImVec2 MapView::on_screen(const MapPlace& at, const Rect& place) const {
  const ImVec2 middle = place.at(0.5f, 0.5f);
  return {middle.x + zoom * (at.x() - centre.x()), middle.y - zoom * (at.y() - centre.y())};
}

MapPlace MapView::on_map(const ImVec2& at, const Rect& place) const {
  const ImVec2 middle = place.at(0.5f, 0.5f);
  return centre + MapPlace(at.x - middle.x, middle.y - at.y) / zoom;
}

void MapView::fit(const MotionMap& map, const Rect& place) {
  MapPlace low = map.place(0), high = low;
  for (int i = 1; i < map.size(); ++i) low = low.cwiseMin(map.place(i)), high = high.cwiseMax(map.place(i));
  centre = 0.5f * (low + high);
  const MapPlace span = (high - low).cwiseMax(1e-6f);
  const float share = 1 - 2 * kMargin;
  zoom = least_zoom = std::min(share * place.width() / span.x(), share * place.height() / span.y());
}

void MapView::thin(const MotionMap& map, const Rect& place, float figure_height) {
  dots.clear(), figures.clear();
  std::unordered_set<int64_t> taken;
  const float cell = figure_height * kDotCell / kFigureHeight;
  for (int i = 0; i < map.size(); ++i) {
    const ImVec2 at = on_screen(map.place(i), place);
    if (!place.contains(at)) continue;
    const auto column = static_cast<int64_t>((at.x - place.min.x) / cell);
    const auto line = static_cast<int64_t>((at.y - place.min.y) / cell);
    if (taken.insert((line << 32) + column).second) dots.push_back(i);
  }
  std::vector<int> order = dots;  // so that no part of the map comes first
  Rng rng(1);
  for (int i = static_cast<int>(ssize(order)) - 1; i > 0; --i)
    std::swap(order[static_cast<size_t>(i)], order[static_cast<size_t>(rng.below(i + 1))]);
  std::vector<ImVec2> places;
  for (size_t k = 0; k < order.size() && figures.size() < kMostSmallFigures; ++k) {
    const ImVec2 at = on_screen(map.place(order[k]), place);
    const auto meets = [&](const ImVec2& other) {
      return std::abs(other.x - at.x) < 0.72f * figure_height &&
             std::abs(other.y - at.y) < 1.06f * figure_height;
    };
    const bool inside =
        at.x > place.min.x + 0.3f * figure_height && at.x < place.max.x - 0.3f * figure_height &&
        at.y > place.min.y + 0.5f * figure_height && at.y < place.max.y - 0.5f * figure_height;
    if (!inside || std::any_of(places.begin(), places.end(), meets)) continue;
    places.push_back(at);
    figures.push_back(order[k]);
  }
}

int MapView::step_at(const MotionMap& map, const ImVec2& at, const Rect& place, float within) const {
  const MapPlace there = on_map(at, place);
  float least = within / zoom * (within / zoom);
  int nearest = -1;
  for (int i = 0; i < map.size(); ++i) {
    const float away = (map.place(i) - there).squaredNorm();
    if (away < least) least = away, nearest = i;
  }
  return nearest;
}

namespace {

/// One drawing of the panel.
struct MapDrawing {
  const app::Session& session;
  PanelContext& context;
  MotionMapState& state;
  const MotionMap& map() const { return *session.map.map; }
  Ui& ui() const { return context.ui; }

  ImVec4 scale_color(float share) const { return mix(ui().theme().series[0], ui().theme().series[1], share); }
  ImVec4 group_color(int group) const {
    return group < 0 ? ui().theme().text_dim : ui().theme().series[static_cast<size_t>(group)];
  }
  ImVec4 color_of(int step) const {
    const MapColouring& colouring = *session.map.colouring;
    return colouring.groups.empty() ? scale_color(colouring.value[static_cast<size_t>(step)])
                                    : group_color(colouring.group[static_cast<size_t>(step)]);
  }
};

void draw_dots(const MapDrawing& d, ImDrawList& list) {
  const float half = d.ui().px(1.5f);
  for (const int i : d.state.view.dots) {
    const ImVec2 at = d.state.view.on_screen(d.map().place(i), d.state.place);
    list.AddRectFilled({at.x - half, at.y - half}, {at.x + half, at.y + half},
                       color(mix(d.ui().theme().backdrop, d.color_of(i), 0.75f)), half);
  }
}

/// Each in the middle of its step, its beginning behind it.
void draw_small_figures(const MapDrawing& d, ImDrawList& list) {
  const float height = d.ui().px(kFigureHeight), metre = height / kTall_m;
  for (const int i : d.state.view.figures) {
    const MappedStep& step = d.map().step(i);
    const ImVec2 at = d.state.view.on_screen(d.map().place(i), d.state.place);
    const ImVec4 of = d.color_of(i), paper = d.ui().theme().backdrop;
    const auto ghost = [&](float share, float aside, float strength) {
      FigureLook look{{at.x + aside, at.y + 0.5f * height},
                      metre,
                      mix(paper, of, strength),
                      mix(paper, of, 0.55f * strength)};
      draw_figure(list, figure_at(step, d.map().motion_of(i).rest, share * step.seconds, /*in_place=*/true),
                  look);
    };
    ghost(0.1f, -0.22f * height, 0.28f);
    ghost(0.6f, 0, 0.9f);
    d.ui().mark("map.step." + std::to_string(i), {{at.x - 1, at.y - 1}, {at.x + 1, at.y + 1}});
  }
}

void draw_map_marks(const MapDrawing& d, ImDrawList& list) {
  const auto at = [&](int step) { return d.state.view.on_screen(d.map().place(step), d.state.place); };
  const ImU32 ink = color(d.ui().theme().text), accent = color(d.ui().theme().accent);
  const app::SourceOptions& source = d.session.document.source;
  if (!source.path.empty() && !source.blend)
    for (const int i : d.state.view.dots)
      if (d.map().motion_of(i).path == source.path)
        list.AddCircle(at(i), d.ui().px(3.5f), ink, 12, d.ui().px(1));
  for (const NearStep& near : d.session.map.like)
    list.AddCircle(at(near.step), d.ui().px(6), accent, 16, d.ui().px(2));
  if (d.session.map.decoded) {
    const ImVec2 cross = d.state.view.on_screen(d.session.map.decoded->place, d.state.place);
    const float arm = d.ui().px(6);
    list.AddLine({cross.x - arm, cross.y}, {cross.x + arm, cross.y}, ink, d.ui().px(2));
    list.AddLine({cross.x, cross.y - arm}, {cross.x, cross.y + arm}, ink, d.ui().px(2));
  }
  if (d.state.hovered >= 0) list.AddCircle(at(d.state.hovered), d.ui().px(8), ink, 20, d.ui().px(2));
}

/// Dragging moves the map, the wheel makes it larger; what is drawn then is another.
void move_map(MapDrawing& d, bool hovered, bool held) {
  MapView& view = d.state.view;
  const ImGuiIO& io = ImGui::GetIO();
  if (hovered) ImGui::SetItemUsingMouseWheel();
  if (hovered && io.MouseWheel != 0) {
    const MapPlace under = view.on_map(io.MousePos, d.state.place);
    view.zoom =
        std::clamp(view.zoom * std::pow(1.25f, io.MouseWheel), view.least_zoom, 200 * view.least_zoom);
    view.centre += under - view.on_map(io.MousePos, d.state.place);
    d.state.stale = true;
  }
  if (held && ImGui::IsMouseDragging(ImGuiMouseButton_Left, d.ui().px(4)) &&
      (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    view.centre += MapPlace(-io.MouseDelta.x, io.MouseDelta.y) / view.zoom;
    d.state.stale = true;
  }
}

/// What is told of a place: the step there, or what lies between.
void click_map(MapDrawing& d) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (d.state.hovered >= 0) return d.context.ask("map.take", {std::to_string(d.state.hovered)});
  const MapPlace place = d.state.view.on_map(at, d.state.place);
  d.context.ask("map.decode",
                {argument(static_cast<double>(place.x())), argument(static_cast<double>(place.y()))});
}

void draw_canvas(MapDrawing& d) {
  Ui& ui = d.ui();
  const float width = std::max(1.0f, ImGui::GetContentRegionAvail().x);
  const float height =
      std::clamp(width, ui.px(120), std::max(ui.px(120), ImGui::GetIO().DisplaySize.y * 0.5f));
  const bool clicked = ImGui::InvisibleButton("map.canvas", {width, height});
  ui.mark("map.canvas");
  MotionMapState& state = d.state;
  const Rect place{ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
  const bool other_map = state.map != d.session.map.map;
  const bool other_size = place.width() != state.place.width() || place.height() != state.place.height();
  if (other_map || other_size || state.scale != ui.scale())
    state.view.fit(d.map(), place), state.stale = true;
  state.map = d.session.map.map, state.scale = ui.scale();
  state.place = place;
  const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive();
  move_map(d, hovered, held);
  if (std::exchange(state.stale, false)) state.view.thin(d.map(), place, ui.px(kFigureHeight));
  const int before = state.hovered;
  state.hovered = hovered ? state.view.step_at(d.map(), ImGui::GetIO().MousePos, place, ui.px(kReach)) : -1;
  state.performed = state.hovered == before ? state.performed + ImGui::GetIO().DeltaTime : 0;
  if (state.hovered >= 0 && state.hovered != before)
    d.context.ask("map.perform", {std::to_string(state.hovered)});
  if (state.hovered < 0 && before >= 0) d.context.ask("map.perform");
  const float dragged = ImGui::GetIO().MouseDragMaxDistanceSqr[ImGuiMouseButton_Left];
  if (clicked && dragged < ui.px(4) * ui.px(4)) click_map(d);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(place.min, place.max, true);
  list.AddRectFilled(place.min, place.max, color(ui.theme().backdrop), ui.px(4));
  draw_dots(d, list);
  draw_small_figures(d, list);
  draw_map_marks(d, list);
  list.PopClipRect();
}

void draw_map_legend(const MapDrawing& d) {
  Ui& ui = d.ui();
  const MapColouring& colouring = *d.session.map.colouring;
  const FontScope small(ui.fonts().small);
  if (colouring.groups.empty()) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const std::string low = short_number(static_cast<double>(colouring.low)),
                      high = short_number(static_cast<double>(colouring.high)) + " " + colouring.unit;
    const float left = at.x + ImGui::CalcTextSize(low.c_str()).x + ui.px(6),
                line = ImGui::GetTextLineHeight();
    const ImU32 from = color(d.scale_color(0)), to = color(d.scale_color(1));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddText(at, color(ui.theme().text_dim), low.c_str());
    list.AddRectFilledMultiColor({left, at.y + 0.25f * line}, {left + ui.px(90), at.y + 0.75f * line}, from,
                                 to, to, from);
    list.AddText({left + ui.px(96), at.y}, color(ui.theme().text_dim), high.c_str());
    return ImGui::Dummy({1, line});
  }
  const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
  for (size_t g = 0; g < colouring.groups.size(); ++g) {
    const std::string name = cut_name(colouring.groups[g], ui.px(130));
    if (g > 0) ImGui::SameLine(0, ui.px(12));
    if (g > 0 && ImGui::GetCursorScreenPos().x + ImGui::CalcTextSize(name.c_str()).x + ui.px(22) > right)
      ImGui::NewLine();
    color_chip(ui, d.group_color(static_cast<int>(g)));
    ImGui::TextUnformatted(name.c_str());
  }
}

/// The step under the pointer performs; marks on the floor pass by as fast as it goes.
void draw_performer(const MapDrawing& d, const Rect& box) {
  Ui& ui = d.ui();
  const MappedStep& step = d.map().step(d.state.hovered);
  const float metre = (box.height() - ui.px(22)) / kTall_m, floor = box.max.y - ui.px(12);
  const ImVec2 at(box.min.x + 0.5f * box.height(), floor);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(box.min, {box.min.x + box.height(), box.max.y}, true);
  constexpr float kApart = 0.5f;  // metres
  const float gone = step.speed_m_s * d.state.performed, offset = kApart - std::fmod(gone, kApart);
  for (int k = -4; k < 4; ++k) {
    const float x = at.x + metre * (static_cast<float>(k) * kApart + offset);
    list.AddLine({x, floor + ui.px(2)}, {x - ui.px(4), floor + ui.px(7)}, color(ui.theme().line), ui.px(2));
  }
  list.AddLine({box.min.x, floor + ui.px(2)}, {box.min.x + box.height(), floor + ui.px(2)},
               color(ui.theme().line), ui.px(1));
  const ImVec4 of = d.color_of(d.state.hovered);
  const Joints& rest = d.map().motion_of(d.state.hovered).rest;
  draw_figure(list, figure_at(step, rest, d.state.performed, /*in_place=*/true),
              {at, metre, of, mix(ui.theme().backdrop, of, 0.55f)});
  list.PopClipRect();
  ui.keep_moving();
}

std::vector<std::string> step_lines(const MotionMap& map, int i) {
  const MappedMotion& motion = map.motion_of(i);
  const MappedStep& step = map.step(i);
  return {
      motion.name, motion.action,
      "frames " + std::to_string(step.first) + "\u2013" + std::to_string(step.last),
      printed("%.2f s, %.2f m/s", static_cast<double>(step.seconds), static_cast<double>(step.speed_m_s))};
}

void draw_preview(const MapDrawing& d) {
  Ui& ui = d.ui();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const Rect box{at, {at.x + std::max(1.0f, ImGui::GetContentRegionAvail().x), at.y + ui.px(kPreviewHeight)}};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(box.min, box.max, color(ui.theme().backdrop), ui.px(4));
  ImGui::Dummy({box.width(), box.height()});
  ui.mark("map.preview");
  const app::MapState& map = d.session.map;
  const bool shows = d.state.hovered >= 0;
  if (shows) draw_performer(d, box);
  const float left = box.min.x + (shows ? box.height() : ui.px(10)), room = box.max.x - left - ui.px(8);
  float y = box.min.y + ui.px(8);
  const auto write = [&](const std::string& text, const ImVec4& of) {
    list.AddText({left, y}, color(of), cut_name(text, room).c_str());
    y += ImGui::GetTextLineHeightWithSpacing();
  };
  if (shows) {
    bool first = true;
    for (const std::string& line : step_lines(d.map(), d.state.hovered))
      write(line, std::exchange(first, false) ? ui.theme().text : ui.theme().text_dim);
    if (map.shown == MapOf::Steps)
      write(d.map().step(d.state.hovered).left_first ? "left foot first" : "right foot first",
            ui.theme().text_dim);
    return;
  }
  std::string words =
      "Rest the pointer on a figure: the targets perform it. A click takes it, a click between figures takes "
      "what lies between; the wheel zooms, dragging moves.";
  if (map.decoded)
    words = "The place that was taken is " + distance_words(map.decoded->blend.known.distance) + ".";
  for (const std::string& line : split(in_lines(words, room), '\n')) write(line, ui.theme().text_dim);
}

void draw_alike(const MapDrawing& d) {
  Ui& ui = d.ui();
  const app::Playback& playback = d.session.playback;
  const bool marked = playback.in >= 0 && playback.out > playback.in;
  ask_button(d.context,
             {"map.like_this", "Like the marked frames",
              marked ? "Lists the steps of the map that are most like those between the loop marks"
                     : "Mark frames of the source with I and O first",
              "map.like " + std::to_string(playback.in) + " " + std::to_string(playback.out)},
             marked);
  const app::MapState& map = d.session.map;
  if (map.like_what.empty()) return;
  hint(ui, "Most like " + map.like_what + ", nearest first; 1 is as far as neighbours are:");
  std::vector<ListItem> items;
  for (const NearStep& near : map.like)
    items.push_back(
        {app::step_words(d.map(), near.step), printed("%.2f", static_cast<double>(near.distance))});
  const int chosen = searchable_list(ui, "map.like", items, -1, ui.px(150));
  if (chosen >= 0) d.context.ask("map.take", {std::to_string(map.like[static_cast<size_t>(chosen)].step)});
}

}  // namespace

void draw_motion_map(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  ask_button(context,
             {"map.index", "Read a folder of motions\u2026",
              "Finds the steps and other movements of all skeletal motions in a folder, and of the open one",
              "dialog.open map_folder"});
  const app::MapState& map = session.map;
  const bool reads = std::any_of(session.jobs.begin(), session.jobs.end(),
                                 [&](const app::JobView& job) { return job.id == map.job && map.job != 0; });
  if (reads) hint(ui, "Motions are being read\u2026");
  if (!map.any_of_both()) {
    if (!reads)
      hint(ui, map.words.empty()
                   ? "Shows the steps of many motions at once: what is alike lies near to each other."
                   : "Nobody moves in these motions for a second: " + map.words);
    return;
  }
  hint(ui, map.words);
  ask_choice(context, {"map.show", "Shows", "What is on the map: steps, or movements that are no steps"},
             {"Steps", "Other movements"}, {kMapOfNames.begin(), kMapOfNames.end()},
             kMapOfNames[static_cast<size_t>(map.shown)]);
  if (!map.any())
    return hint(ui, map.shown == MapOf::Steps ? "Nobody steps in these motions."
                                              : "There is nothing but steps in these motions.");
  ask_choice(context, {"map.color", "Colour", "What the colours tell"},
             {"Action", "Speed", "Duration", "File"}, {kMapColourNames.begin(), kMapColourNames.end()},
             kMapColourNames[static_cast<size_t>(map.colour)]);
  MapDrawing drawing{session, context, panel_state<MotionMapState>(context)};
  draw_canvas(drawing);
  draw_map_legend(drawing);
  draw_preview(drawing);
  draw_alike(drawing);
}

}  // namespace understudy::ui
