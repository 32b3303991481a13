#include "ui/panels/flat.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/run/flat_figures.hpp"
#include "app/run/flat_performance.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

constexpr float kEndOn = 0.75f;         // of its length that a bone looks where it lies across the view
constexpr float kLongestShare = 0.34f;  // of the stature, at the bars' right end

/// Both sides of a bone, or the bone alone.
struct Limb {
  const char *words, *verb;
  int bone;
};
constexpr std::array<Limb, 8> kLimbs = {{{"The trunk", "is", flat_bone::Trunk},
                                         {"The head", "is", flat_bone::Head},
                                         {"The shoulders", "are", flat_bone::LeftShoulder},
                                         {"Upper arms", "are", flat_bone::LeftUpperArm},
                                         {"Forearms", "are", flat_bone::LeftForearm},
                                         {"The hips", "are", flat_bone::LeftHip},
                                         {"Thighs", "are", flat_bone::LeftThigh},
                                         {"Shins", "are", flat_bone::LeftShin}}};

std::string seen_how(const app::FlatReference& reference, int bone) {
  const Proportions& lengths = reference.target.lengths;
  const std::string where =
      lengths.poses == 1 ? "in the one picture" : "in all " + grouped(lengths.poses) + " pictures";
  if (!reference.target.standing) return "the file says so";
  const BoneLengths seen = seen_lengths(*reference.target.standing);
  const int other = kFlatBoneMirror[static_cast<size_t>(bone)];
  const float longest = std::max(seen[bone], seen[other]);
  if (longest <= 0) return "not seen " + where;
  return longest < kEndOn * lengths.length[bone] ? "seen end-on " + where
                                                 : "seen too short or too rarely " + where;
}

/// A bone's three lengths as shares of their people's statures, and the doubt of the middle one.
struct Bars {
  float source = 0, reference = 0, result = 0, doubt = 0;
};

Bars bars_of(const app::Session& session, const app::FlatResult& result, int bone) {
  const Proportions& known = result.reference->target.lengths;
  Bars bars;
  if (const auto& poses = session.flat.poses)
    bars.source = poses->lengths.length[bone] / stature_of(poses->lengths.length);
  bars.reference = known.length[bone] / stature_of(known.length);
  bars.result = result.lengths.length[bone] / stature_of(known.length);
  bars.doubt = known.doubt[bone];
  return bars;
}

void draw_bars(Ui& ui, const std::string& name, const Bars& bars, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetFrameHeight(), bar = std::floor(height / 4.5f), gap = ui.px(1.5f);
  ImGui::Dummy({width, height});
  tooltip(ui,
          printed("Of the stature: source %.1f %%, reference %.1f %% (\u00b1 %.0f %% of it), result %.1f %%",
                  100 * static_cast<double>(bars.source), 100 * static_cast<double>(bars.reference),
                  100 * static_cast<double>(bars.doubt), 100 * static_cast<double>(bars.result)));
  ui.mark(name);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto x = [&](float share) { return at.x + width * std::clamp(share / kLongestShare, 0.f, 1.f); };
  float y = at.y + 0.5f * (height - 3 * bar - 2 * gap);
  const auto draw = [&](float share, const ImVec4& ink, float opacity) {
    list.AddRectFilled({at.x, y}, {x(share), y + bar}, color(ink, opacity), ui.px(1.5f));
    y += bar + gap;
  };
  const Theme& look = ui.theme();
  draw(bars.source, look.text_faint, 1);
  const float middle = y + 0.5f * bar;
  draw(bars.reference, look.text_dim, 1);
  draw(bars.result, look.accent, 1);
  if (bars.doubt <= 0) return;
  const ImU32 ink = color(bars.doubt > app::kUncertainLength ? look.warning : look.text);
  const float low = x(bars.reference * std::exp(-bars.doubt)),
              high = x(bars.reference * std::exp(bars.doubt));
  list.AddLine({low, middle}, {high, middle}, ink, ui.px(1.5f));
  for (const float end : {low, high})
    list.AddLine({end, middle - bar}, {end, middle + bar}, ink, ui.px(1.5f));
}

void draw_bone(const app::Session& session, const app::Take& take, const app::FlatResult& result, int bone,
               PanelContext& context) {
  Ui& ui = context.ui;
  const FlatBone& names = kFlatBones[static_cast<size_t>(bone)];
  const std::string name = names.name, k = std::to_string(session.selected_take);
  const app::ChosenLength* const chosen = app::chosen_length(*take.flat, name);
  const bool locked = chosen != nullptr && chosen->locked;
  const float side = ImGui::GetFrameHeight(), field = ui.px(86), gap = ui.px(6);
  row(ui, names.label, "", ui.px(112));
  draw_bars(ui, "flat.bar." + name, bars_of(session, result, bone),
            std::max(ui.px(20), ImGui::GetContentRegionAvail().x - field - side - 2 * gap));
  ImGui::SameLine(0, gap);
  const float read = result.reference->target.lengths.length[bone];
  // While it is dragged, what was chosen last: it is performed some frames later.
  float pixels = chosen ? chosen->pixels : result.lengths.length[bone];
  ImGui::BeginChild(("##" + name).c_str(), {field, side});
  const NumberOptions options{
      app::kBonePixels.low, 4000, std::max(0.02f, read / 200), "%.1f px", read, !locked};
  ImGui::BeginDisabled(locked);
  if (number(ui, "flat.length." + name, pixels, options))
    context.ask("flat.length", {k, name, pixels == read ? "auto" : argument(static_cast<double>(pixels))});
  ImGui::EndDisabled();
  ImGui::EndChild();
  ImGui::SameLine(0, gap);
  const char* const words =
      locked ? "Locked: stays when the other side or the whole person is changed" : "Lock this length";
  if (icon_button(ui, "flat.lock." + name, Icon::Lock, {words, "", locked, false, 26}))
    context.ask("flat.lock", {k, name, on_off(!locked)});
}

void draw_key(Ui& ui) {
  const std::array<std::pair<const char*, ImVec4>, 3> bars = {
      {{"source", ui.theme().text_faint}, {"reference", ui.theme().text_dim}, {"result", ui.theme().accent}}};
  for (const auto& [words, ink] : bars) {
    color_chip(ui, ink);
    ImGui::TextUnformatted(words);
    ImGui::SameLine(0, ui.px(14));
  }
  ImGui::NewLine();
}

void draw_proportions_tools(const app::Take& take, PanelContext& context, const std::string& k) {
  ButtonRow sizes(2);
  sizes.ask(context, {"flat.smaller", "Smaller", "All lengths that are not locked, by 5 %",
                      "flat.scale " + k + " 0.95"});
  sizes.ask(context, {"flat.larger", "Larger", "All lengths that are not locked, by 5 %",
                      "flat.scale " + k + " 1.05"});
  ButtonRow files(2);
  files.ask(context, {"flat.load", "Load\u2026", "Lengths that were saved", "dialog.open load_proportions"});
  files.ask(context, {"flat.save", "Save\u2026", "These lengths, for another picture or the command line",
                      "dialog.open save_proportions"});
  ask_button(
      context,
      {"flat.lengths_clear", "As read", "Forgets all lengths that were chosen", "flat.lengths_clear " + k},
      !take.flat->lengths.empty());
}

void draw_proportions(const app::Session& session, const app::Take& take, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "inspector.proportions", take_title(session, "Proportions"))) return;
  const app::TakeState* const state = selected_state(session);
  if (state == nullptr || !state->flat) return hint(ui, "Reading\u2026");
  const app::FlatResult& result = *state->flat;
  const Proportions& lengths = result.reference->target.lengths;
  const std::string pictures = lengths.poses == 0   ? "From a file of proportions"
                               : lengths.poses == 1 ? "From 1 picture"
                                                    : "From " + grouped(lengths.poses) + " pictures";
  const bool ahead = session.document.flat && session.document.flat->ahead;
  hint(
      ui,
      pictures +
          (ahead ? ". The source's are read off its whole file before the first frame, for proportions alone."
                 : ". The source's are learned as its frames come."));
  for (const std::string& sentence : cures_of(*result.reference)) warning_sentence(ui, sentence);
  ui.mark("flat.cure");
  draw_key(ui);
  for (int bone = 0; bone < kFlatBoneCount; ++bone) draw_bone(session, take, result, bone, context);
  draw_proportions_tools(take, context, std::to_string(session.selected_take));
}

void draw_manner(const app::Session& session, const app::Take& take, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "inspector.manner", take_title(session, "Performance"))) return;
  const std::string k = std::to_string(session.selected_take);
  ask_choice(
      context,
      {"flat.place",
       "Stands",
       "Where the result begins",
       "flat.place " + k,
       {"Where the person stands in the picture, as large as there", "Where the source stands, in its size"}},
      {"On the reference", "In place"}, {kFlatPlaceNames.begin(), kFlatPlaceNames.end()},
      kFlatPlaceNames[static_cast<size_t>(take.flat->place)]);
  ask_toggle(context,
             {"flat.touches", "Touches", "Hands that touch the body or each other keep touching",
              "flat.touches " + k},
             take.flat->touches);
  ask_toggle(
      context,
      {"flat.growth", "Grows", "Who comes nearer grows; off: as large as the reference", "flat.growth " + k},
      take.flat->growth);
  if (flat_engines().size() > 1)
    ask_method(context, {"flat.engine", "Engine", help_of(flat_engines()), "flat.engine " + k},
               flat_engines(), take.flat->engine);
  ask_number(context,
             {"flat.reference", "Picture", "How bright the picture behind is shown", "view.reference"},
             session.view.reference, {0, 1, 0.005f, "%.2f"});
  const app::TakeState* const state = selected_state(session);
  if (state == nullptr || !state->flat) return;
  for (const auto& [key, value] : state->flat->figures)
    if (const app::FlatFigure* const known = app::find_flat_figure(key))
      row_text(ui, known->label, figure(value, known->unit));
}

void draw_edits(const std::vector<TrackEdit>& edits, PanelContext& context) {
  Ui& ui = context.ui;
  for (size_t i = 0; i < edits.size(); ++i) {
    const std::string number = std::to_string(i);
    if (icon_button(ui, "flat.edit." + number, Icon::Trash, {"Remove this edit", "", false, false, 22}))
      context.ask("flat.edit_remove", {number});
    ImGui::SameLine(0, ui.px(6));
    text_cut(ui, edit_words(edits[i]));
  }
}

/// Over the loop marks, or the frame shown.
void draw_by_hand(const app::Session& session, PanelContext& context) {
  const auto& edits = session.document.source.point_edits;
  Ui& ui = context.ui;
  const int frame = std::max(0, app::shown_frame(session));
  const bool marked = session.playback.in >= 0 && session.playback.out >= session.playback.in;
  const int first = marked ? session.playback.in : frame, last = marked ? session.playback.out : frame;
  const std::string range = std::to_string(first) + " " + std::to_string(last);
  const std::string words = marked ? "from " + std::to_string(first) + " to " + std::to_string(last)
                                   : "in frame " + std::to_string(frame);
  tool_button(session, context,
              {"flat.tool", "Drag points", "Drags points of who performs; Look around ends it"},
              app::Tool::Joints);
  ask_button(context,
             {"flat.exchange", "Exchange sides " + words,
              "Left and right, between the loop marks where they are set", "flat.exchange " + range});
  draw_edits(edits, context);
  if (edits.empty()) return;
  ask_button(context, {"edits_clear", "Points as read", "Forgets all edits of points"});
  hint(ui, "What is dragged or exchanged is performed at once.");
}

void draw_performer(const KeypointReading& reading, PanelContext& context) {
  if (reading.tracks.size() < 2) return;
  std::vector<std::string> words, labels;
  for (const KeypointTrack& track : reading.tracks) {
    words.push_back(std::to_string(track.person));
    labels.push_back("Person " + words.back() + ", " + grouped(ssize(track.poses)) + " frames");
  }
  ask_choice(context,
             {"source.person", "Performs", "Who of the picture; a click on them in the view chooses, too"},
             labels, words, std::to_string(reading.performing().person));
}

}  // namespace

std::string edit_words(const TrackEdit& edit) {
  if (const auto* const drag = std::get_if<PointDrag>(&edit)) {
    std::string point = kBodyPointNames[static_cast<size_t>(drag->point)];
    std::replace(point.begin(), point.end(), '_', ' ');
    return "Frame " + std::to_string(drag->frame) + ": " + point + " moved";
  }
  const SidesExchange& exchange = std::get<SidesExchange>(edit);
  const char* limbs[] = {"arms", "legs", "left and right"};
  return "Frames " + std::to_string(exchange.first) + " to " + std::to_string(exchange.last) + ": " +
         limbs[static_cast<int>(exchange.limbs)] + " exchanged";
}

std::vector<std::string> cures_of(const app::FlatReference& reference) {
  const Proportions& lengths = reference.target.lengths;
  std::vector<std::string> sentences;
  for (const Limb& limb : kLimbs) {
    if (lengths.doubt[limb.bone] <= app::kUncertainLength) continue;
    const bool is_one = std::string(limb.verb) == "is";
    sentences.push_back(std::string(limb.words) + " " + limb.verb +
                        " uncertain: " + seen_how(reference, limb.bone) + ". One in which " +
                        (is_one ? "it lies" : "they lie") + " across the view would tell.");
  }
  return sentences;
}

void draw_flat_source(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const auto& poses = session.flat.poses;
  row_text(ui, "File", session.source.name.empty() ? name_of(session.document.source) : session.source.name);
  if (!poses) {
    hint(ui, session.source.problem.empty() ? "Reading\u2026" : session.source.problem);
    return;
  }
  const KeypointReading& reading = poses->reading;
  row_text(ui, "Format", reading.format + ", " + reading.layout);
  row_text(ui, "Frames", grouped(ssize(reading.frames)) + ", " + figure(reading.fps, "a second"));
  row_text(ui, "Canvas", canvas_text(reading.canvas) + (reading.canvas_is_guessed ? ", guessed" : ""));
  const int frame = app::shown_frame(session);
  if (const CleanPose* const clean = at_or_null(poses->clean, frame)) {
    row_text(
        ui, "Points",
        std::to_string(points_seen(clean->pose)) + " of 25" +
            (clean->points_filled > 0 ? ", " + std::to_string(clean->points_filled) + " carried on" : ""));
    if (!clean->problem.empty()) warning_sentence(ui, clean->problem);
  }
  draw_performer(reading, context);
  if (performs_in_space(session.document))
    ask_choice(context, {"view.lifted", "Shown", "The picture, or the skeleton that characters perform"},
               {"Flat", "Lifted"}, {"off", "on"}, on_off(session.view.lifted));
  const app::FlatSource& flat = *session.document.flat;
  ask_number(context,
             {"flat.smoothing", "Smoothing", "0: points stay where they were seen; 1: as the track jitters"},
             session.document.source.smoothing,
             {app::kFlatSmoothing.low, app::kFlatSmoothing.high, 0.01f, "%.2f", 1, true});
  ask_toggle(context,
             {"flat.ahead", "Read ahead",
              "Proportions are read off the whole file before its first frame, so "
              "that limbs do not grow while it plays"},
             flat.ahead);
  draw_by_hand(session, context);
}

void draw_flat_take(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const app::Take& take = *selected_take(session);
  const std::string k = std::to_string(session.selected_take);
  if (section(ui, "inspector.target", take_title(session, "Target"))) {
    if (const auto name = text_row(ui, {"take.name", "Name", ""}, take.name))
      if (!name->empty()) context.ask("take.rename", {k, *name});
    row_text(ui, "File", file_name(take.target.path));
    const app::TakeState* const state = selected_state(session);
    if (state != nullptr && !state->problem.empty()) warning_sentence(ui, state->problem);
    if (state != nullptr && state->flat) {
      std::string told;
      for (const std::string& sentence : state->flat->reference->told) {
        const std::string path = take.target.path + ": ";
        append_item(told, starts_with(sentence, path) ? sentence.substr(path.size()) : sentence, "; ");
      }
      hint(ui, told);
      for (const std::string& remark : state->flat->reference->target.remarks)
        warning_sentence(ui, "Who stands there " + remark + ".");
    }
    ask_button(context, {"take.replace", "Replace\u2026", "", "dialog.open replace_target"});
  }
  draw_proportions(session, take, context);
  draw_manner(session, take, context);
}

}  // namespace understudy::ui
