// The source's own skeleton: finding it, a table of its bones, edits of it, who of them is near which joint
// of a person, export.
// Sections: bones.all, bones.one, bones.motion, bones.near. Marks: bones.method, bones.body (.K, their
// choices), bones.auto, bones.most, bones.find, bones.work (.cancel), bones.stage.K; bones.bone.K (a row),
// bones.surface.K, bones.name, bones.kind, bones.merge, bones.split, bones.root, bones.x, .y, .z,
// bones.turn_tool, bones.turn_x, .turn_y, .turn_z; bones.paint_tool, bones.brush_radius, .brush_strength,
// .brush_mode; bones.strength, bones.smooth, bones.trim, bones.fit; bones.near.K, bones.name_as_joints;
// bones.export, bones.drop.
// The second body, in second_body.cpp: bones.second; bones.perform, bones.perform.work (.cancel),
// bones.match.K (.I, its choices), bones.perform_export, bones.perform_drop.
// Further motions, in made_motions.cpp: bones.made; generate.frames, .between, .first, .last, .marks, .loop,
// .count, .seed, .engine, .make, generate.work (.cancel), generate.ghosts, generate.offered.K,
// generate.clear, generate.clips.K, generate.name, generate.remove.
#include <algorithm>
#include <array>
#include <cctype>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/made_motions.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"
#include "ui/panels/second_body.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

struct BonesPanelState {
  app::BoneSearch search;       ///< to ask for
  app::BoneSearch of_document;  ///< that was asked for
  float strength = 0.5f;        ///< of smoothing
  std::shared_ptr<const DiscoveredRig> of;
  std::vector<int> vertices;  ///< of each bone, those that it moves most
};

struct BonesDrawing {
  const app::Session& session;
  PanelContext& context;
  BonesPanelState& state;
  const app::BonesState& bones() const { return session.bones; }
  const DiscoveredRig& found() const { return *session.bones.rig; }
  const Rig& rig() const { return found().found.rig; }
  Ui& ui() const { return context.ui; }
};

/// What DiscoveryProgress names, in its order, and what people read of it.
struct StageWords {
  const char *name, *label;
};
constexpr std::array<StageWords, 4> kStages = {{{"Reading", "Read the scans"},
                                                {"Surface", "Track the surface"},
                                                {"Bones", "Fit the bones"},
                                                {"Following", "Follow the other frames"}}};

void follow_rig(const app::Session& session, BonesPanelState& state) {
  const app::BoneSearch& search = session.document.bones.search;
  if (!same(search, state.of_document)) state.search = state.of_document = search;
  if (state.of == session.bones.rig) return;
  state.of = session.bones.rig;
  state.vertices.clear();
  if (!state.of) return;
  const SkinWeights& skin = state.of->found.rig.skin;
  state.vertices.assign(state.of->found.rig.joints.size(), 0);
  for (Eigen::Index v = 0; v < skin.size(); ++v) ++state.vertices[static_cast<size_t>(skin.main_bone(v))];
}

/// Those that the program has weights for, and the document's own.
MethodChoices offered_methods(const BonesDrawing& d) {
  MethodChoices offered;
  for (const MethodChoice& method : rig_methods())
    if (!method.own_weights || d.session.document.bones.search.method == method.name)
      offered.push_back(method);
  return offered;
}

void draw_most(const BonesDrawing& d) {
  int& most = d.state.search.most;
  bool automatic = most == 0;
  if (toggle_row(d.ui(), {"bones.auto", "Automatic", "As many bones as the motion shows"}, automatic))
    most = automatic ? 0 : 12;
  if (automatic) return;
  if (const auto typed =
          typed_number_row(d.ui(), {"bones.most", "At most", "So many bones, or fewer"}, most, 0))
    most = std::clamp(static_cast<int>(*typed), 1, app::kMostBones);
}

void draw_kind(const BonesDrawing& d) {
  std::string& kind = d.state.search.kind;
  if (kind.empty()) kind = d.session.source.no_person ? "quadruped" : "person";
  std::vector<std::string> labels(kBodyKinds.begin(), kBodyKinds.end());
  const auto known = std::find(labels.begin(), labels.end(), kind);
  int chosen = known == labels.end() ? -1 : static_cast<int>(known - labels.begin());
  for (std::string& label : labels) label[0] = static_cast<char>(std::toupper(label[0]));
  if (choice_row(d.ui(), {"bones.body", "Kind", "Of the body that moves"}, labels, chosen))
    kind = kBodyKinds[static_cast<size_t>(chosen)];
}

void draw_start_rows(const BonesDrawing& d) {
  app::BoneSearch& search = d.state.search;
  const MethodChoices methods = offered_methods(d);
  method_row(d.ui(), {"bones.method", "Found by", "How bones are looked for"}, methods, search.method);
  const MethodChoice* const method = at_or_null(methods, index_of(methods, search.method));
  const bool of_kind = method != nullptr && method->weights != nullptr;
  if (of_kind)
    draw_kind(d);
  else
    draw_most(d);
  const bool again = d.bones().rig != nullptr;
  if (method != nullptr && (!again || !same(search, d.state.of_document))) hint(d.ui(), tip_of(*method));
  const std::string how = of_kind            ? search.method + " " + search.kind
                          : search.most == 0 ? "auto"
                                             : std::to_string(search.most);
  ask_button(
      d.context,
      {"bones.find", again ? "Find again" : "Find its own skeleton",
       again ? "Edits of the bones are dropped; can be undone" : "Looks at all frames", "bones.find " + how},
      possible(d.session, "bones.find"));
}

/// Each stage with a tick, the one that is worked on in full colour.
void draw_stages(const BonesDrawing& d) {
  const std::string& now = d.bones().stage;
  const auto at = std::find_if(kStages.begin(), kStages.end(),
                               [&](const StageWords& stage) { return now == stage.name; });
  if (at == kStages.end()) return;
  const Theme& theme = d.ui().theme();
  for (auto stage = kStages.begin(); stage != kStages.end(); ++stage) {
    icon_label(d.ui(), stage < at ? Icon::Check : Icon::Clock,
               stage < at    ? theme.good
               : stage == at ? theme.accent
                             : theme.text_faint);
    ImGui::SameLine(0, d.ui().px(6));
    const ColorScope color(ImGuiCol_Text, stage == at ? theme.text : theme.text_dim);
    ImGui::TextUnformatted(stage->label);
    d.ui().mark("bones.stage." + std::to_string(stage - kStages.begin()));
  }
}

/// False: nothing is being done.
bool draw_work(const BonesDrawing& d) {
  const app::BonesState& bones = d.bones();
  if (bones.waits) {
    hint(d.ui(), "Begins as soon as all frames are read.");
    return true;
  }
  if (bones.job == 0) return false;
  draw_stages(d);
  job_progress(d.session, d.context, "bones.work", bones.job, bones.share,
               bones.stage == "Fit" ? "Fitting" : "Finding bones");
  if (bones.so_far)
    hint(d.ui(), std::to_string(bones.so_far->tree.size()) + " parts so far, painted in the view.");
  return true;
}

void draw_summary(const BonesDrawing& d) {
  const DiscoveredRig& found = d.found();
  double off = 0;
  int known = 0, doubted = 0;
  for (size_t t = 0; t < found.off_m.size(); ++t) {
    if (found.off_m[t] >= 0) off += static_cast<double>(found.off_m[t]), ++known;
    doubted += found.doubted[t] ? 1 : 0;
  }
  const int count = d.rig().count();
  row_text(d.ui(), "Found",
           count == 1 ? "1 bone: nothing moves against anything else" : std::to_string(count) + " bones");
  if (known > 0) row_text(d.ui(), "Off the scans", figure(1000 * off / known, "mm") + ", mean");
  if (doubted > 0)
    row_text(d.ui(), "Not to be trusted", std::to_string(doubted) + (doubted == 1 ? " frame" : " frames"));
  if (found.seen_once())
    hint(d.ui(), "Seen in one frame: its joints are where the network sees them, no motion has shown them.");
  if (!found.complete) hint(d.ui(), "Ended early: this is the best that was found by then.");
}

std::string turned(const RigJoint& joint, const FoundBone& bone) {
  if (joint.parent < 0) return "";
  if (joint.kind == JointKind::Slider) return printed("%.0f mm", 1000 * static_cast<double>(bone.slid_m));
  return printed("%.0f\u00b0", static_cast<double>(bone.turned_deg));
}

void draw_table(const BonesDrawing& d) {
  constexpr float kParentWidth = 47;
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const float height = line * (static_cast<float>(std::min(d.rig().count(), 14)) + 1.6f);
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {d.ui().px(4), ImGui::GetStyle().CellPadding.y});
  Table table(d.ui(), "bones.bone",
              {{"Bone"},
               {"Parent", kParentWidth},
               {"Kind", 36},
               {"Turns", 34, true},
               {"Off, mm", 44, true},
               {"Seen", 39, true}},
              height);
  ImGui::PopStyleVar();
  if (!table.open()) return;
  for (int j = 0; j < d.rig().count(); ++j) {
    const RigJoint& joint = d.rig().joints[static_cast<size_t>(j)];
    const FoundBone& bone = d.found().bones[static_cast<size_t>(j)];
    if (table.row(j == d.bones().selected))
      d.context.ask("bones.select", {j == d.bones().selected ? "none" : std::to_string(j)});
    color_chip(d.ui(), bone_color(j));
    table.cell(cut_name(joint.name, ImGui::GetContentRegionAvail().x));  // their numbers tell them apart
    const RigJoint* const parent = at_or_null(d.rig().joints, joint.parent);
    table.cell(parent == nullptr ? "\u2013" : cut_name(parent->name, d.ui().px(kParentWidth)));
    table.cell(kJointKindNames[static_cast<size_t>(joint.kind)]);
    table.cell(turned(joint, bone));
    table.cell(bone.off_m < 0 ? "\u2013" : printed("%.1f", 1000 * static_cast<double>(bone.off_m)));
    table.cell(bone.seen_share < 0 ? "\u2013"
                                   : printed("%.0f %%", 100 * static_cast<double>(bone.seen_share)));
  }
}

void draw_all(const BonesDrawing& d) {
  if (!section(d.ui(), "bones.all", "Bones")) return;
  draw_summary(d);
  ask_choice(d.context,
             {"bones.surface", "Surface by bone",
              "What was found, painted by bone, in place of the scan or beside it", "view.bone_surface"},
             {"Off", "Over", "Beside"}, {app::kBoneSurfaceNames.begin(), app::kBoneSurfaceNames.end()},
             app::kBoneSurfaceNames[static_cast<size_t>(d.session.view.bone_surface)]);
  ask_button(d.context, {"bones.export", "Export\u2026",
                         "As .glb with bones, skin and animation; its motion alone as .bvh",
                         "dialog.open export_bones"});
  draw_table(d);
}

void draw_place(const BonesDrawing& d, const RigJoint& joint) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const auto typed =
        typed_number_row(d.ui(), {"bones." + name, "Joint " + name + ", m", "Where it is at rest"},
                         static_cast<double>(joint.rest[axis]), 3);
    if (!typed) continue;
    Vec3 to = joint.rest;
    to[axis] = static_cast<float>(*typed);
    app::Arguments words = {std::to_string(d.bones().selected)};
    for (int k = 0; k < 3; ++k) words.push_back(argument(static_cast<double>(to[k])));
    d.context.ask("bones.move", words);
  }
}

/// Turned further in the frame that is shown, about an axis of its own.
void draw_turns(const BonesDrawing& d) {
  const int frame = app::shown_frame(d.session);
  if (app::frame_of_rig(d.found(), frame) < 0) return;
  tool_button(d.session, d.context,
              {"bones.turn_tool", "Turn with the mouse",
               "By the rings around its joint; a hinge has one, sliders and what is fixed have none"},
              app::Tool::Bones);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const auto typed =
        typed_number_row(d.ui(),
                         {"bones.turn_" + name, "Turn about " + name + ", \u00b0",
                          "In this frame; those around it follow less and less, as Falloff in Edit says"},
                         0, 0);
    if (!typed || *typed == 0) continue;
    app::Arguments words = {std::to_string(d.bones().selected), std::to_string(frame)};
    for (int k = 0; k < 3; ++k)
      words.push_back(argument(k == axis ? *typed * static_cast<double>(kPi) / 180 : 0));
    d.context.ask("bones.turn", words);
  }
}

/// Painted with the mouse, on the surface in the view.
void draw_weights_of_bone(const BonesDrawing& d, int joint) {
  row_text(d.ui(), "Moves",
           std::to_string(d.state.vertices[static_cast<size_t>(joint)]) + " points of the surface");
  tool_button(d.session, d.context,
              {"bones.paint_tool", "Paint its weights", "On the surface in the view, with a brush"},
              app::Tool::Paint);
  if (d.session.tool == app::Tool::Paint) brush_rows(d.session, d.context, "bones");
}

/// Edits of the chosen bone.
void draw_one(const BonesDrawing& d) {
  const int j = d.bones().selected;
  const RigJoint* const joint = at_or_null(d.rig().joints, j);
  if (!section(d.ui(), "bones.one", joint == nullptr ? "Bone" : "Bone: " + joint->name)) return;
  if (joint == nullptr) return hint(d.ui(), "Choose a bone in the table or in the view to change it.");
  const std::string k = std::to_string(j);
  if (const auto name = text_row(d.ui(), {"bones.name", "Name"}, joint->name))
    d.context.ask("bones.rename", {k, *name});
  if (j > 0) {
    const std::vector<std::string> words = {"ball", "hinge", "slider", "fixed"};
    ask_choice(
        d.context, {"bones.kind", "Kind", "How it may move against what it hangs on", "bones.kind " + k},
        {"Ball", "Hinge", "Slider", "Fixed"}, words, kJointKindNames[static_cast<size_t>(joint->kind)]);
  }
  draw_weights_of_bone(d, j);
  draw_place(d, *joint);
  draw_turns(d);
  ButtonRow buttons(3);
  buttons.ask(d.context, {"bones.merge", "Merge", "Becomes one with what it hangs on", "bones.merge " + k},
              j > 0);
  buttons.ask(d.context,
              {"bones.split", "Split", "Cuts it in its middle: it becomes two", "bones.split " + k});
  buttons.ask(d.context, {"bones.root", "Root", "The tree hangs on this bone", "bones.root " + k}, j > 0);
}

void draw_motion(const BonesDrawing& d) {
  if (!section(d.ui(), "bones.motion", "Motion", false)) return;
  row(d.ui(), "Strength", "0 nothing, 1 the smoothest");
  number(d.ui(), "bones.strength", d.state.strength, {0, 1, 0.005f, "%.2f"});
  const std::string one = d.bones().selected < 0 ? "all" : std::to_string(d.bones().selected);
  ask_button(d.context, {"bones.smooth", d.bones().selected < 0 ? "Smooth all bones" : "Smooth this bone",
                         "Turns over time; both ends stay as they are",
                         "bones.smooth " + argument(static_cast<double>(d.state.strength)) + " " + one});
  const app::Playback& playback = d.session.playback;
  const bool marked = playback.in >= 0 && playback.out > playback.in;
  ask_button(d.context,
             {"bones.trim", "Keep the frames between In and Out", "Of the found rig; the scans stay",
              printed("bones.trim %d %d", playback.in, playback.out)},
             marked);
  ask_button(d.context,
             {"bones.fit", "Fit to the scans again", "Poses of all frames, with the bones as they are now"});
}

/// Share of frames in which the same found joint is the nearest, as a mean over the 22 (paper 3's SC).
std::string consistency_words(const BonesDrawing& d) {
  double sum = 0;
  for (const app::SteadyJoint& one : d.bones().steady) sum += one.share;
  return printed("%.0f %% of frames, K = %d", 100 * sum / static_cast<double>(ssize(d.bones().steady)),
                 d.rig().count());
}

/// Of each of the 22 joints of a person the found one that is the nearest to it in most frames.
void draw_near(const BonesDrawing& d) {
  const std::vector<app::NearJoint>& near = d.bones().near;
  const std::vector<app::SteadyJoint>& steady = d.bones().steady;
  if (steady.empty() || !section(d.ui(), "bones.near", "Nearest to a person's joints")) return;
  row_text(d.ui(), "Consistency", consistency_words(d));
  {
    const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    Table table(d.ui(), "bones.near",
                {{"Joint", 84}, {"Nearest bone"}, {"mm", 38, true}, {"Same, %", 56, true}},
                line * 12 + 0.6f * line);
    for (int i = 0; table.open() && i < ssize(steady); ++i) {
      const auto& [bone, share, apart_m] = steady[static_cast<size_t>(i)];
      if (table.row(bone == d.bones().selected)) d.context.ask("bones.select", {std::to_string(bone)});
      const app::NearJoint* const one = at_or_null(near, bone);
      const std::string& name = d.rig().joints[static_cast<size_t>(bone)].name;
      table.cell(joint_label(i));
      table.cell(one != nullptr && one->names && one->joint == i ? name : "(" + name + ")");
      table.cell(printed("%.0f", 1000 * static_cast<double>(apart_m)));
      table.cell(printed("%.0f", 100 * share));
    }
  }
  hint(d.ui(),
       "Same: the share of frames in which this bone is the nearest to the joint. Few bones (K) score "
       "easily.");
  hint(d.ui(), "In brackets: it is nearer to another joint, or too far to have this one's name.");
  const bool any = std::any_of(near.begin(), near.end(), [](const app::NearJoint& one) { return one.names; });
  ask_button(d.context,
             {"bones.name_as_joints", "Give them the joints' names",
              "Those that are near none stay as they are: skirt, tail, backpack"},
             any);
}

}  // namespace

void draw_bones(const app::Session& session, PanelContext& context) {
  const BonesDrawing d{session, context, panel_state<BonesPanelState>(context)};
  follow_rig(session, d.state);
  if (!draw_work(d)) draw_start_rows(d);
  if (!session.bones.problem.empty()) hint(context.ui, session.bones.problem + ".");
  if (!session.bones.rig) {
    if (session.bones.job == 0)
      hint(context.ui,
           "Finds bones, skin and motion of anything that moves. The scans must show one thing alone: crop "
           "it, or remove the floor, in Edit > Scan.");
    return;
  }
  draw_all(d);
  draw_one(d);
  draw_motion(d);
  draw_made_motions(session, context);
  draw_near(d);
  draw_second_body(session, context);
  ask_button(context, {"bones.drop", "Drop these bones", "Can be undone"});
}

}  // namespace understudy::ui
