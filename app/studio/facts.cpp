#include "app/studio/facts.hpp"

#include <algorithm>
#include <cstdlib>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::app {
namespace {

std::string yes_no(bool yes) {
  return yes ? "yes" : "no";
}

const char* question_name(const Session& session) {
  constexpr Names<7> kNames{"unsaved",      "recover",       "missing", "paint",
                            "not-a-person", "unsaved-study", "canvas"};
  static_assert(kNames.size() == static_cast<size_t>(Question::Kind::Canvas) + 1);
  return session.question ? kNames[static_cast<size_t>(session.question->kind)] : "none";
}

/// Per cent of the selected take's surface; "none" before it is bound and where it uses its own skin weights.
std::string bound_by_shape(const Session& session) {
  const size_t k = session.selected_take;
  if (k >= session.takes.size() || !session.takes[k].binding ||
      session.takes[k].binding->uncertainty.size() == 0)
    return "none";
  return std::to_string(100 * session.takes[k].binding->uncertainty.mean());
}

/// Of the selected take, "40-46 60-62".
std::string fills(const Session& session) {
  const Take* const take = at_or_null(session.document.takes, session.selected_take);
  std::string text;
  if (take != nullptr)
    for (const FillEdit& fill : take->pose_edits.fill)
      text += (text.empty() ? "" : " ") + std::to_string(fill.first) + "-" + std::to_string(fill.last);
  return text;
}

/// The shares of the source's parts, "0.30 0.70".
std::string blend(const Session& session) {
  std::string text;
  if (session.document.source.blend)
    for (const BlendPart& part : session.document.source.blend->parts)
      append_item(text, printed("%.2f", static_cast<double>(part.weight)), " ");
  return text;
}

/// Of the selected take, "4-31"; empty: it is no loop.
std::string looped(const Session& session) {
  const Take* const take = at_or_null(session.document.takes, session.selected_take);
  if (take == nullptr || !take->pose_edits.loop) return "";
  return std::to_string(take->pose_edits.loop->first) + "-" + std::to_string(take->pose_edits.loop->last);
}

/// Of the selected take's style its name and strength, "child 0.80"; empty: it has none.
std::string style(const Session& session) {
  const Take* const take = at_or_null(session.document.takes, session.selected_take);
  if (take == nullptr || take->method.style.called().empty()) return "";
  return file_name(take->method.style.called()) +
         printed(" %.2f", static_cast<double>(take->method.style.strength));
}

/// Of the selected take, "off", "body", or how many times as long it lasts: "0.80".
std::string tempo(const Session& session) {
  const Take* const take = at_or_null(session.document.takes, session.selected_take);
  if (take == nullptr || !take->pose_edits.tempo) return "off";
  const TempoEdit& edit = *take->pose_edits.tempo;
  return edit.by == TempoBy::Body ? "body" : printed("%.2f", static_cast<double>(edit.length));
}

/// Of the selected take the frames whose moments are held or shifted, "12+0.25 60+0.00".
std::string tempo_marks(const Session& session) {
  const Take* const take = at_or_null(session.document.takes, session.selected_take);
  std::string text;
  if (take != nullptr && take->pose_edits.tempo)
    for (const TempoMark& mark : take->pose_edits.tempo->marks)
      append_item(text, std::to_string(mark.frame) + printed("%+.2f", static_cast<double>(mark.later_s)),
                  " ");
  return text;
}

/// Seconds that the selected take lasts at its tempo; empty: as its source.
std::string lasts(const Session& session) {
  const TakeState* const take = at_or_null(session.takes, session.selected_take);
  return take == nullptr || take->times.empty() ? "" : printed("%.2f", take->times.back());
}

/// Of the selected take the seconds, "1.5"; empty: it ends with its last captured frame.
std::string goes_on(const Session& session) {
  const Take* const take = at_or_null(session.document.takes, session.selected_take);
  const bool on = take != nullptr && take->pose_edits.go_on;
  return on ? printed("%.3g", static_cast<double>(take->pose_edits.go_on->seconds)) : "";
}

/// Found bones that have a network's keypoint's name.
std::string keypoints(const Session& session) {
  if (!session.bones.rig) return "0";
  const std::vector<RigJoint>& joints = session.bones.rig->found.rig.joints;
  return std::to_string(std::count_if(joints.begin(), joints.end(), [](const RigJoint& joint) {
    return starts_with(joint.name, "keypoint ");
  }));
}

/// Of the chosen found bone in the frame shown, whole degrees against its parent; "none" without one.
std::string bone_turn(const Session& session) {
  const auto& rig = session.bones.rig;
  const RigPose* const pose =
      rig ? at_or_null(rig->found.motion.poses, frame_of_rig(*rig, shown_frame(session))) : nullptr;
  const Mat3* const turn = pose != nullptr ? at_or_null(pose->turns, session.bones.selected) : nullptr;
  if (turn == nullptr) return "none";
  return printed("%.0f", static_cast<double>(geodesic_angle(*turn, Mat3::Identity()) * 180 / kPi));
}

/// What the chosen found bone weighs on its surface, in vertices; "none" without one.
std::string bone_weights(const Session& session) {
  const int bone = session.bones.selected;
  if (!session.bones.rig || bone < 0) return "none";
  const SkinWeights& skin = session.bones.rig->found.rig.skin;
  return printed("%.3f", static_cast<double>((skin.bones.array() == bone).select(skin.weights, 0).sum()));
}

/// Of the body that performs what the found one does; 0: none does.
std::string second_bones(const Session& session) {
  const auto& performed = session.second.performed;
  return std::to_string(performed ? performed->rig.count() : 0);
}

/// Of the found rig those that are there, of the document's.
std::string clips(const Session& session) {
  const auto& made = session.made_motions.clips;
  return std::to_string(made.size() - static_cast<size_t>(std::count(made.begin(), made.end(), nullptr)));
}

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Of how the selected take is performed.
Facts performance(const Session& session) {
  return {{"style", style(session)},
          {"taught", std::to_string(session.styles.taught.size())},  // on this machine
          {"tempo", tempo(session)},
          {"tempo_marks", tempo_marks(session)},
          {"lasts", lasts(session)},
          {"clock", printed("%.2f", moment_of(session, std::max(0, shown_frame(session))))}};
}

Facts of_study(const Session& session) {
  const StudyState& study = session.study;
  return {
      {"study", study.study ? study.study->name : ""},
      {"study_path", study.path},
      {"study_changed", yes_no(study.changed)},
      {"study_trials", std::to_string(study.count)},  // of a participant, practice left out
      {"study_minutes", printed("%.2f", study.minutes)},
      {"study_problem", study.problem},
  };
}

}  // namespace

std::vector<std::pair<std::string, std::string>> facts(const Session& session) {
  const auto count = [](size_t n) { return std::to_string(n); };
  const auto takes = [&](const auto& counted) {
    return count(std::count_if(session.takes.begin(), session.takes.end(), counted));
  };
  Facts all = {
      {"frames", std::to_string(frame_count(session))},
      {"frame", std::to_string(shown_frame(session))},
      {"source_frames", count(session.source.frames.size())},
      {"source", session.document.source.path},
      {"bones", std::to_string(session.bones.rig ? session.bones.rig->found.rig.count() : 0)},
      {"bone", std::to_string(session.bones.selected)},
      {"keypoints", keypoints(session)},
      {"bones_method", session.document.bones.search.method},
      {"bone_turn", bone_turn(session)},
      {"bone_weights", bone_weights(session)},
      {"second_bones", second_bones(session)},
      {"second_matches", count(session.document.bones.second.matches.size())},
      {"made_motions", count(session.made_motions.offered.size())},
      {"clips", clips(session)},
      {"bones_stage", session.bones.job != 0 ? session.bones.stage : "none"},
      {"people", count(session.source.people.size())},
      {"person", std::to_string(session.source.person)},
      {"takes", count(session.document.takes.size())},
      {"ready_takes", takes([](const TakeState& take) { return take.ready; })},
      // whose file has been read, whether they are bound yet or not
      {"seen_takes", takes([](const TakeState& take) { return take.as_loaded || take.target; })},
      {"bound_by_shape", bound_by_shape(session)},
      {"playing", yes_no(session.playback.playing)},
      {"rate", std::to_string(session.playback.rate)},
      {"working", yes_no(session.working)},
      {"changed", yes_no(session.changed)},
      {"path", session.path},
      {"undo_label", undo_label(session)},
      {"redo_label", redo_label(session)},
      {"skeleton_edits", count(session.document.skeleton_edits.size())},
      {"fills", fills(session)},
      {"blend", blend(session)},
      {"goes_on", goes_on(session)},
      {"loop", looped(session)},
      {"map_steps", std::to_string(session.map.map ? session.map.map->size() : 0)},
      {"map_like", count(session.map.like.size())},
      {"map_performs", session.map.performance ? std::to_string(session.map.performance->step) : ""},
      {"layout", kLayoutNames[static_cast<size_t>(session.view.layout)]},
      {"active_pane", std::to_string(session.view.active_pane)},
      {"tool", kToolNames[static_cast<size_t>(session.tool)]},
      {"joint", session.selected_joint < 0 ? "none" : kJointNames[session.selected_joint]},
      {"selected_take", std::to_string(session.selected_take)},
      {"theme", session.settings.dark ? "dark" : "light"},
      {"card", std::to_string(session.settings.getting_started)},  // of Getting started; 0: none
      {"errors", count(session.errors.size())},
      {"error", session.errors.empty() ? "" : session.errors.front().text},
      {"question", question_name(session)},
      {"sends_to", session.sends_to.empty() ? "nowhere" : session.sends_to},
      {"jobs", count(session.jobs.size())},
      {"bad_frames", count(bad_frames(session).size())},
  };
  for (const Facts& more : {of_study(session), performance(session)})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string fact(const Session& session, const std::string& key) {
  std::string known;
  for (const auto& [name, value] : facts(session)) {
    if (name == key) return value;
    append_item(known, name);
  }
  throw Error("there is no fact " + key + " (there are " + known + ")");
}

std::vector<std::string> shown_texts(const Session& session) {
  std::vector<std::string> texts;
  for (const Notice& notice : session.errors) texts.push_back(notice.text);
  for (const Notice& notice : session.notices) texts.push_back(notice.text);
  if (session.question) texts.push_back(session.question->text);
  for (const LogLine& line : session.log) texts.push_back(line.text);
  return texts;
}

bool holds(const std::string& value, const std::string& comparison, const std::string& wanted) {
  if (comparison == "=" || comparison.empty()) return value == wanted;
  if (comparison == "!=") return value != wanted;
  US_CHECK(comparison == ">=" || comparison == "<=", comparison, " is not a comparison: =, !=, >=, <=");
  const double a = std::atof(value.c_str()), b = std::atof(wanted.c_str());
  return comparison == ">=" ? a >= b : a <= b;
}

}  // namespace understudy::app
