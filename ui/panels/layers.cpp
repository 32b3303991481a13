// What the views show: layers and colours of the source and the takes, cameras.
// Marks, P being source or take: layers.P.surface, .as_points, .skeleton, .x_ray, .joint_names, .ground,
// .trails, .ghosts, .wireframe, .scene, .bones, .colour; layers.opacity.scan, .skeletons, .results,
// layers.spread; layers.light.turn, .height, .brightness, layers.background, layers.background_colour;
// layers.weights_joint, layers.trail_joint, layers.trail.JOINT, layers.ghost_count, layers.ghost_step,
// layers.ghosts_by_time, layers.error_scale; layers.preset.NAME, layers.fit, layers.ortho, layers.linked,
// layers.follow, layers.turntable. Sections: layers.source, layers.take, layers.overlay (in that layout),
// layers.colours, layers.camera, layers.light_and_background.
#include <algorithm>
#include <cmath>

#include "ui/panels/layers.hpp"

#include "ui/panels/bindings.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

using app::Colouring;

struct Colour {
  Colouring colouring;
  const char* label;
};
const std::vector<Colour> kSourceColours = {{Colouring::Plain, "Plain"},
                                            {Colouring::Confidence, "Confidence"}};
const std::vector<Colour> kTakeColours = {{Colouring::Plain, "Plain"},
                                          {Colouring::Weights, "Skin weights"},
                                          {Colouring::Uncertainty, "Binding uncertainty, %"},
                                          {Colouring::Offsets, "Corrective offsets, mm"},
                                          {Colouring::Error, "Error against ground truth, mm"},
                                          {Colouring::Difference, "Difference from take 1, mm"}};

void draw_colour(PanelContext& context, const std::string& pane, const std::vector<Colour>& colours,
                 Colouring now) {
  std::vector<std::string> labels;
  int chosen = -1;
  for (const Colour& colour : colours) {
    if (colour.colouring == now) chosen = labels.size();
    labels.push_back(colour.label);
  }
  row(context.ui, "Colour", "What the surface's colour shows");
  if (dropdown(context.ui, "layers." + pane + ".colour", labels, chosen))
    context.ask("view.colour", {pane, app::kColouringNames[static_cast<size_t>(colours[chosen].colouring)]});
}

/// Switches in two columns.
class SwitchGrid {
 public:
  explicit SwitchGrid(PanelContext& context)
      : context_(context), start_(ImGui::GetCursorPosX()), half_(ImGui::GetContentRegionAvail().x / 2) {}
  void add(const Control& control, bool on) {
    if (count_++ % 2 == 1) ImGui::SameLine(start_ + half_);
    const bool changed = toggle(context_.ui, control.name, control.label, on);
    tooltip(context_.ui, control.explanation);
    if (changed) push(context_, control, on_off(on));
  }

 private:
  PanelContext& context_;
  float start_, half_;
  int count_ = 0;
};

void draw_pane(const app::Session& session, PanelContext& context, bool source) {
  const std::string pane = source ? "source" : "take";
  if (!section(context.ui, "layers." + pane, source ? "Source" : "Takes")) return;
  SwitchGrid grid(context);
  for (const LayerSwitch& layer : layer_switches(session, source))
    grid.add({"layers." + pane + "." + layer.name, layer.label, layer.explanation,
              "view.layer " + pane + " " + layer.name},
             layer.on);
  draw_colour(context, pane, source ? kSourceColours : kTakeColours,
              (source ? session.view.source : session.view.take).colouring);
}

void draw_overlay_rows(const app::Session& session, PanelContext& context) {
  if (session.view.layout != app::Layout::Overlay) return;
  if (!section(context.ui, "layers.overlay", "Overlay")) return;
  const app::OverlayLook& look = session.view.overlay;
  const app::OverlayLook usual;
  const auto opacity = [&](const char* layer, const char* label, float now, float at_first) {
    const std::string name = layer;
    ask_number(context, {"layers.opacity." + name, label, "Opacity: 0 hides it", "view.opacity " + name}, now,
               {0, 1, 0.005f, "%.2f", at_first, true});
  };
  opacity("scan", "Scan", look.scan, usual.scan);
  opacity("skeletons", "Skeletons", look.skeletons, usual.skeletons);
  opacity("results", "Results", look.results, usual.results);
  ask_number(
      context,
      {"layers.spread", "Spread", "How far apart the people stand; 0 puts them in one place", "view.spread"},
      look.spread_m, {0, 10, 0.01f, "%.2f m", 0, true});
}

void draw_trails(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  row(ui, "Trail of", "Adds or removes the path of a joint");
  int chosen = -1;
  const auto& joints = session.view.trail_joints;
  const auto is_on = [&](int j) { return std::find(joints.begin(), joints.end(), j) != joints.end(); };
  if (dropdown(ui, "layers.trail_joint", joint_labels(), chosen))
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
  std::vector<std::string> joints = joint_labels();
  joints.insert(joints.begin(), "All joints");
  if (dropdown(ui, "layers.weights_joint", joints, joint))
    context.ask("view.weights_joint", {joint_name(joint - 1)});
  draw_trails(session, context);
  float count = static_cast<float>(session.view.ghost_count),
        step = static_cast<float>(session.view.ghost_step);
  row(ui, "Ghosts", "To each side of this frame");
  bool changed = number(ui, "layers.ghost_count", count, {1, 12, 0.05f, "%.0f"});
  row(ui, "Apart", "Frames between two ghosts");
  changed |= number(ui, "layers.ghost_step", step, {1, 120, 0.2f, "%.0f frames"});
  if (changed) context.ask("view.ghosts", {argument(std::round(count)), argument(std::round(step))});
  ask_toggle(context,
             {"layers.ghosts_by_time", "Ghosts by time",
              "Colours them from blue, the first, to red, the last", "view.ghosts_by_time"},
             session.view.ghosts_by_time);
  ask_number(context, {"layers.error_scale", "Scale to", "Upper end of the error scales", "view.error_scale"},
             session.view.error_scale_mm, {1, 1000, 0.5f, "%.0f mm", 50, true});
}

void draw_presets(PanelContext& context) {
  const size_t count = std::size(app::kViewPresets), in_a_row = (count + 1) / 2;
  ButtonRow first(in_a_row), second(count - in_a_row);
  for (size_t i = 0; i < count; ++i) {
    const app::ViewPreset& preset = app::kViewPresets[i];
    ButtonOptions options;
    options.shortcut = keys_of(context.commands, "view.preset", {preset.name});
    if ((i < in_a_row ? first : second)
            .add(context.ui, std::string("layers.preset.") + preset.name, preset.label, options))
      context.ask("view.preset", {preset.name});
  }
}

void draw_camera(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "layers.camera", "Camera")) return;
  draw_presets(context);
  ButtonOptions fit;
  fit.shortcut = keys_of(context.commands, "view.fit"), fit.width = -1;
  if (button(ui, "layers.fit", "Fit", fit)) context.ask("view.fit");
  const bool ortho = app::active_camera(session.view).orthographic;
  SwitchGrid grid(context);
  grid.add({"layers.ortho", "Orthographic", "Turns perspective off", "view.ortho"}, ortho);
  grid.add({"layers.linked", "Linked", "Uses one camera for all views", "view.link"}, session.view.linked);
  grid.add({"layers.follow", "Follow", "Moves the camera with the person", "view.follow"},
           session.view.follow);
  ask_number(context, {"layers.turntable", "Turntable", "Turns the camera on its own", "view.turntable"},
             session.view.turntable_deg_s, {-180, 180, 0.5f, "%.0f\u00b0/s", 0, true});
}

void draw_background(const app::View& view, PanelContext& context) {
  Ui& ui = context.ui;
  int chosen = static_cast<int>(view.background);
  row(ui, "Background", "What is behind everything; pictures can leave it out");
  if (dropdown(ui, "layers.background", {"Theme", "White", "Black", "Custom"}, chosen))
    context.ask("view.background", {app::kBackgroundNames[static_cast<size_t>(chosen)]});
  if (view.background != app::Background::Custom) return;
  row(ui, "Colour", "Of the background");
  Vec3 color = view.background_color;
  ImGui::SetNextItemWidth(-FLT_MIN);
  const bool changed = ImGui::ColorEdit3("##background", color.data(), ImGuiColorEditFlags_NoOptions);
  ui.mark("layers.background_colour");
  if (!changed) return;
  app::Arguments words = {"custom"};
  for (int i = 0; i < 3; ++i) words.push_back(argument(static_cast<double>(color[i])));
  context.ask("view.background", words);
}

void draw_light(const app::Session& session, PanelContext& context) {
  if (!section(context.ui, "layers.light_and_background", "Light and background", false)) return;
  const app::LightLook& light = session.view.light;
  ask_number(context,
             {"layers.light.turn", "From the side",
              "Turns the main light about the view, as a Ctrl+right drag does", "view.light turn"},
             light.turn_deg, {-180, 180, 0.5f, "%.0f\u00b0", 0, true});
  ask_number(context,
             {"layers.light.height", "From above",
              "Raises or lowers the main light, as a Ctrl+right drag does", "view.light height"},
             light.height_deg, {-90, 90, 0.5f, "%.0f\u00b0", 0, true});
  ask_number(context, {"layers.light.brightness", "Brightness", "Of all light", "view.light brightness"},
             light.brightness, {0, 3, 0.005f, "%.2f", 1, true});
  draw_background(session.view, context);
}

}  // namespace

std::vector<LayerSwitch> layer_switches(const app::Session& session, bool source) {
  const app::Layers& layers = source ? session.view.source : session.view.take;
  const bool faces = !source || session.source.has_faces;
  std::vector<LayerSwitch> all = {
      {"surface", source ? "Scan" : "Mesh", source ? "The scan of this frame" : "The target's surface",
       layers.surface},
      {"skeleton", "Skeleton", "The extracted joints, or those of the target", layers.skeleton},
      {"x_ray", "X-ray", "Shows the skeleton through the surface", layers.x_ray},
      {"joint_names", "Names",
       "Shows the names of all joints; the joint under the pointer always shows its own", layers.joint_names},
      {"ground", "Ground", "The grid on the floor, with a soft shadow", layers.ground},
      {"trails", "Trails", "The paths of the joints chosen below", layers.trails},
      {"ghosts", "Ghosts", "Past and future frames, faint", layers.ghosts}};
  if (faces)
    all.push_back({"wireframe", "Wireframe", "The edges of the surface's faces, over it", layers.wireframe});
  if (faces && source)
    all.push_back({"as_points", "As points", "Shows the scan's points without its faces", layers.as_points});
  if (source && session.document.bones.wanted)
    all.push_back({"bones", "Bones", "The skeleton of its own that was found in the scan", layers.bones});
  if (source && session.source.has_scene)
    all.push_back({"scene", "Scene", "The ground and things in the scan, grey", layers.scene});
  return all;
}

void draw_layers(const app::Session& session, PanelContext& context) {
  const DisabledScope disabled(!has_document(session));
  draw_pane(session, context, true);
  draw_pane(session, context, false);
  draw_overlay_rows(session, context);
  draw_colours(session, context);
  draw_camera(session, context);
  draw_light(session, context);
}

}  // namespace understudy::ui
