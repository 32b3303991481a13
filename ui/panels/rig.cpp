#include "ui/panels/rig.hpp"

#include "ui/panels/rows.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

/// The bones to choose from: those of its skins, or whatever has a name where there is no skin.
std::vector<int> bones_of(const PreparedCharacter& character) {
  std::vector<int> bones;
  const bool skinned = !character.character.skins.empty();
  for (size_t n = 0; n < character.character.nodes.size(); ++n)
    if (!character.character.nodes[n].name.empty() && (!skinned || character.bind.is_bone[n]))
      bones.push_back(n);
  return bones;
}

std::string bone_name(const PreparedCharacter& character, int node) {
  if (node < 0) return "\u2013";
  const std::string& name = character.character.nodes[node].name;
  return name.empty() ? "node " + std::to_string(node) : name;
}

std::string how_sure(const app::Take& take, const BoneMap& map, size_t joint) {
  if (take.target.bones.count(kJointNames[joint]) > 0) return "yours";
  if (map.node[joint] < 0) return "";
  if (map.confidence[joint] >= 0.95f) return "sure";
  return map.confidence[joint] >= BoneMap::kGuessed ? "by name" : "guessed";
}

void draw_facts(const PreparedCharacter& character, Ui& ui) {
  const int count = character.map.count();
  row_text(ui, "Bones",
           character.character.skins.empty() && count == 0
               ? "none"
               : std::to_string(count) + " of 22 joints, " + character.map.how);
  const float turned = character.pose.largest_deg;
  row_text(ui, "Rest pose", turned < 0.5f ? "T-pose" : figure(turned, "\u00b0") + " off the T-pose");
  for (const std::string& note : character.notes) hint(ui, note);
}

void draw_table(const app::Session& session, const app::Take& take, const PreparedCharacter& character,
                PanelContext& context) {
  Table table(context.ui, "rig.joint", {{"Joint"}, {"Bone"}, {"", 56}}, context.ui.px(230));
  if (!table.open()) return;
  for (size_t j = 0; j < kJointCount; ++j) {
    const int joint = j;
    if (table.row(joint == session.selected_joint))
      context.ask("select.joint", {joint == session.selected_joint ? "none" : joint_name(joint)});
    table.cell(joint_label(joint));
    table.cell(bone_name(character, character.map.node[j]));
    table.cell(how_sure(take, character.map, j));
  }
}

/// The bones for the joint that is selected.
void draw_bones(const app::Session& session, const PreparedCharacter& character, PanelContext& context,
                const std::string& k) {
  Ui& ui = context.ui;
  const int joint = session.selected_joint;
  if (joint < 0) return hint(ui, "Choose a joint to give it another bone.");
  hint(ui, "Bone of the " + joint_label(joint));
  const std::vector<int> bones = bones_of(character);
  std::vector<ListItem> items = {{"Automatic", ""}, {"None", ""}};
  int selected = -1;
  for (const int node : bones) {
    ListItem item{bone_name(character, node), ""};
    for (int other = 0; other < kJointCount; ++other)
      if (character.map.node[other] == node) item.note = joint_label(other);
    if (character.map.node[joint] == node) selected = items.size();
    items.push_back(std::move(item));
  }
  const int chosen = searchable_list(ui, "rig.bone", items, selected, ui.px(150));
  if (chosen < 0) return;
  const std::string bone = chosen == 0 ? "auto" : chosen == 1 ? "none" : items[chosen].text;
  context.ask("target.bone", {k, joint_name(joint), bone});
}

}  // namespace

void draw_rig(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const app::Take* take = selected_take(session);
  const app::TakeState* state = selected_state(session);
  if (take == nullptr || !section(ui, "inspector.rig", "Rig")) return;
  const std::string k = std::to_string(session.selected_take);
  ask_choice(context,
             {"rig.choice", "Performs on",
              "Its own bones and weights, or the 22 joints with weights found here", "target.rig " + k},
             {"Auto", "Own", "22 joints"}, {app::kRigNames.begin(), app::kRigNames.end()},
             app::kRigNames[static_cast<size_t>(take->target.rig)]);
  if (state == nullptr || !state->character) return;
  const PreparedCharacter& character = *state->character;
  draw_facts(character, ui);
  if (bones_of(character).size() < 2 || !section(ui, "inspector.bones", "Bones", false)) return;
  draw_table(session, *take, character, context);
  draw_bones(session, character, context, k);
  ask_button(context,
             {"rig.reset", "Reset", "Gives every joint the bone found for it; can be undone",
              "target.bones_clear " + k},
             !take->target.bones.empty());
}

}  // namespace understudy::ui
