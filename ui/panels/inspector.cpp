// What is open and how it is done: the source, the takes, their target and method.
// Marks: inspector.source, .times, .import, .takes, .target, .method (sections); source.fps,
// source.times(.browse, .reset), source.complete, source.markers(.browse, .reset), source.units, source.up,
// source.height(.reset), source.turn, source.floor, source.extractor,
// source.people.K (a row of who is there), source.person, source.blend.K (a part's share),
// source.blend_cycles, source.blend_with, source.open, source.motion; take.K (its row), take.name,
// take.remove, take.add, take.replace; target.units, target.height(.reset), target.up, target.turn,
// target.betas, target.stride, target.hip_height, target.arm_reach, target.rest_pose, target.rest_mirror,
// edit.rest_pose_clear; method.engine, method.extractor, method.offsets, method.path, method.repair_swaps,
// method.smooth_joints, method.fix_lengths, method.compare, work.pause, work.resume, work.restart.
#include <algorithm>
#include <sstream>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"
#include "ui/panels/flat.hpp"
#include "ui/panels/performance.hpp"
#include "ui/panels/rig.hpp"
#include "ui/panels/rows.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

void warn(Ui& ui, const std::string& sentence) {
  icon_label(ui, Icon::Warning, ui.theme().warning);
  ImGui::SameLine();
  paragraph(sentence);
}

/// Metres, or by the file's units: then a button leads back there.
void draw_height(PanelContext& context, const std::string& group, const ImportOptions& import,
                 const std::string& take) {
  Ui& ui = context.ui;
  const Control control{
      group + ".height", "Height",
      "Height in metres; auto: from the file's units, or 1.7 m where that gives no human height",
      group + ".height " + take};
  row(ui, control.label, control.explanation);
  const float button = import.height ? ImGui::GetFrameHeight() + ui.px(4) : 0;
  ImGui::BeginChild((control.name + ".field").c_str(),
                    {std::max(1.f, ImGui::GetContentRegionAvail().x - button), ImGui::GetFrameHeight()});
  const auto text = committed_text(ui, control.name, import.height ? figure(*import.height, "m") : "auto");
  ImGui::EndChild();
  const auto metres = text ? parse_number(*text) : std::nullopt;
  if (metres || (text && *text == "auto")) push(context, control, metres ? argument(*metres) : "auto");
  if (!import.height) return;
  ImGui::SameLine(0, ui.px(4));
  if (icon_button(ui, control.name + ".reset", Icon::Reset,
                  {"Back to the file's size", "", false, false, 26}))
    push(context, control, "auto");
}

/// Size and axis, alike for scans and targets. `take`: the commands' first argument, where they have one.
void draw_import(PanelContext& context, const std::string& group, const ImportOptions& import,
                 const std::string& take = {}) {
  const auto word = [](const std::string& value) { return value.empty() ? "auto" : value; };
  ask_choice(context, {group + ".units", "Units", "Of the file", group + ".units " + take}, kUnitNames,
             kUnitNames, word(import.units));
  draw_height(context, group, import, take);
  ask_choice(context, {group + ".up", "Up", "The axis of the file that points up", group + ".up " + take},
             kAxisNames, kAxisNames, word(import.up));
}

void draw_target_turn(const app::TargetOptions& target, PanelContext& context, const std::string& k) {
  const bool automatic = target.forward && target.import.turn_deg == 0;
  const auto text = text_row(
      context.ui, {"target.turn", "Turn by", "Degrees about the vertical; auto: so that it faces forward"},
      automatic ? "auto" : argument(target.import.turn_deg));
  if (!text) return;
  const auto deg = parse_number(*text);
  if (deg || *text == "auto") context.ask("target.turn", {k, deg ? argument(*deg) : "auto"});
}

void draw_source_facts(const app::Session& session, Ui& ui) {
  const app::SourceState& source = session.source;
  const app::SourceOptions& from = session.document.source;
  row_text(ui, from.blend ? "Blend" : "File", source.name.empty() ? name_of(from) : source.name);
  const std::string made = grouped(static_cast<int64_t>(source.frames.size()));
  row_text(ui, "Frames", source.count ? made + " of " + grouped(*source.count) : made);
  const int frame = app::shown_frame(session);
  if (frame >= 0 && frame < ssize(source.frames)) {
    const app::KeptSource& kept = source.frames[frame];
    row_text(ui, "Points", grouped(kept.points) + (source.has_faces ? ", with faces" : ""));
    row_text(ui, "Confidence", figure(100 * kept.confidence, "%"));
    if (kept.flagged) warn(ui, kept.reason);
  }
  if (!source.decision.empty()) hint(ui, source.decision);
}

/// Who is in the scans; a click makes somebody the source.
void draw_people(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const auto& people = session.source.people;
  if (people.empty() || (people.size() < 2 && !session.source.has_scene)) return;
  std::vector<std::string> words = {"best", "largest"}, labels = {"Who is seen best", "Who has most points"};
  for (const app::PersonSeen& one : people)
    words.push_back(std::to_string(one.id)), labels.push_back("Person " + words.back());
  const std::string& wanted = session.document.source.person;
  const std::string count = people.size() == 1 ? "1 person" : std::to_string(people.size()) + " people";
  if (Table table(ui, "source.people", {{count}, {"Seen in", 84, true}}); table.open())
    for (size_t i = 0; i < people.size(); ++i) {
      const app::PersonSeen& one = people[i];
      if (table.row(one.id == session.source.person) && words[i + 2] != wanted)
        context.ask("source.person", {words[i + 2]});
      color_chip(ui, person_color(ui.theme(), one.id));
      table.cell(labels[i + 2] + (one.is_sure ? "" : ", unsure"));
      table.cell(grouped(one.frames) + (one.frames == 1 ? " frame" : " frames"));
    }
  ask_choice(context, {"source.person", "Performs", "Who of the scans the targets follow"}, labels, words,
             wanted.empty() ? "best" : wanted);
}

/// Whether a file of this name may hold a skeleton that moves.
bool may_move(const app::SourceOptions& source) {
  return source.motion.empty() && can_be(source.path, kMotion);
}

/// Its name where that is unique, else its number.
std::string word_for_clip(const std::vector<app::SourceClip>& clips, size_t i) {
  const auto called = [&](const app::SourceClip& clip) { return clip.name == clips[i].name; };
  const bool is_plain = !clips[i].name.empty() && clips[i].name != "longest" &&
                        clips[i].name.find_first_not_of("0123456789") != std::string::npos;
  return is_plain && std::count_if(clips.begin(), clips.end(), called) == 1 ? clips[i].name
                                                                            : std::to_string(i + 1);
}

std::string clip_label(const std::vector<app::SourceClip>& clips, size_t i) {
  return clips[i].name.empty() ? "animation " + std::to_string(i + 1) : clips[i].name;
}

/// The animations in the file, one of them chosen by a click.
void draw_clips(const app::SourceState& source, PanelContext& context) {
  constexpr size_t kSeen = 6;
  Ui& ui = context.ui;
  const auto& clips = source.clips;
  if (clips.size() == 1)
    return row_text(ui, "Animation", clip_label(clips, 0) + ", " + figure(clips[0].seconds, "s"));
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const float height = clips.size() > kSeen ? line * (static_cast<float>(kSeen) + 1.5f) : 0;
  Table table(ui, "source.clips",
              {{grouped(static_cast<int64_t>(clips.size())) + " animations"}, {"Length", 64, true}}, height);
  if (!table.open()) return;
  for (size_t i = 0; i < clips.size(); ++i) {
    const bool chosen = static_cast<int>(i) == source.clip;
    if (table.row(chosen) && !chosen) context.ask("source.clip", {word_for_clip(clips, i)});
    table.cell(clip_label(clips, i));
    table.cell(figure(clips[i].seconds, "s"));
  }
}

void draw_animation_fields(const app::SourceState& state, const app::SourceOptions& source,
                           PanelContext& context) {
  Ui& ui = context.ui;
  const std::string clip = source.clip.empty() ? "longest" : source.clip;
  if (!state.clips.empty())
    draw_clips(state, context);
  else if (const auto text =
               text_row(ui, {"source.clip", "Animation", "Its name or number, or longest"}, clip))
    context.ask("source.clip", {text->empty() ? "longest" : *text});
  ask_toggle(context, {"source.as_scan", "As a scan", "Uses its surface, not its skeleton"}, source.as_scan);
}

/// A table that belongs to the scans: buttons choose one and put it away.
void draw_table(const Control& control, const std::string& path, PanelContext& context) {
  Ui& ui = context.ui;
  const std::string& name = control.name;
  const bool is_on = !path.empty();
  const float side = ImGui::GetFrameHeight(), buttons = (is_on ? 2 : 1) * (side + ui.px(4));
  row(ui, control.label, control.explanation);
  const float width = std::max(1.f, ImGui::GetContentRegionAvail().x - buttons);
  ImGui::BeginChild((name + ".name").c_str(), {width, side});
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(is_on ? cut_name(file_name(path), width).c_str() : "off");
  if (is_on) tooltip(ui, path);
  ui.mark(name);
  ImGui::EndChild();
  ImGui::SameLine(0, ui.px(4));
  if (icon_button(ui, name + ".browse", Icon::Folder, {"Choose the table", "", false, false, 26}))
    context.ask("dialog.open", {control.command});
  if (!is_on) return;
  ImGui::SameLine(0, ui.px(4));
  if (icon_button(ui, name + ".reset", Icon::Reset,
                  {"No " + lower_case(control.label), "", false, false, 26}))
    context.ask(name, {"off"});
}

/// What scans alone have: their times, and the motion that they are completed to.
void draw_scan_fields(const app::SourceOptions& source, PanelContext& context) {
  if (!section(context.ui, "inspector.times", "Times and completion",
               !source.times.empty() || source.complete > 0))
    return;
  draw_table(
      {"source.times", "Times",
       "A table of when each scan was taken: its file or number, seconds. Off: one scan a frame, but for "
       "missing numbers",
       "source_times"},
      source.times, context);
  std::vector<std::string> choices = {"Off", "30", "60", "120"}, words = {"off", "30", "60", "120"};
  const std::string chosen = source.complete > 0 ? argument(source.complete) : "off";
  if (std::find(words.begin(), words.end(), chosen) == words.end())
    choices.push_back(chosen), words.push_back(chosen);
  ask_choice(
      context,
      {"source.complete", "Complete to",
       "Frames/s: one body is fitted to all scans, however few and sparse, and frames between them are "
       "made. Looks both ways"},
      choices, words, chosen);
  if (source.complete <= 0) return;
  draw_table({"source.markers", "Markers", "A table of named markers: seconds,name,x,y,z", "source_markers"},
             source.markers, context);
}

/// What is decided of a file where nobody says otherwise: folded away until somebody does.
void draw_source_import(const ImportOptions& import, PanelContext& context) {
  Ui& ui = context.ui;
  const auto is_chosen = [](const std::string& word) { return !word.empty() && word != "auto"; };
  const bool is_told = is_chosen(import.units) || is_chosen(import.up) || import.height || import.floor ||
                       import.turn_deg != 0;
  if (!section(ui, "inspector.import", "Size, axes and floor", is_told)) return;
  draw_import(context, "source", import);
  if (const auto deg =
          typed_number_row(ui, {"source.turn", "Turn by", "Degrees about the vertical"}, import.turn_deg, 1))
    context.ask("source.turn", {argument(*deg)});
  const std::string floor = import.floor ? argument(*import.floor) : "auto";
  if (const auto text = text_row(ui, {"source.floor", "Floor", "Its height in metres, or auto"}, floor)) {
    const auto height = parse_number(*text);
    context.ask("source.floor", {height ? argument(*height) : "auto"});
  }
}

void draw_source_fields(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const app::SourceOptions& source = session.document.source;
  const std::string fps = source.fps > 0 ? argument(source.fps) : "auto";
  if (const auto text =
          text_row(ui, {"source.fps", "Frames/s", "auto: the file's own, as the times tell, or 30"}, fps))
    context.ask("source.fps", {argument(std::max(0.0, parse_number(*text).value_or(0)))});
  if (source.motion.empty() && session.source.clips.empty()) draw_scan_fields(source, context);
  if (may_move(source)) draw_animation_fields(session.source, source, context);
  draw_source_import(source.import, context);
  const app::Take* take = session.document.takes.empty() ? nullptr : &session.document.takes.front();
  const std::string extractor = take != nullptr ? take->method.extractor : extractors().front().name;
  ask_method(context, {"source.extractor", "Extractor", "The network that finds the joints"}, extractors(),
             extractor);
}

/// What a blend is made of, a share each.
void draw_blend(const app::BlendRecipe& blend, PanelContext& context) {
  Ui& ui = context.ui;
  for (size_t i = 0; i < blend.parts.size(); ++i) {
    const app::BlendPart& part = blend.parts[i];
    const std::string k = std::to_string(i), frames = in_words(part).substr(part.path.size());
    const std::string name = cut_name(file_name(part.path), 0.34f * ImGui::GetContentRegionAvail().x);
    ask_number(context,
               {"source.blend." + k, name,
                part.path + (frames.empty() ? ", its best step" : ", frames " + frames.substr(1)),
                "source.blend_weight " + k},
               part.weight, {0, 1, 0.005f, "%.2f"});
  }
  if (const auto cycles = typed_number_row(
          ui, {"source.blend_cycles", "Cycles", "How often the movement is played, one after the other"},
          blend.cycles, 0))
    context.ask("source.blend_cycles", {argument(*cycles)});
}

/// Only skeletal motions are blended, and four at most.
void draw_blend_with(const app::Session& session, PanelContext& context) {
  const app::SourceOptions& source = session.document.source;
  const bool moves = !session.source.clips.empty() && !source.as_scan;
  if (!moves && !source.blend) return;
  ask_button(context,
             {"source.blend_with", "Blend with\u2026",
              "With another motion: of this one the frames between the loop marks, else its best step",
              "dialog.open blend_with"},
             !source.blend || source.blend->parts.size() < 4);
}

void draw_source(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "inspector.source", "Source")) return;
  if (session.document.source.path.empty()) {
    hint(ui, "No source is open. Drop a folder of scans, a motion or 2D poses anywhere, or choose one.");
  } else if (session.document.flat) {
    draw_flat_source(session, context);
  } else {
    draw_source_facts(session, ui);
    draw_people(session, context);
    if (const auto& blend = session.document.source.blend)
      draw_blend(*blend, context);
    else
      draw_source_fields(session, context);
    draw_blend_with(session, context);
  }
  ask_button(context,
             {"source.open", "Open source\u2026", "A scan, a motion or 2D poses", "dialog.open open_source"});
}

void draw_takes(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "inspector.takes", "Takes")) return;
  const auto& takes = session.document.takes;
  if (takes.empty())
    hint(ui, "No target yet. Drop a character, or a person's 2D poses, anywhere, or add one.");
  for (size_t i = 0; i < takes.size(); ++i) {
    const std::string k = std::to_string(i), name = "take." + k;
    const IdScope id(name);
    const bool selected = static_cast<int>(i) == session.selected_take;
    const app::Method& method = takes[i].method;
    const std::string how =
        takes[i].flat ? takes[i].flat->engine : method.engine + (method.offsets ? "" : ", no offsets");
    const float room = ImGui::CalcTextSize(how.c_str()).x + ui.px(14);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (ImGui::Selectable("##take", selected, 0, {0, ImGui::GetTextLineHeight() + ui.px(6)}))
      context.ask("target.select", {k});
    ui.mark(name);
    ui.stop(name);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = at.y + ui.px(3);
    list.AddText({at.x + ui.px(6), y}, color(ui.theme().text),
                 cut_name(takes[i].name, width - room - ui.px(10)).c_str());
    list.AddText({at.x + width - room + ui.px(8), y}, color(ui.theme().text_dim), how.c_str());
  }
  const app::Take* take = selected_take(session);
  ButtonRow buttons(2);
  buttons.ask(context, {"take.add", "Add target\u2026", "", "dialog.open open_target"});
  buttons.ask(context,
              {"method.compare", "Compare with\u2026",
               "Adds a second take of this target, made with another method", "dialog.open compare"},
              take != nullptr);
  const std::string label = take == nullptr ? "Remove" : "Remove " + take->name;
  ask_button(
      context,
      {"take.remove", cut_name(label, ImGui::GetContentRegionAvail().x - ui.px(28)),
       "Removes the current take; can be undone", "target.remove " + std::to_string(session.selected_take)},
      take != nullptr);
}

/// How much of it the shape binds; the view can be coloured by it.
void draw_binding(const SafeBinding& binding, Ui& ui) {
  if (binding.note.empty())
    hint(ui, "Bound by the network everywhere.");
  else
    hint(ui, binding.note + ".");
  ui.mark("target.binding");
}

void draw_target_facts(const app::TakeState& state, Ui& ui) {
  if (!state.problem.empty()) warn(ui, state.problem);
  const auto& shown = state.target ? state.target : state.as_loaded;
  if (!shown) {
    if (state.problem.empty()) hint(ui, "Reading\u2026");
    return;
  }
  const Mesh& mesh = shown->mesh;
  row_text(ui, "Vertices", grouped(mesh.vertices.rows()));
  row_text(ui, "Faces", grouped(mesh.faces.rows()));
  if (mesh.vertices.rows() > 0) {
    const auto y = mesh.vertices.col(1);
    row_text(ui, "Height now", figure(y.maxCoeff() - y.minCoeff(), "m"));
  }
  if (!state.target) {
    if (state.problem.empty()) hint(ui, "Finding its joints and skin weights\u2026");
    return;
  }
  row_text(ui, "Joints", std::to_string(kJointCount) + " found in the T-pose");
  if (state.binding) draw_binding(*state.binding, ui);
  for (const std::string& warning : state.target->warnings) warn(ui, warning);
  if (const std::string unseen = unseen_sentence(state.limbs); !unseen.empty()) warn(ui, unseen);
}

void draw_proportions(const app::Method& method, PanelContext& context, const std::string& k) {
  for (const app::Proportion& one : app::kProportions) {
    const std::string name = std::string("target.") + one.name;
    const float speed = (one.range.high - one.range.low) / 500;
    ask_number(context, {name, one.label, one.explanation, name + " " + k}, method.*one.value,
               {one.range.low, one.range.high, speed, one.format, app::Method().*one.value, true});
  }
}

/// How the target stands where the source is in T-pose: turned in the view, back to the T-pose by a reset.
void draw_rest_pose(const app::Session& session, const app::Take& take, PanelContext& context,
                    const std::string& k) {
  const bool edited = session.tool == app::Tool::RestPose;
  const app::TakeState* state = selected_state(session);
  ButtonRow buttons(2);
  buttons.ask(
      context,
      {"target.rest_pose", edited ? "Done" : "Edit rest pose",
       edited ? "Back to the result"
              : "Turn bones until the target stands like the source's T-pose, for example when its arms hang",
       edited ? "tool look" : "tool rest-pose"},
      edited || (state != nullptr && state->target != nullptr));
  buttons.ask(context,
              {"edit.rest_pose_clear", "Reset rest pose", "Back to the T-pose; can be undone",
               "edit.rest_pose_clear " + k},
              !take.target_edits.rest_pose.empty());
  if (!edited) return;
  ask_toggle(context,
             {"target.rest_mirror", "Both sides", "The bone on the other side follows", "tool.mirror"},
             session.mirror_joint);
  hint(context.ui, "Click a joint of the target and drag its rings; the result follows.");
}

/// Of several people in the scans the one whom this target performs.
void draw_performed(const app::Session& session, const app::Take& take, PanelContext& context,
                    const std::string& k) {
  const auto& people = session.source.people;
  if (people.size() < 2 && take.person.empty()) return;
  std::vector<std::string> words = {"source"}, labels = {"Who the source is"};
  for (const app::PersonSeen& one : people)
    words.push_back(std::to_string(one.id)), labels.push_back("Person " + words.back());
  const std::string chosen = take.person.empty() ? "source" : take.person;
  if (std::find(words.begin(), words.end(), chosen) == words.end())
    words.push_back(chosen), labels.push_back("Person " + chosen + ", not seen yet");
  ask_choice(context,
             {"take.person", "Performs", "Whom of the scans this target performs", "take.person " + k},
             labels, words, chosen);
}

void draw_target_facts(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const app::Take* take = selected_take(session);
  if (take == nullptr || !section(ui, "inspector.target", take_title(session, "Target"))) return;
  const std::string k = std::to_string(session.selected_take);
  if (const auto name = text_row(ui, {"take.name", "Name", ""}, take->name))
    if (!name->empty()) context.ask("take.rename", {k, *name});
  row_text(ui, "File", file_name(take->target.path));
  draw_performed(session, *take, context, k);
  if (const app::TakeState* state = selected_state(session)) draw_target_facts(*state, ui);
  draw_import(context, "target", take->target.import, k);
  draw_target_turn(take->target, context, k);
  std::ostringstream betas;
  for (size_t i = 0; i < take->target.betas.size(); ++i)
    betas << (i > 0 ? "," : "") << argument(take->target.betas[i]);
  if (const auto text =
          text_row(ui, {"target.betas", "Shape", "Shape parameters of an SMPL-format body: 1.2, -0.5"},
                   betas.str(), "only SMPL bodies"))
    context.ask("target.betas", {k, *text});
  draw_proportions(take->method, context, k);
  draw_rest_pose(session, *take, context, k);
  ask_button(context, {"take.replace", "Replace\u2026", "", "dialog.open replace_target"});
}

void draw_filter(const app::Method& method, PanelContext& context, const std::string& k) {
  for (const app::MethodSwitch& s : app::kSwitches) {
    const std::string name = s.name;
    ask_toggle(context, {"method." + name, s.label, s.explanation, "method.filter " + k + " " + name},
               method.*s.on);
  }
  ask_toggle(context, {"method.predict", "Predict gaps", app::kPredictExplanation, "method.predict " + k},
             method.predict);
}

void draw_work(const app::Session& session, PanelContext& context) {
  ButtonRow buttons(2);
  if (session.paused)
    buttons.ask(context, {"work.resume", "Resume", "Processes the remaining frames"});
  else
    buttons.ask(context, {"work.pause", "Pause", "Stops processing frames until you resume"},
                possible(session, "work.pause"));
  buttons.ask(context, {"work.restart", "Recompute", "Computes every frame again"},
              possible(session, "work.restart"));
}

void draw_method(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const app::Take* take = selected_take(session);
  if (take == nullptr || !section(ui, "inspector.method", take_title(session, "Method"))) return;
  const std::string k = std::to_string(session.selected_take);
  const app::Method& method = take->method;
  ask_method(
      context,
      {"method.engine", "Transfer",
       "The method that transfers the motion to the target; " + help_of(engines()), "method.engine " + k},
      engines(), method.engine);
  ask_method(context,
             {"method.extractor", "Extractor", "The network that finds the joints in a scan",
              "method.extractor " + k},
             extractors(), method.extractor);
  ask_toggle(context, {"method.offsets", "Offsets", app::kOffsetsExplanation, "method.offsets " + k},
             method.offsets);
  ask_choice(context, {"method.path", "Path", app::kPathExplanation, "method.path " + k, path_tips()},
             {"Scaled", "Original", "In place"}, {kRootNames.begin(), kRootNames.end()},
             kRootNames[static_cast<int>(method.path)]);
  draw_filter(method, context, k);
  draw_work(session, context);
}

}  // namespace

void draw_inspector(const app::Session& session, PanelContext& context) {
  draw_source(session, context);
  draw_takes(session, context);
  const app::Take* const take = selected_take(session);
  if (take != nullptr && take->flat) return draw_flat_take(session, context);
  draw_target_facts(session, context);
  draw_rig(session, context);
  draw_performance(session, context);
  draw_method(session, context);
}

}  // namespace understudy::ui
