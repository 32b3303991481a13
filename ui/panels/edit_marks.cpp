// What the timeline shows of edits: their marks, the feet that are held, and the channel that the hand edits.
#include <algorithm>
#include <map>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/editing/limb_move.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/steps.hpp"
#include "retarget/skeleton/made_frames.hpp"
#include "ui/panels/flat.hpp"
#include "ui/panels/timeline.hpp"

namespace understudy::ui {
namespace {

enum : int { kBlue, kOrange, kGreen, kPink, kViolet };  // of Theme::series

/// The edits of one frame, which move together.
struct KeyFrame {
  std::string words;
  int reach = 0;
};
using KeyFrames = std::map<int, KeyFrame>;

/// `done`: what was done; said once a frame.
template <class Edit>
void add(KeyFrames& keys, const Edit& edit, const std::string& done) {
  KeyFrame& key = keys[edit.frame];
  if (key.words.find(done) == std::string::npos) key.words += (key.words.empty() ? "" : "\n") + done;
  key.reach = std::max(key.reach, edit.falloff);
}

/// Diamonds; `kind` and `take` begin the arguments of the commands.
void add_diamonds(std::vector<EditMark>& all, const KeyFrames& keys, const app::Arguments& kind, int row) {
  for (const auto& [frame, key] : keys) {
    EditMark edit;
    const std::string number = std::to_string(frame);
    edit.mark = {kind[0] + "." + number,   key.words, frame, frame, true, key.reach, row,
                 row == 0 ? kGreen : kPink};
    edit.move = kind;
    edit.move.push_back(number);
    edit.remove = app::join_line("edit.remove", edit.move);
    all.push_back(std::move(edit));
  }
}

std::string frames_text(int first, int last) {
  return first == last ? "frame " + std::to_string(first)
                       : "frames " + std::to_string(first) + " to " + std::to_string(last);
}

std::string in_words(const PersonEdit& edit) {
  const std::string person = std::to_string(edit.person), other = std::to_string(edit.other);
  return edit.how == PersonEdit::How::Join ? "Person " + other + " is person " + person
                                           : "Person " + person + " and " + other + " exchanged";
}

void add_person_edits(std::vector<EditMark>& all, const app::Session& session) {
  const auto& edits = session.document.source.people;
  for (size_t i = 0; i < edits.size(); ++i) {
    const PersonEdit& edit = edits[i];
    const std::string number = std::to_string(i);
    all.push_back({{"people." + number, in_words(edit) + ", " + frames_text(edit.first, edit.last),
                    edit.first, edit.last, false, 0, 0, kBlue},
                   {"people", number},
                   "edit.remove people " + number});
  }
}

void add_source_edits(std::vector<EditMark>& all, const app::Session& session) {
  const char* limbs[] = {"arms", "legs", "arms and legs"};
  KeyFrames drags;
  const auto& edits = session.document.skeleton_edits;
  for (size_t i = 0; i < edits.size(); ++i) {
    if (const auto* drag = std::get_if<DragEdit>(&edits[i])) {
      add(drags, *drag, "Dragged: " + joint_label(drag->joint));
      continue;
    }
    const SwapEdit& swap = std::get<SwapEdit>(edits[i]);
    const std::string number = std::to_string(i);
    const std::string words = std::string("Left and right are swapped in: ") +
                              limbs[static_cast<int>(swap.limbs)] + ", " + frames_text(swap.first, swap.last);
    all.push_back({{"swap." + number, words, swap.first, swap.last, false, 0, 0, kOrange},
                   {"swap", number},
                   "edit.remove skeleton " + number});
  }
  add_diamonds(all, drags, {"drags"}, 0);
}

void add_point_edits(std::vector<EditMark>& all, const app::Session& session) {
  const auto& edits = session.document.source.point_edits;
  for (size_t i = 0; i < edits.size(); ++i) {
    const std::string number = std::to_string(i), words = edit_words(edits[i]);
    EditMark mark;
    if (const auto* const drag = std::get_if<PointDrag>(&edits[i]))
      mark.mark = {"point." + number, words, drag->frame, drag->frame, true, drag->falloff, 0, kGreen};
    else if (const auto* const exchange = std::get_if<SidesExchange>(&edits[i]))
      mark.mark = {"point." + number, words, exchange->first, exchange->last, false, 0, 0, kOrange};
    mark.move = {"points", number};
    mark.remove = "flat.edit_remove " + number;
    all.push_back(std::move(mark));
  }
}

/// Of each frame of a fill the part of the row that its doubt takes: all of it from 15 cm on.
std::vector<float> doubt_heights(const FillEdit& fill, const std::vector<float>& doubt_m) {
  constexpr float kFull_m = 0.15f;
  std::vector<float> heights;
  for (int t = fill.first; t <= fill.last; ++t) {
    const float* doubt = at_or_null(doubt_m, t);
    heights.push_back(doubt != nullptr ? std::clamp(*doubt / kFull_m, 0.f, 1.f) : 0);
  }
  return heights;
}

void add_fills(std::vector<EditMark>& all, const app::Session& session, const std::string& take) {
  const std::vector<FillEdit>& fills = selected_take(session)->pose_edits.fill;
  const std::vector<float>& doubt_m = selected_state(session)->shown.doubt_m;
  for (size_t i = 0; i < fills.size(); ++i) {
    const FillEdit& fill = fills[i];
    const std::string number = std::to_string(i),
                      doubt = doubt_text(largest_doubt(doubt_m, fill.first, fill.last));
    EditMark edit;
    edit.mark.name = "made." + number;
    edit.mark.words = "Filled: " + frames_text(fill.first, fill.last) + (doubt.empty() ? "" : ", " + doubt);
    edit.mark.first = fill.first, edit.mark.last = fill.last;
    edit.mark.row = 1, edit.mark.color = kViolet;
    edit.mark.heights = doubt_heights(fill, doubt_m);
    edit.move = {"fill", take, number};
    edit.remove = "edit.remove fill " + take + " " + number;
    all.push_back(std::move(edit));
  }
}

/// Beyond the last captured frame.
void add_go_on(std::vector<EditMark>& all, const app::Session& session, const std::string& take) {
  const app::TakeState& state = *selected_state(session);
  const int first = static_cast<int>(state.performed.size()), last = ssize(state.shown.poses) - 1;
  if (!selected_take(session)->pose_edits.go_on || last < first) return;
  EditMark edit;
  edit.mark.name = "made.on";
  edit.mark.words = "Goes on: " + frames_text(first, last) + ", a prediction, " +
                    doubt_text(largest_doubt(state.shown.doubt_m, first, last));
  edit.mark.first = first, edit.mark.last = last;
  edit.mark.row = 1, edit.mark.color = kViolet;
  edit.mark.heights = doubt_heights({first, last}, state.shown.doubt_m);
  edit.move = {"go_on", take};
  edit.remove = "edit.remove go_on " + take;
  all.push_back(std::move(edit));
}

/// Both sides of the seam.
void add_loop(std::vector<EditMark>& all, const app::Session& session) {
  const auto& loop = selected_take(session)->pose_edits.loop;
  const Motion& shown = selected_state(session)->shown;
  if (!loop || loop->last >= ssize(shown.poses)) return;
  const int seam = seam_frames(*loop, shown.fps);
  if (seam == 0) return;
  for (const bool start : {true, false}) {
    const int first = start ? loop->first : loop->last - seam, last = first + seam - (start ? 1 : 0);
    EditMark edit;
    edit.mark.name = start ? "made.loop_start" : "made.loop_end";
    edit.mark.words = "Seam of the loop: " + frames_text(first, last) + ", " +
                      doubt_text(largest_doubt(shown.doubt_m, first, last));
    edit.mark.first = first, edit.mark.last = last;
    edit.mark.row = 1, edit.mark.color = kViolet, edit.mark.fixed = true;
    edit.mark.heights = doubt_heights({first, last}, shown.doubt_m);
    all.push_back(std::move(edit));
  }
}

/// Handles of the tempo.
void add_tempo_marks(std::vector<EditMark>& all, const app::Session& session, const std::string& take) {
  const auto& tempo = selected_take(session)->pose_edits.tempo;
  for (size_t i = 0; tempo && i < tempo->marks.size(); ++i) {
    const TempoMark& mark = tempo->marks[i];
    const std::string number = std::to_string(i);
    const std::string shift = mark.later_s == 0
                                  ? "stays at its moment"
                                  : printed("comes %.2f s %s", static_cast<double>(std::abs(mark.later_s)),
                                            mark.later_s > 0 ? "later" : "earlier");
    EditMark edit;
    edit.mark = {"tempo." + number,
                 "Frame " + std::to_string(mark.frame) + " " + shift,
                 mark.frame,
                 mark.frame,
                 true,
                 0,
                 1,
                 kOrange};
    edit.move = {"tempo", take, number};
    edit.remove = "edit.remove tempo " + take + " " + number;
    all.push_back(std::move(edit));
  }
}

void add_skips(std::vector<EditMark>& all, const std::set<int>& skip, const std::string& take) {
  for (auto at = skip.begin(); at != skip.end();) {
    const int first = *at;
    int last = first;
    while (++at != skip.end() && *at == last + 1) last = *at;
    const std::string range = take + " " + std::to_string(first) + " " + std::to_string(last);
    all.push_back({{"skip." + std::to_string(first), "Skipped: " + frames_text(first, last), first, last,
                    false, 0, 1, kBlue},
                   {"skips", take, std::to_string(first), std::to_string(last)},
                   "edit.skip " + range + " off"});
  }
}

/// The joint whose channel is shown, and whether it is the result's; -1 without a tool for it.
std::pair<int, bool> channel_joint(const app::Session& session) {
  const bool bones = session.tool == app::Tool::Bones;
  if (!bones && session.tool != app::Tool::Joints) return {-1, false};
  return {session.selected_joint, bones};
}

std::vector<int> edited_frames(const app::Session& session, int joint, bool bones) {
  std::vector<int> keys;
  const auto add = [&](const auto& edit) {
    if (edit.joint == joint) keys.push_back(edit.frame);
  };
  const app::Take* take = selected_take(session);
  if (bones && take != nullptr)
    for (const RotateEdit& edit : take->pose_edits.rotate) add(edit);
  if (!bones)
    for (const SkeletonEdit& edit : session.document.skeleton_edits)
      if (const auto* drag = std::get_if<DragEdit>(&edit)) add(*drag);
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

}  // namespace

std::vector<EditMark> edit_marks(const app::Session& session, const std::vector<TimelineState::Fill>& fills) {
  std::vector<EditMark> all;
  all.reserve(fills.size());
  const app::Take* take = selected_take(session);
  const std::string pose = take != nullptr && take->method.predict
                               ? "Goes on as the frames before, for half a second: "
                               : "Stands still as in the last good frame: ";
  for (const TimelineState::Fill& fill : fills)
    all.push_back(
        {{"fill." + std::to_string(fill.first), pose + frames_text(fill.first, fill.last) + ", " + fill.why,
          fill.first, fill.last, false, 0, 0, kBlue, true},
         {},
         ""});
  add_person_edits(all, session);
  add_source_edits(all, session);
  add_point_edits(all, session);
  if (take == nullptr) return all;
  const std::string k = std::to_string(session.selected_take);
  add_fills(all, session, k);
  add_go_on(all, session, k);
  add_loop(all, session);
  add_tempo_marks(all, session, k);
  add_skips(all, take->pose_edits.skip, k);
  KeyFrames rotations;
  for (const RotateEdit& edit : take->pose_edits.rotate)
    add(rotations, edit,
        edit.limb ? "Moved: " + limb_end_label(*edit.limb) : "Rotated: " + joint_label(edit.joint));
  add_diamonds(all, rotations, {"rotations", k}, 1);
  return all;
}

void StandingRuns::follow(const app::Session& session) {
  const app::TakeState* const state = selected_state(session);
  const size_t now = state != nullptr ? state->shown.standing.size() : 0;
  const int64_t generation = state != nullptr ? state->generation : -1;
  if (take_ != session.selected_take || generation_ != generation || now < frames_) {
    for (auto& runs : of_foot) runs.clear();
    take_ = session.selected_take, generation_ = generation, frames_ = 0;
  }
  for (; frames_ < now; ++frames_)
    for (const int side : {0, 1}) {
      if (!state->shown.standing[frames_][side]) continue;
      const int frame = static_cast<int>(frames_);
      auto& runs = of_foot[side];
      if (runs.empty() || runs.back().last + 1 < frame) runs.push_back({frame, frame});
      runs.back().last = frame;
    }
}

void StepLetters::follow(const app::Session& session) {
  const app::TakeState* const state = selected_state(session);
  const size_t now = state != nullptr ? state->shown.poses.size() : 0;
  const int64_t generation = state != nullptr ? state->generation : -1;
  const bool same = take_ == session.selected_take && generation_ == generation && now == frames_;
  if (same || !session.view.steps) return;
  if (session.working && now > 0 && take_ == session.selected_take) return;  // each look is at all frames
  take_ = session.selected_take, generation_ = generation, frames_ = now;
  letters.clear();
  if (now == 0) return;
  Motion motion{state->shown.fps, state->shown.poses, {}};
  if (state->shown.doubt_m.empty()) motion.flags = state->shown.flags;  // what was filled has steps again
  for (const Step& step : find_steps(motion))
    letters.push_back(
        {step.first, step.left_first ? "L" : "R",
         std::string(step.left_first ? "Left" : "Right") + " step, " + frames_text(step.first, step.last),
         step.left_first ? kBlue : kOrange});
}

std::vector<TrackBand> contact_bands(const app::Session& session, const StandingRuns& standing) {
  const app::Take* take = selected_take(session);
  if (take == nullptr || (standing.of_foot[0].empty() && standing.of_foot[1].empty())) return {};
  const auto& pin = take->pose_edits.pin;
  const bool pinned[] = {pin && pin->left, pin && pin->right};
  std::vector<TrackBand> bands;
  for (const int side : {0, 1}) {
    const std::string foot = side == 0 ? "Left foot " : "Right foot ";
    bands.push_back({side == 0 ? "left_foot" : "right_foot",
                     foot + (pinned[side] ? "pinned to the floor" : "on the floor"), standing.of_foot[side],
                     side == 0 ? kBlue : kOrange});
  }
  return bands;
}

void Channel::follow(const app::Session& session) {
  const auto [joint, bones] = channel_joint(session);
  const app::TakeState* take = selected_state(session);
  label.clear(), keys.clear();
  if (joint < 0 || (bones && take == nullptr)) return;
  std::string name = joint_label(joint);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  label = name + (bones ? ": rotation about x, y, z, \u00b0" : ": place x, y, z, m");
  keys = edited_frames(session, joint, bones);
  const std::vector<int64_t> about = {joint, bones, session.selected_take,
                                      bones ? take->generation : session.source.generation};
  if (about != about_)
    for (auto& axis : values) axis.clear();
  about_ = about;
  const size_t frames = bones ? take->shown.poses.size() : session.source.frames.size();
  for (auto& axis : values) axis.resize(std::min(axis.size(), frames));
  for (size_t f = values[0].size(); f < frames; ++f) {
    const Vec3 value = bones ? Vec3(rotation_to_axis_angle(take->shown.poses[f].local[joint]) * 180 / kPi)
                             : Vec3(session.source.frames[f].joints.row(joint));
    for (int axis = 0; axis < 3; ++axis) values[axis].push_back(value[axis]);
  }
}

}  // namespace understudy::ui
