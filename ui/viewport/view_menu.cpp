#include "ui/viewport/view_menu.hpp"

#include <algorithm>
#include <variant>

#include "retarget/base/index.hpp"
#include "retarget/editing/limb_move.hpp"
#include "ui/panels/layers.hpp"

namespace understudy::ui {
namespace {

using Items = std::vector<MenuItem>;

void add_line(Items& items) {
  items.push_back({});
}

Items view_from(const app::Session& session, int pane) {
  Items items = view_presets();
  const bool ortho = app::camera_of(session.view, pane).orthographic;
  add_line(items);
  items.push_back({"Orthographic", "view.ortho", {on_off(!ortho)}, ortho});
  return items;
}

/// What is shown of the source, or of the takes, each to be hidden or shown.
Items shown_layers(const app::Session& session, bool source) {
  const std::string pane = source ? "source" : "take";
  Items items;
  for (const LayerSwitch& layer : layer_switches(session, source))
    items.push_back({layer.label, "view.layer", {pane, layer.name, on_off(!layer.on)}, layer.on});
  return items;
}

/// person: as app::pane_joints() numbers them.
bool is_edited(const app::Session& session, int person, int joint) {
  if (person == 0) {
    const auto& edits = session.document.skeleton_edits;
    return std::any_of(edits.begin(), edits.end(), [&](const SkeletonEdit& edit) {
      const auto* const drag = std::get_if<DragEdit>(&edit);
      return drag != nullptr && drag->joint == joint;
    });
  }
  const app::Take* const take = at_or_null(session.document.takes, person - 1);
  if (take == nullptr) return false;
  const std::vector<int> joints = joints_turned_by(joint);
  const auto& turned = take->pose_edits.rotate;
  return std::any_of(turned.begin(), turned.end(), [&](const RotateEdit& edit) {
    return std::find(joints.begin(), joints.end(), edit.joint) != joints.end();
  });
}

void add_joint(const app::Session& session, const ViewMenuPlace& place, Items& items) {
  if (place.joint < 0) return;
  const int person = person_of_tool(session, place.pane);
  const std::string label = joint_label(place.joint), name = joint_name(place.joint);
  const auto& trails = session.view.trail_joints;
  const bool trail = std::find(trails.begin(), trails.end(), place.joint) != trails.end();
  add_line(items);
  items.push_back({"Select " + label, "select.joint", {name}, session.selected_joint == place.joint});
  items.push_back({"Trail of " + label, "view.trail_joint", {name, on_off(!trail)}, trail});
  if (person > 0) items.push_back({"Weights of " + label, "view.weights_joint", {name}});
  if (shows_rest(session, place.pane) || !is_edited(session, person, place.joint)) return;
  if (person == 0)
    items.push_back({"Reset " + label, "edit.remove", {"drags_of", name}});
  else
    items.push_back({"Reset " + limb_label(place.joint),
                     "edit.remove",
                     {"rotations_of", std::to_string(person - 1), name}});
}

}  // namespace

std::vector<MenuItem> view_menu_items(const app::Session& session, const ViewMenuPlace& place) {
  const PaneContent& pane = place.pane;
  Items items = {{"Fit", "view.fit"}};
  if (!place.centred.empty()) items.push_back({"Centre here", "view.camera_state", place.centred});
  items.push_back({"View from", "", {}, false, view_from(session, pane.number)});
  items.push_back({"Reset camera", "view.reset"});
  add_line(items);
  const bool both = pane.source && !pane.takes.empty();
  if (pane.source)
    items.push_back({both ? "Source layers" : "Layers", "", {}, false, shown_layers(session, true)});
  if (!pane.takes.empty())
    items.push_back({both ? "Result layers" : "Layers", "", {}, false, shown_layers(session, false)});
  if (session.view.layout != app::Layout::Single && !both)
    items.push_back({"Only this view", "view.layout", {"single"}});
  if (session.view.layout != app::Layout::SideBySide)
    items.push_back({"Side by side", "view.layout", {"side-by-side"}});
  add_joint(session, place, items);
  add_line(items);
  items.push_back({"Save picture\u2026", "dialog.open", {"picture"}});
  if (!pane.source) items.push_back({"Export\u2026", "dialog.open", {"export"}});
  return items;
}

}  // namespace understudy::ui
