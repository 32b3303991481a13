#include "ui/panels/second_body.hpp"

#include <algorithm>
#include <array>

#include "app/run/rig_performance.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/rows.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

/// What SecondBodyState::stage names, and what people read of it.
constexpr std::array<std::pair<const char*, const char*>, 6> kWork = {
    {{"Reading", "Reading it"},
     {"Surface", "Finding its skeleton"},
     {"Bones", "Finding its skeleton"},
     {"Following", "Finding its skeleton"},
     {"Laying", "Laying them on each other"},
     {"Performing", "Performing"}}};

void draw_performing(const app::Session& session, PanelContext& context) {
  const app::SecondBodyState& second = session.second;
  std::string doing;
  for (const auto& [name, words] : kWork)
    if (second.stage == name) doing = words;
  job_progress(session, context, "bones.perform.work", second.job, second.share, doing);
}

/// "88 % of the first, mirrored".
std::string size_words(const LaidBody& laid) {
  return printed("%.0f %% of the first", 100 * static_cast<double>(laid.scale)) +
         (laid.mirrored() ? ", mirrored" : "");
}

/// The found motion or a clip that was kept.
void draw_clip(const app::Session& session, PanelContext& context) {
  const app::OwnBones& bones = session.document.bones;
  if (bones.clips.empty()) return;
  std::vector<std::string> labels = {"What was found"}, words = {app::kFoundClip};
  for (const app::MadeClip& clip : bones.clips) labels.push_back(clip.name), words.push_back(clip.name);
  ask_choice(context, {"bones.perform_clip", "Performs", "What was found, or a clip that was kept"}, labels,
             words, bones.second.clip.empty() ? app::kFoundClip : bones.second.clip);
}

/// Those of the second that have no partner, "a, b".
std::string without_partner(const app::SecondBodyState& second) {
  std::string names;
  for (size_t k = 0; k < second.matches.partner.size(); ++k)
    if (second.matches.partner[k] < 0) append_item(names, second.other->body.rig.joints[k].name);
  return names;
}

/// A row for each bone of the first: the bone of the second that performs it, as found or chosen.
class MatchTable {
 public:
  MatchTable(const app::Session& session, PanelContext& context)
      : session_(session), context_(context), choices_({"Automatic", "None"}) {
    for (const RigJoint& joint : session.second.other->body.rig.joints) choices_.push_back(joint.name);
  }
  void draw() {
    const auto& joints = session_.bones.rig->found.rig.joints;
    const float line = ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    const float rows = static_cast<float>(std::min<size_t>(joints.size(), 12));
    Table table(context_.ui, "bones.match", {{"Bone"}, {"Performed by"}, {"Unlike, %", 56, true}, {"", 38}},
                line * (rows + 1));
    for (size_t j = 0; table.open() && j < joints.size(); ++j) draw_row(table, joints[j].name, j);
  }

 private:
  void draw_row(Table& table, const std::string& bone, size_t j) {
    const int k = performer_of(session_.second.matches, static_cast<int>(j));
    table.row(false, false);
    table.next_cell();
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + ImGui::GetStyle().FramePadding.y);
    color_chip(context_.ui, bone_color(static_cast<int>(j)));
    text_cut(context_.ui, bone);
    table.next_cell();
    int chosen = k + kOwn;
    if (dropdown(context_.ui, "bones.match." + std::to_string(j), choices_, chosen))
      context_.ask("bones.match", {std::to_string(j), word(chosen)});
    table.cell(k < 0 ? "" : printed("%.0f", 100 * static_cast<double>(session_.second.matches.cost[k])));
    table.cell(is_chosen(bone) ? "yours" : "");
  }
  static std::string word(int choice) {
    return choice == 0 ? "auto" : choice == 1 ? "none" : std::to_string(choice - kOwn);
  }
  bool is_chosen(const std::string& bone) const {
    const auto& matches = session_.document.bones.second.matches;
    return std::any_of(matches.begin(), matches.end(),
                       [&](const ChosenMatch& match) { return match.bone == bone; });
  }

  static constexpr int kOwn = 2;  // choices before the second's own bones
  const app::Session& session_;
  PanelContext& context_;
  std::vector<std::string> choices_;
};

void draw_matches(const app::Session& session, PanelContext& context) {
  const app::SecondBodyState& second = session.second;
  row_text(context.ui, "Its size", size_words(second.other->laid));
  if (second.other->is_scan)
    return hint(context.ui, "One scan has no bones of its own: it performs with the first one's.");
  MatchTable(session, context).draw();
  const std::string alone = without_partner(second);
  if (!alone.empty()) hint(context.ui, "Go with their neighbours: " + alone + ".");
}

}  // namespace

void draw_second_body(const app::Session& session, PanelContext& context) {
  if (!section(context.ui, "bones.second", "Second body")) return;
  const app::SecondBodyState& second = session.second;
  const std::string& path = session.document.bones.second.path;
  const Control choose{"bones.perform",
                       path.empty() ? "Have a second body perform it\u2026" : "Another body\u2026",
                       "Of the same kind: a rig that was found before, one scan, or a folder of scans",
                       "dialog.open second_body"};
  if (path.empty()) return ask_button(context, choose);
  row_text(context.ui, "Body", file_name(path));
  draw_clip(session, context);
  if (second.job != 0) draw_performing(session, context);
  if (second.job == 0 && !second.other && second.problem.empty())
    hint(context.ui, "Begins as soon as all frames are read.");
  if (!second.problem.empty()) hint(context.ui, second.problem + ".");
  if (second.other) draw_matches(session, context);
  if (second.performed)
    ask_button(context, {"bones.perform_export", "Export its performance\u2026",
                         "As .glb with bones, skin and animation; its motion alone as .bvh",
                         "dialog.open export_second_body"});
  ButtonRow buttons(2);
  buttons.ask(context, choose);
  buttons.ask(context, {"bones.perform_drop", "Drop it", "Can be undone"});
}

}  // namespace understudy::ui
