#include "ui/viewport/view_menu.hpp"

#include <algorithm>
#include <variant>

#include "retarget/base/index.hpp"
#include "ui/panels/panel.hpp"

namespace understudy::ui {
namespace {

using Items = std::vector<MenuItem>;

void add_line(Items& items) {
  items.push_back({});
}

Items view_from(const app::Session& session) {
  Items items;
  for (const auto& [label, preset] : {std::pair("Front", "front"),
                                      {"Back", "back"},
                                      {"Right", "right"},
                                      {"Left", "left"},
                                      {"Top", "top"},
                                      {"Bottom", "bottom"},
                                      {"Three-quarter", "three-quarter"}})
    items.push_back({label, "view.preset", {preset}});
  const bool ortho = !session.view.cameras.empty() && session.view.cameras.front().orthographic;
  add_line(items);
  items.push_back({"Orthographic", "view.ortho", {on_off(!ortho)}, ortho});
  return items;
}

/// What is shown of the source, or of the takes, each to be hidden or shown.
Items shown_layers(const app::Session& session, bool source) {
  const app::Layers& layers = source ? session.view.source : session.view.take;
  const std::string pane = source ? "source" : "take";
  Items items;
  const auto add = [&](const char* label, const char* layer, bool on) {
    items.push_back({label, "view.layer", {pane, layer, on_off(!on)}, on});
  };
  add(source ? "Scan" : "Mesh", "surface", layers.surface);
  add("Skeleton", "skeleton", layers.skeleton);
  add("X-ray", "x_ray", layers.x_ray);
  add("Names", "joint_names", layers.joint_names);
  add("Ground", "ground", layers.ground);
  add("Trails", "trails", layers.trails);
  add("Ghosts", "ghosts", layers.ghosts);
  if (!source || session.source.has_faces) add("Wireframe", "wireframe", layers.wireframe);
  return items;
}

bool is_edited(const app::Session& session, const PaneContent& pane, int joint) {
  if (pane.number == 0) {
    const auto& edits = session.document.skeleton_edits;
    return std::any_of(edits.begin(), edits.end(), [&](const SkeletonEdit& edit) {
      const auto* const drag = std::get_if<DragEdit>(&edit);
      return drag != nullptr && drag->joint == joint;
    });
  }
  const app::Take* const take = at_or_null(session.document.takes, pane.number - 1);
  if (take == nullptr) return false;
  const auto& turned = take->pose_edits.rotate;
  return std::any_of(turned.begin(), turned.end(),
                     [&](const RotateEdit& edit) { return edit.joint == joint; });
}

void add_joint(const app::Session& session, const ViewMenuPlace& place, Items& items) {
  if (place.joint < 0) return;
  const std::string label = joint_label(place.joint), name = joint_name(place.joint);
  const auto& trails = session.view.trail_joints;
  const bool trail = std::find(trails.begin(), trails.end(), place.joint) != trails.end();
  add_line(items);
  items.push_back({"Select " + label, "select.joint", {name}, session.selected_joint == place.joint});
  items.push_back({"Trail of " + label, "view.trail_joint", {name, on_off(!trail)}, trail});
  if (!place.pane.source) items.push_back({"Weights of " + label, "view.weights_joint", {name}});
  if (!is_edited(session, place.pane, place.joint)) return;
  const app::Arguments which =
      place.pane.number == 0 ? app::Arguments{"drags_of", name}
                             : app::Arguments{"rotations_of", std::to_string(place.pane.number - 1), name};
  items.push_back({"Reset " + label, "edit.remove", which});
}

}  // namespace

std::vector<MenuItem> view_menu_items(const app::Session& session, const ViewMenuPlace& place) {
  const PaneContent& pane = place.pane;
  Items items = {{"Fit", "view.fit"}};
  if (!place.centred.empty()) items.push_back({"Centre here", "view.camera_state", place.centred});
  items.push_back({"View from", "", {}, false, view_from(session)});
  items.push_back({"Reset camera", "view.reset"});
  add_line(items);
  const bool both = pane.source && !pane.takes.empty();
  if (pane.source)
    items.push_back({both ? "Show of the source" : "Show", "", {}, false, shown_layers(session, true)});
  if (!pane.takes.empty())
    items.push_back({both ? "Show of the takes" : "Show", "", {}, false, shown_layers(session, false)});
  if (session.view.layout != app::Layout::Single && !both)
    items.push_back({"This view alone", "view.layout", {"single"}});
  if (session.view.layout != app::Layout::SideBySide)
    items.push_back({"Side by side", "view.layout", {"side-by-side"}});
  add_joint(session, place, items);
  add_line(items);
  items.push_back({"Save picture\u2026", "dialog.open", {"picture"}});
  if (!pane.source) items.push_back({"Export\u2026", "dialog.open", {"export"}});
  return items;
}

}  // namespace understudy::ui
