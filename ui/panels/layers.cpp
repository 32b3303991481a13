// What the views show: layers and colours of the source and the takes, cameras.
// Marks, P being source or take: layers.P.surface, .as_points, .skeleton, .x_ray, .joint_names, .ground,
// .trails, .ghosts, .colour; layers.weights_joint, layers.trail_joint, layers.trail.JOINT,
// layers.ghost_count, layers.ghost_step, layers.error_scale; layers.preset.NAME, layers.fit, layers.ortho,
// layers.linked, layers.follow, layers.turntable. Sections: layers.source, layers.take, layers.colours,
// layers.camera.
#include <algorithm>
#include <cmath>

#include "ui/panels/bindings.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

using app::Colouring;

struct Layer {
  const char* name;
  const char* label;
  const char* explanation;
  bool app::Layers::*on;
};

constexpr Layer kLayers[] = {
    {"skeleton", "Skeleton", "The extracted joints, or those of the target", &app::Layers::skeleton},
    {"x_ray", "X-ray", "Shows the skeleton through the surface", &app::Layers::x_ray},
    {"joint_names", "Names", "Names all joints; the joint under the mouse always shows its name",
     &app::Layers::joint_names},
    {"ground", "Ground", "The grid on the floor, with a soft shadow", &app::Layers::ground},
    {"trails", "Trails", "The paths of the joints chosen below", &app::Layers::trails},
    {"ghosts", "Ghosts", "Past and coming frames, faint", &app::Layers::ghosts}};

struct Colour {
  Colouring colouring;
  const char* argument;
  const char* label;
};
constexpr Colour kSourceColours[] = {{Colouring::Plain, "plain", "Plain"},
                                     {Colouring::Confidence, "confidence", "Confidence"}};
constexpr Colour kTakeColours[] = {{Colouring::Plain, "plain", "Plain"},
                                   {Colouring::Weights, "weights", "Skin weights"},
                                   {Colouring::Doubt, "doubt", "Binding uncertainty, %"},
                                   {Colouring::Offsets, "offsets", "Corrective offsets, mm"},
                                   {Colouring::Error, "error", "Error to the truth, mm"},
                                   {Colouring::Difference, "difference", "Difference to take 1, mm"}};

std::vector<std::string> joints_and_all() {
  std::vector<std::string> names = {"All joints"};
  for (int j = 0; j < kJointCount; ++j) names.push_back(joint_label(j));
  return names;
}

template <size_t N>
void draw_colour(PanelContext& context, const std::string& pane, const Colour (&colours)[N], Colouring now) {
  std::vector<std::string> labels;
  int chosen = -1;
  for (size_t i = 0; i < N; ++i) {
    labels.push_back(colours[i].label);
    if (colours[i].colouring == now) chosen = i;
  }
  row(context.ui, "Colour", "What the surface's colour shows");
  if (dropdown(context.ui, "layers." + pane + ".colour", labels, chosen))
    context.ask("view.colour", {pane, colours[chosen].argument});
}

/// Switches in two columns.
class SwitchGrid {
 public:
  explicit SwitchGrid(PanelContext& context)
      : context_(context), start_(ImGui::GetCursorPosX()), half_(ImGui::GetContentRegionAvail().x / 2) {}
  std::optional<bool> add(const std::string& name, const char* label, const char* explanation, bool on) {
    if (count_++ % 2 == 1) ImGui::SameLine(start_ + half_);
    const bool changed = toggle(context_.ui, name, label, on);
    tooltip(context_.ui, explanation);
    return changed ? std::optional<bool>(on) : std::nullopt;
  }

 private:
  PanelContext& context_;
  float start_, half_;
  int count_ = 0;
};

void draw_pane(const app::Session& session, PanelContext& context, bool source) {
  const app::Layers& layers = source ? session.view.source : session.view.take;
  const std::string pane = source ? "source" : "take";
  if (!section(context.ui, "layers." + pane, source ? "Source" : "Takes")) return;
  SwitchGrid grid(context);
  const auto add = [&](const char* name, const char* label, const char* explanation, bool on) {
    if (const auto wanted = grid.add("layers." + pane + "." + name, label, explanation, on))
      context.ask("view.layer", {pane, name, on_off(*wanted)});
  };
  add("surface", source ? "Scan" : "Mesh", source ? "The scan of this frame" : "The target's surface",
      layers.surface);
  if (source && session.source.has_faces)
    add("as_points", "As points", "Shows the scan's points without its faces", layers.as_points);
  for (const Layer& layer : kLayers) add(layer.name, layer.label, layer.explanation, layers.*layer.on);
  if (source)
    draw_colour(context, pane, kSourceColours, layers.colouring);
  else
    draw_colour(context, pane, kTakeColours, layers.colouring);
}

void draw_trails(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  std::vector<std::string> names;
  for (int j = 0; j < kJointCount; ++j) names.push_back(joint_label(j));
  row(ui, "Trail of", "Adds or removes the path of a joint");
  int chosen = -1;
  const auto& joints = session.view.trail_joints;
  const auto is_on = [&](int j) { return std::find(joints.begin(), joints.end(), j) != joints.end(); };
  if (dropdown(ui, "layers.trail_joint", names, chosen))
    context.ask("view.trail_joint", {joint_name(chosen), on_off(!is_on(chosen))});
  for (const int j : joints) {
    if (j < 0 || j >= kJointCount) continue;
    row(ui, "");
    ButtonOptions options;
    options.look = ButtonLook::Quiet, options.tooltip = "Removes this trail";
    if (button(ui, "layers.trail." + joint_name(j), joint_label(j) + "  \u00d7", options))
      context.ask("view.trail_joint", {joint_name(j), "off"});
  }
}

void draw_colours(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "layers.colours", "Weights, trails, ghosts")) return;
  row(ui, "Weights of", "All joints: one colour each; one joint: its weight from 0 to 1");
  int joint = session.view.weights_joint + 1;
  if (dropdown(ui, "layers.weights_joint", joints_and_all(), joint))
    context.ask("view.weights_joint", {joint_name(joint - 1)});
  draw_trails(session, context);
  NumberOptions count{1, 12, 0.05f, "%.0f"}, step{1, 120, 0.2f, "%.0f frames"};
  const int ghosts = session.view.ghost_count, apart = session.view.ghost_step;
  const auto ghost = [&](float n, float every) {
    context.ask("view.ghosts", {argument(std::round(n)), argument(std::round(every))});
  };
  if (const auto n = number_row(ui, {"layers.ghost_count", "Ghosts", "To each side of this frame"},
                                static_cast<float>(ghosts), count))
    ghost(*n, static_cast<float>(apart));
  if (const auto every = number_row(ui, {"layers.ghost_step", "Apart", "Frames between two ghosts"},
                                    static_cast<float>(apart), step))
    ghost(static_cast<float>(ghosts), *every);
  NumberOptions scale{1, 1000, 0.5f, "%.0f mm", 50, true};
  if (const auto mm = number_row(ui, {"layers.error_scale", "Scale to", "Upper end of the error scales"},
                                 session.view.error_scale_mm, scale))
    context.ask("view.error_scale", {argument(*mm)});
}

void draw_presets(PanelContext& context) {
  constexpr const char* kNames[] = {"front", "right", "top", "back", "left", "three-quarter"};
  constexpr const char* kLabels[] = {"Front", "Right", "Top", "Back", "Left", "3/4"};
  for (int line = 0; line < 2; ++line) {
    ButtonRow buttons(3);
    for (int i = 3 * line; i < 3 * line + 3; ++i) {
      ButtonOptions options;
      options.shortcut = keys_of(context.commands, "view.preset", {kNames[i]});
      if (buttons.add(context.ui, std::string("layers.preset.") + kNames[i], kLabels[i], options))
        context.ask("view.preset", {kNames[i]});
    }
  }
}

void draw_camera(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "layers.camera", "Camera")) return;
  draw_presets(context);
  ButtonOptions fit;
  fit.shortcut = keys_of(context.commands, "view.fit"), fit.width = -1;
  if (button(ui, "layers.fit", "Fit", fit)) context.ask("view.fit");
  const bool ortho = !session.view.cameras.empty() && session.view.cameras.front().orthographic;
  SwitchGrid grid(context);
  if (const auto on = grid.add("layers.ortho", "Orthographic", "Turns perspective off", ortho))
    context.ask("view.ortho", {on_off(*on)});
  if (const auto on =
          grid.add("layers.linked", "Linked", "Uses one camera for all views", session.view.linked))
    context.ask("view.link", {on_off(*on)});
  if (const auto on =
          grid.add("layers.follow", "Follow", "Moves the camera with the person", session.view.follow))
    context.ask("view.follow", {on_off(*on)});
  NumberOptions speed{-180, 180, 0.5f, "%.0f\u00b0/s", 0, true};
  if (const auto deg = number_row(ui, {"layers.turntable", "Turntable", "Turns the camera on its own"},
                                  session.view.turntable_deg_s, speed))
    context.ask("view.turntable", {argument(*deg)});
}

}  // namespace

void draw_layers(const app::Session& session, PanelContext& context) {
  const DisabledScope disabled(!has_document(session));
  draw_pane(session, context, true);
  draw_pane(session, context, false);
  draw_colours(session, context);
  draw_camera(session, context);
}

}  // namespace understudy::ui
