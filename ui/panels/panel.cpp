#include "ui/panels/panel.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "retarget/base/fields.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/panels.hpp"
#include "ui/widgets/plot.hpp"

namespace understudy::ui {
namespace {

/// Whether there are edits that a command of the menu Edit clears; nothing for other commands.
std::optional<bool> has_to_clear(const app::Session& session, const std::string& command) {
  if (command == "edit.skeleton_clear") return !session.document.skeleton_edits.empty();
  const app::Take none;
  const app::Take* const selected = selected_take(session);
  const app::Take& take = selected != nullptr ? *selected : none;
  if (command == "edit.poses_clear") return !same(take.pose_edits, none.pose_edits);
  if (command == "edit.target_joints_clear") return !take.target_edits.joints.empty();
  if (command == "edit.face_clear") return !take.target_edits.face.empty();
  if (command == "edit.weights_clear") return take.target_edits.weights != nullptr;
  return std::nullopt;
}

}  // namespace

std::string argument(double value) {
  std::string text = printed("%.6g", value);
  std::replace(text.begin(), text.end(), ',', '.');
  return text;
}

std::string on_off(bool on) {
  return on ? "on" : "off";
}

std::vector<std::string> joint_labels() {
  std::vector<std::string> labels(kJointCount);
  for (int j = 0; j < kJointCount; ++j) labels[j] = joint_label(j);
  return labels;
}

std::string joint_name(int joint) {
  return joint < 0 || joint >= kJointCount ? "all" : kJointNames[joint];
}

std::string time_left(double seconds) {
  if (!(seconds >= 0)) return "";
  if (seconds < 90) return printed("about %d s left", static_cast<int>(std::ceil(std::max(seconds, 1.0))));
  if (seconds < 5400) return printed("about %d min left", static_cast<int>(std::lround(seconds / 60)));
  return printed("about %.1f h left", seconds / 3600);
}

std::string figure(double value, const std::string& unit) {
  return short_number(value) + (unit.empty() ? "" : " " + unit);
}

std::string doubt_text(float doubt_m) {
  return doubt_m > 0 ? printed("\u00b1 %.0f cm", std::ceil(100 * doubt_m)) : "";
}

const app::Take* selected_take(const app::Session& session) {
  return at_or_null(session.document.takes, session.selected_take);
}

const app::TakeState* selected_state(const app::Session& session) {
  return at_or_null(session.takes, session.selected_take);
}

std::string take_title(const app::Session& session, const std::string& words) {
  const app::Take* take = selected_take(session);
  return take == nullptr ? words : words + ": " + take->name;
}

bool has_document(const app::Session& session) {
  return !session.document.source.path.empty() || !session.document.takes.empty();
}

int known_frames(const app::Session& session) {
  const int made = std::max<int>(app::frame_count(session), session.source.frames.size());
  const int64_t announced = session.source.count.value_or(0);
  return std::max(made, static_cast<int>(std::min<int64_t>(announced, 100'000'000)));
}

double frames_per_second(const app::Session& session) {
  return session.source.fps > 0 ? session.source.fps : 30;
}

bool panel_shown(const app::Session& session, const std::string& panel) {
  const auto& all = panels();
  const auto known =
      std::find_if(all.begin(), all.end(), [&](const Panel& one) { return panel == one.name; });
  if (known != all.end() && known->dock == Panel::Dock::Side) return &*known == &shown_tab(session);
  const auto flag = session.settings.panels.find(panel);
  if (flag != session.settings.panels.end()) return flag->second;
  return known != all.end() ? known->shown : panel != "side_over";
}

bool possible(const app::Session& session, const std::string& command) {
  if (const auto has = has_to_clear(session, command)) return *has;
  const bool source = !session.document.source.path.empty();
  const bool take = selected_take(session) != nullptr;
  const bool frames = app::frame_count(session) > 0;
  if (command == "edit.undo") return !app::undo_label(session).empty();
  if (command == "edit.redo") return !app::redo_label(session).empty();
  if (command == "work.pause") return session.working && !session.paused;
  if (command == "work.resume") return session.paused;
  if (command == "work.restart") return source && take;
  if (command == "source.open" || command == "source.motion" || command == "target.add") return true;
  if (command == "tool" || starts_with(command, "tool.") || command == "select.joint")
    return has_document(session);
  if (command == "edit.remove" || command == "edit.move") return has_document(session);
  if (command == "document.save" || command == "document.save_as") return has_document(session);
  if (starts_with(command, "study."))
    return command == "study.open" || command == "study.new" || session.study.study.has_value();
  if (command == "bones.find") return source;
  if (starts_with(command, "bones.") || starts_with(command, "generate."))
    return session.bones.rig != nullptr;
  for (const char* of_source :
       {"source.", "edit.crop", "edit.floor_removal", "edit.cluster", "edit.clean_up"})
    if (starts_with(command, of_source)) return source;
  for (const char* of_frames : {"playback.", "edit.drag", "edit.swap", "edit.people", "video."})
    if (starts_with(command, of_frames)) return frames;
  for (const char* of_take : {"target.", "take.", "method.", "compare.", "edit.", "export."})
    if (starts_with(command, of_take)) return take;
  return starts_with(command, "view.") || starts_with(command, "picture.") ? has_document(session) : true;
}

}  // namespace understudy::ui
