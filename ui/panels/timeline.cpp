#include "ui/panels/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "retarget/base/text.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/performance.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

constexpr double kRates[] = {0.1, 0.25, 0.5, 1, 2, 4};

struct Metric {
  std::string key, label;
  Values values;
};

/// What the timeline may carry: the series of the selected take, or the source's confidence.
std::vector<Metric> carried_metrics(const app::Session& session, const TimelineState& state) {
  std::vector<Metric> metrics;
  if (const app::TakeState* take = selected_state(session))
    for (const app::Series& series : take->series)
      metrics.push_back({series.key, series.unit.empty() ? series.label : series.label + ", " + series.unit,
                         series.values});
  const auto is_confidence = [](const Metric& m) { return m.key == "confidence"; };
  if (std::none_of(metrics.begin(), metrics.end(), is_confidence))
    metrics.push_back({"confidence", "Confidence", state.confidence});
  if (!state.bones_off_mm.empty()) metrics.push_back({"bones_off", "Bones off, mm", state.bones_off_mm});
  return metrics;
}

void transport_button(const app::Session& session, PanelContext& context, const char* name, Icon icon,
                      const Binding& what) {
  IconButtonOptions options{what.label, keys_of(context.commands, what.command, what.arguments), false,
                            !possible(session, what.command), 28};
  if (icon_button(context.ui, name, icon, options)) context.ask(what.command, what.arguments);
  ImGui::SameLine(0, context.ui.px(3));
}

void draw_transport(const app::Session& session, PanelContext& context) {
  const bool playing = session.playback.playing;
  transport_button(session, context, "timeline.first", Icon::ToStart,
                   {"", "playback.first", {}, "First frame"});
  transport_button(session, context, "timeline.back", Icon::StepBack,
                   {"", "playback.step_back", {}, "One frame back"});
  transport_button(session, context, "timeline.play", playing ? Icon::Pause : Icon::Play,
                   {"", "playback.toggle", {}, playing ? "Pause" : "Play"});
  transport_button(session, context, "timeline.forward", Icon::StepForward,
                   {"", "playback.step_on", {}, "One frame forward"});
  transport_button(session, context, "timeline.last", Icon::ToEnd, {"", "playback.last", {}, "Last frame"});
}

void draw_marks(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const app::Playback& playback = session.playback;
  const bool disabled = !possible(session, "playback.loop");
  ImGui::SameLine(0, ui.px(10));
  if (icon_button(ui, "timeline.loop", Icon::Loop,
                  {"Loops from the end to the start", keys_of(context.commands, "playback.loop"),
                   playback.loop, disabled, 28}))
    context.ask("playback.loop", {on_off(!playback.loop)});
  const auto word = [&](const char* name, const char* label, const char* command, const char* tip) {
    ImGui::SameLine(0, ui.px(3));
    ButtonOptions options;
    options.look = ButtonLook::Quiet, options.tooltip = tip, options.disabled = disabled;
    options.shortcut = keys_of(context.commands, command);
    if (button(ui, name, label, options)) context.ask(command);
  };
  word("timeline.in", "In", "playback.in", "Play from this frame");
  word("timeline.out", "Out", "playback.out", "Play up to this frame");
  ImGui::SameLine(0, ui.px(3));
  const bool none = playback.in < 0 && playback.out < 0;
  if (icon_button(ui, "timeline.clear_marks", Icon::Close, {"Play all frames", "", false, none, 28}))
    context.ask("playback.clear_marks");
  ImGui::SameLine(0, ui.px(3));
  if (icon_button(ui, "timeline.steps", Icon::Skeleton,
                  {"Marks steps, L and R; In and Out snap to them", "", session.view.steps, disabled, 28}))
    context.ask("view.steps", {on_off(!session.view.steps)});
  ImGui::SameLine(0, ui.px(3));
  if (icon_button(ui, "timeline.live", Icon::Clock,
                  {"Shows the newest frame while frames are processed", "", playback.live, disabled, 28}))
    context.ask("playback.follow_live");
}

void draw_rate(const app::Session& session, PanelContext& context) {
  std::vector<std::string> labels;
  int chosen = -1;
  for (const double rate : kRates) {
    if (std::abs(rate - session.playback.rate) < 1e-6) chosen = labels.size();
    labels.push_back(argument(rate) + " \u00d7");
  }
  if (chosen < 0) chosen = labels.size(), labels.push_back(argument(session.playback.rate) + " \u00d7");
  if (!dropdown(context.ui, "timeline.rate", labels, chosen) || chosen >= static_cast<int>(std::size(kRates)))
    return;
  context.ask("playback.rate", {argument(kRates[chosen])});
}

void draw_metric(PanelContext& context, const std::vector<Metric>& metrics, const std::string& key) {
  std::vector<std::string> labels;
  int chosen = -1;
  for (const Metric& metric : metrics) {
    if (metric.key == key) chosen = labels.size();
    labels.push_back(metric.label);
  }
  if (dropdown(context.ui, "timeline.metric", labels, chosen))
    context.ask("view.metric", {metrics[chosen].key});
}

/// "12 / 240" and "0:00.40", both to type into.
void draw_readout(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const int frame = app::shown_frame(session), known = known_frames(session);
  const DisabledScope disabled(frame < 0);
  const float height = ImGui::GetFrameHeight();
  ImGui::BeginChild("##frame", {ui.px(62), height});
  const auto typed = committed_text(ui, "timeline.frame", frame < 0 ? "" : std::to_string(frame), "-");
  ImGui::EndChild();
  if (const auto f = typed ? parse_number(*typed) : std::nullopt)
    context.ask("playback.frame", {argument(std::round(*f))});
  ImGui::SameLine(0, ui.px(6));
  ImGui::AlignTextToFramePadding();
  text_cut(ui, "/ " + std::to_string(std::max(0, known - 1)), ui.px(60));
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(ImGui::GetWindowWidth() - ui.px(12 + 76));
  ImGui::BeginChild("##time", {ui.px(76), height});
  const auto time =
      committed_text(ui, "timeline.time", clock_time(app::moment_of(session, std::max(frame, 0))));
  if (!app::clock_times(session).empty()) tooltip(ui, "Of the current take, at its tempo");
  ImGui::EndChild();
  if (!time) return;
  const size_t colon = time->find(':');
  const auto minutes =
      colon == std::string::npos ? std::optional<double>(0) : parse_number(time->substr(0, colon));
  const auto rest = parse_number(colon == std::string::npos ? *time : time->substr(colon + 1));
  if (minutes && rest) context.ask("playback.seek", {argument(60 * *minutes + *rest)});
}

/// Asks for what was done with a mark of an edit.
void answer_marks(PanelContext& context, const std::vector<EditMark>& edits, const TrackAnswer& answer) {
  if (answer.move) {
    const EditMark& edit = edits[answer.move->mark];
    const LoopRange& now = answer.move->frames;
    app::Arguments words = edit.move;
    words.push_back(std::to_string(now.first));
    const bool as_long = now.last - now.first == edit.mark.last - edit.mark.first;
    if (!as_long) words.push_back(std::to_string(now.last));
    context.ask("edit.move", words);
  }
  if (!answer.remove) return;
  const app::Arguments words = app::split_line(edits[*answer.remove].remove);
  context.ask(words[0], {words.begin() + 1, words.end()});
}

/// Asks to keep these frames, or all.
void answer_trim(const app::Session& session, PanelContext& context, const LoopRange& kept) {
  const std::string k = std::to_string(session.selected_take);
  if (kept.first == 0 && kept.last + 1 >= known_frames(session))
    context.ask("edit.trim", {k, "off"});
  else
    context.ask("edit.trim", {k, std::to_string(kept.first), std::to_string(kept.last)});
}

void draw_track(const app::Session& session, PanelContext& context, const TimelineState& state,
                const Metric* metric) {
  TrackData data;
  data.total = known_frames(session);
  data.processed = app::frame_count(session);
  data.current = std::max(0, app::shown_frame(session));
  data.fps = frames_per_second(session);
  data.times = app::clock_times(session);
  const app::FrameRange range = app::play_range(session.playback, data.processed);
  const bool marked = session.playback.in >= 0 || session.playback.out >= 0;
  if (marked && !range.empty()) data.loop = LoopRange{range.first, range.last};
  data.bad_frames = state.bad_numbers;
  if (metric != nullptr) data.curve = metric->values, data.curve_label = metric->label;
  auto& channel = panel_state<Channel>(context);
  channel.follow(session);
  if (!channel.label.empty()) {
    data.channel = {channel.values[0], channel.values[1], channel.values[2]};
    data.keys = channel.keys, data.curve_label = channel.label;
  }
  const std::vector<EditMark> edits = edit_marks(session, state.fills);
  for (const EditMark& edit : edits) data.marks.push_back(edit.mark);
  data.bands = contact_bands(session, state.standing);
  auto& phases = panel_state<PhaseBands>(context);
  phases.follow(session);
  data.bands.insert(data.bands.end(), phases.bands.begin(), phases.bands.end());
  if (!state.doubted.empty() && !session.source.no_person)
    data.bands.push_back({"bones_doubted", "The found bones are not to be trusted here", state.doubted, 1});
  if (session.view.steps) data.letters = state.steps.letters;
  const app::Take* take = selected_take(session);
  if (take != nullptr && take->pose_edits.trim)
    data.kept = LoopRange{take->pose_edits.trim->first, take->pose_edits.trim->last};
  data.describe = [&state](int frame) { return state.why(frame); };
  data.follow = session.playback.playing;
  data.height = ImGui::GetContentRegionAvail().y / context.ui.scale();
  const TrackAnswer answer = timeline_track(context.ui, "timeline.track", data);
  if (answer.seek && *answer.seek != data.current)
    context.ask("playback.frame", {std::to_string(*answer.seek)});
  answer_marks(context, edits, answer);
  if (answer.kept) answer_trim(session, context, *answer.kept);
  if (!answer.loop) return;
  if (answer.loop->first != range.first) context.ask("playback.in", {std::to_string(answer.loop->first)});
  if (answer.loop->last != range.last) context.ask("playback.out", {std::to_string(answer.loop->last)});
}

/// Why a run of frames is bad: of missing ones each has its own words.
std::string without_number(const std::string& why) {
  return ends_with(why, " is missing") ? "missing" : why;
}

}  // namespace

/// Of bones that have changed.
void TimelineState::follow_bones(const app::Session& session) {
  const auto& now = session.bones.rig;
  if (rig == now && (!now || bones_off_mm.size() == session.source.frames.size())) return;
  rig = now, looked = false;
  bones_off_mm.clear(), doubted.clear();
  if (!now) return;
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  for (int t = 0; t < static_cast<int>(session.source.frames.size()); ++t) {
    const int at = app::frame_of_rig(*now, t);
    const float off = at < 0 ? -1 : now->off_m[static_cast<size_t>(at)];
    bones_off_mm.push_back(off < 0 ? kUnknown : 1000 * off);
  }
  for (const app::BadFrame& bad_one : app::doubted_frames(session)) {
    if (!doubted.empty() && doubted.back().last + 1 == bad_one.frame)
      doubted.back().last = bad_one.frame;
    else
      doubted.push_back({bad_one.frame, bad_one.frame});
  }
}

void TimelineState::follow(const app::Session& session) {
  follow_bones(session);
  standing.follow(session);
  steps.follow(session);
  const app::SourceState& source = session.source;
  const size_t now = source.frames.size();
  if (source.generation != generation) {
    generation = source.generation, looked = false;
    confidence.clear();
  }
  confidence.resize(std::min(confidence.size(), now));
  for (size_t i = confidence.size(); i < now; ++i) confidence.push_back(source.frames[i].confidence);
  // Each look is at all frames: while they come, not at every one.
  const bool grew_enough = now < frames || now >= frames + std::max<size_t>(1, frames / 100);
  if (looked && now == frames) return;
  if (looked && !grew_enough && session.working) return;
  looked = true, frames = now;
  bad = app::bad_frames(session);
  bad_numbers.clear();
  fills.clear();
  for (const app::BadFrame& frame : bad) {
    bad_numbers.push_back(frame.frame);
    if (!source.frames[frame.frame].flagged) continue;
    const std::string why = without_number(frame.why);
    if (!fills.empty() && fills.back().last + 1 == frame.frame && fills.back().why == why)
      fills.back().last = frame.frame;
    else
      fills.push_back({frame.frame, frame.frame, why});
  }
}

std::string TimelineState::why(int frame) const {
  const auto found = std::lower_bound(bad_numbers.begin(), bad_numbers.end(), frame);
  if (found == bad_numbers.end() || *found != frame) return "";
  return bad[found - bad_numbers.begin()].why;
}

/// Without the track where there is no room for it.
void draw_timeline(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  auto& state = panel_state<TimelineState>(context);
  state.follow(session);
  const std::vector<Metric> metrics = carried_metrics(session, state);
  const float width = ImGui::GetContentRegionAvail().x, wide = width / ui.scale(),
              start = ImGui::GetCursorPosX();
  const auto field = [&](const char* id, float from_right, float size, const auto& draw) {
    ImGui::SameLine(start + width - ui.px(from_right));
    ImGui::BeginChild(id, {ui.px(size), ImGui::GetFrameHeight()});
    draw();
    ImGui::EndChild();
  };
  draw_transport(session, context);
  if (wide >= 580) draw_marks(session, context);
  if (wide >= 900) field("##rate", 218 + 180 + 96, 84, [&] { draw_rate(session, context); });
  if (wide >= 790)
    field("##metric", 218 + 180, 168, [&] { draw_metric(context, metrics, session.view.metric); });
  if (wide >= 366) {
    ImGui::SameLine(start + width - ui.px(210));
    draw_readout(session, context);
  } else {
    ImGui::NewLine();
  }
  if (ImGui::GetContentRegionAvail().y < ui.px(40)) return;
  const auto chosen = std::find_if(metrics.begin(), metrics.end(),
                                   [&](const Metric& m) { return m.key == session.view.metric; });
  draw_track(session, context, state, chosen == metrics.end() ? nullptr : &*chosen);
}

}  // namespace understudy::ui
