#include "ui/panels/made_motions.hpp"

#include <algorithm>

#include "app/session/made_motions.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

constexpr int kMostGhosts = 12;  // that are seen beside each other

struct MadeMotionsPanelState {
  app::GenerationOptions how;
  int clip = -1;  ///< of the document, chosen
  MadeMotionsPanelState() { how.count = 3; }
};

struct MadeDrawing {
  const app::Session& session;
  PanelContext& context;
  MadeMotionsPanelState& state;
  const app::MadeMotionsState& made() const { return session.made_motions; }
  Ui& ui() const { return context.ui; }
};

/// The marks of the timeline, where both are set.
std::optional<app::FramesBetween> marked(const app::Session& session) {
  const app::Playback& playback = session.playback;
  if (playback.in < 0 || playback.out <= playback.in) return std::nullopt;
  return app::FramesBetween{playback.in, playback.out};
}

app::FramesBetween whole_clip(const DiscoveredRig& rig) {
  const int last = static_cast<int>(ssize(rig.found.motion.poses)) - 1;
  return {rig.first_frame, rig.first_frame + last};
}

/// A whole number to type, from low to high.
template <class Number>
void whole_row(Ui& ui, const Control& control, Number& value, double low, double high) {
  if (const auto typed = typed_number_row(ui, control, static_cast<double>(value), 0))
    value = static_cast<Number>(std::clamp(*typed, low, high));
}

void draw_between(const MadeDrawing& d) {
  auto& between = d.state.how.between;
  const auto marks = marked(d.session);
  bool on = between.has_value();
  if (toggle_row(d.ui(),
                 {"generate.between", "Between frames",
                  "Begins in the pose of one frame and ends in that of another"},
                 on)) {
    between.reset();
    if (on) between = marks.value_or(whole_clip(*d.session.bones.rig)), d.state.how.loop = false;
  }
  if (!between) return;
  whole_row(d.ui(), {"generate.first", "From frame", "Its pose is the first one"}, between->first, 0, 1e9);
  whole_row(d.ui(), {"generate.last", "To frame", "Its pose is the last one"}, between->last, 0, 1e9);
  ButtonOptions options;
  options.width = -1, options.disabled = !marks;
  options.tooltip = marks ? "The two frames that are marked in the timeline"
                          : "Mark two frames in the timeline first, with I and O";
  if (button(d.ui(), "generate.marks", "Take In and Out", options)) between = marks;
}

void draw_engine(const MadeDrawing& d) {
  const auto& engines = app::generation_engines();
  std::vector<std::string> labels, tips;
  int chosen = 0;
  for (const app::GenerationEngine& engine : engines) {
    if (d.state.how.engine == engine.name) chosen = static_cast<int>(ssize(labels));
    labels.emplace_back(engine.label);
    tips.push_back("It " + std::string(engine.sentence) + ".");
  }
  const Control control{"generate.engine", "Engine", "How they are made", "", tips};
  if (choice_row(d.ui(), control, labels, chosen))
    d.state.how.engine = engines[static_cast<size_t>(chosen)].name;
}

std::string make_line(const app::GenerationOptions& how) {
  std::string line = "generate.make " + std::to_string(how.frames);
  if (how.between) line += printed(" between %d %d", how.between->first, how.between->last);
  if (how.loop) line += " loop";
  return line + printed(" count %d seed %llu engine ", how.count, static_cast<unsigned long long>(how.seed)) +
         how.engine;
}

/// The button tells why it cannot be used.
void draw_make(const MadeDrawing& d) {
  const std::string why_not = failure_of([&] { app::check_making(d.session, d.state.how); });
  ask_button(d.context,
             {"generate.make", "Make them", why_not.empty() ? "Each seed is another motion" : why_not + ".",
              make_line(d.state.how)},
             why_not.empty());
  if (!why_not.empty()) hint(d.ui(), why_not + ".");
}

void draw_wish(const MadeDrawing& d) {
  app::GenerationOptions& how = d.state.how;
  whole_row(d.ui(), {"generate.frames", "Frames", "Of each motion, at the clip's rate"}, how.frames, 2,
            10000);
  draw_between(d);
  if (!how.between)
    toggle_row(d.ui(), {"generate.loop", "Loop", "Ends in the pose that it begins with"}, how.loop);
  whole_row(d.ui(), {"generate.count", "Motions", "Each from a seed of its own"}, how.count, 1, kMostGhosts);
  whole_row(d.ui(), {"generate.seed", "First seed", "The same seed gives the same motion"}, how.seed, 0, 1e9);
  draw_engine(d);
  if (d.made().job != 0)
    job_progress(d.session, d.context, "generate.work", d.made().job, d.made().share, "Making motions");
  else
    draw_make(d);
}

float table_height(ptrdiff_t rows) {
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  return line * (static_cast<float>(std::min<ptrdiff_t>(rows, 8)) + 1.6f);
}

void draw_motion(const MadeDrawing& d, Table& table, uint64_t seed, const std::string& name,
                 const app::GeneratedMotion* made) {
  color_chip(d.ui(), made_color(seed));
  table.cell(name);
  table.cell(made != nullptr ? std::to_string(made->motion.poses.size()) : "");
  table.cell(made != nullptr ? printed("%.1f", 1000 * made->nearest_m) : "\u2026");
}

void draw_offered(const MadeDrawing& d) {
  const auto& offered = d.made().offered;
  if (offered.empty()) return;
  {
    Table table(d.ui(), "generate.offered",
                {{"Made"}, {"Frames", 52, true}, {"New by, mm", 78, true}, {"", 38}},
                table_height(ssize(offered)));
    for (const app::MadeMotion& one : offered) {
      if (!table.open()) break;
      const bool kept = app::clip_of(d.session.document, one.how) >= 0;
      if (table.row(false, !kept)) d.context.ask("generate.keep", {std::to_string(one.how.seed)});
      draw_motion(d, table, one.how.seed, "Seed " + std::to_string(one.how.seed), one.made.get());
      table.cell(kept ? "kept" : "");
    }
  }
  hint(d.ui(), "A click keeps one as a clip. New by: how far it is from any piece of the clip; 0 is a copy.");
  if (!d.made().remark.empty()) warning_sentence(d.ui(), d.made().remark + ".");
  ask_button(d.context, {"generate.clear", "Drop those that were not kept", "What was kept stays"});
}

void draw_clips(const MadeDrawing& d) {
  const auto& clips = d.session.document.bones.clips;
  int& chosen = d.state.clip;
  if (chosen >= ssize(clips)) chosen = -1;
  if (clips.empty()) return;
  {
    Table table(d.ui(), "generate.clips", {{"Clip"}, {"Frames", 52, true}, {"New by, mm", 78, true}},
                table_height(ssize(clips)));
    for (int i = 0; table.open() && i < ssize(clips); ++i) {
      const app::MadeClip& clip = clips[static_cast<size_t>(i)];
      if (table.row(i == chosen)) chosen = i == chosen ? -1 : i;
      const auto* const made = at_or_null(d.made().clips, i);
      draw_motion(d, table, clip.how.seed, clip.name, made != nullptr ? made->get() : nullptr);
    }
  }
  if (!d.made().problem.empty()) hint(d.ui(), d.made().problem + ".");
  if (chosen < 0) return hint(d.ui(), "The exported rig has these clips. Choose one to rename or remove it.");
  const std::string k = std::to_string(chosen);
  if (const auto name = text_row(d.ui(), {"generate.name", "Name"}, clips[static_cast<size_t>(chosen)].name))
    d.context.ask("generate.rename", {k, *name});
  ask_button(d.context, {"generate.remove", "Remove this clip", "Can be undone", "generate.remove " + k});
}

}  // namespace

void draw_made_motions(const app::Session& session, PanelContext& context) {
  if (!section(context.ui, "bones.made", "More of its motion")) return;
  const MadeDrawing d{session, context, panel_state<MadeMotionsPanelState>(context)};
  draw_wish(d);
  if (d.made().offered.empty() && session.document.bones.clips.empty()) return;
  ask_choice(context,
             {"generate.ghosts", "Ghosts", "These motions in the view, over the body or beside it",
              "view.made_motions"},
             {"Off", "Over", "Beside"}, {app::kBoneSurfaceNames.begin(), app::kBoneSurfaceNames.end()},
             app::kBoneSurfaceNames[static_cast<size_t>(session.view.made_motions)]);
  draw_offered(d);
  draw_clips(d);
}

}  // namespace understudy::ui
