#include <algorithm>

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/editing/limb_move.hpp"

namespace understudy::app {
namespace {

int checked_frame(const Call& c, int frame) {
  const int count = std::max<int>(frame_count(c.session), c.session.source.frames.size());
  US_CHECK(frame >= 0 && frame < count, "there is no frame ", frame, " among ", count);
  return frame;
}

int frame_argument(const Call& c, size_t i) {
  return checked_frame(c, c.number<int>(i, "frame"));
}

template <class Range>
Range frame_range(const Call& c, size_t i) {
  Range range;
  range.first = frame_argument(c, i);
  range.last = frame_argument(c, i + 1);
  US_CHECK(range.first <= range.last, "the last frame comes before the first");
  return range;
}

int falloff_argument(const Call& c, size_t i) {
  const bool given = i < c.arguments.size() && c.arguments[i] != "children";
  const int falloff = given ? c.number<int>(i, "falloff") : c.session.falloff;
  US_CHECK(falloff >= 0 && falloff <= 10000, "a falloff is 0 to 10000 frames, not ", falloff);
  return falloff;
}

/// With the tool that moves the box; a box that is new has open sides.
void crop(Call& c) {
  auto& crop = c.document.scan_edits.crop;
  const std::string& what = c.word(0, "box");
  if (what == "off") {
    if (c.session.tool == Tool::Crop) c.studio.run("tool", {"look"});
    return crop.reset();
  }
  const Box before = crop.value_or(Box::open());
  if (what == "on") {
    c.studio.run("tool", {"crop"});
    crop = before;
    return;
  }
  const auto side = std::find(kBoxSides.begin(), kBoxSides.end(), what);
  if (side == kBoxSides.end()) {
    crop = Box{c.vector(0, "corner"), c.vector(3, "corner")};
  } else {
    const int i = static_cast<int>(side - kBoxSides.begin());
    crop = before;
    crop->side(i) = c.word(1, "side") == "off" ? Box::open().side(i) : c.number(1, "side");
  }
  US_CHECK((crop->high - crop->low).minCoeff() > 0, "the crop box has no inside");
}

void add_scan_edits(Commands& commands) {
  commands.add_slider({"edit.crop", "Crop the scan",
                       "on: a box around everything | off | SIDE METRES|off: low.x, high.x ... high.z | LOW "
                       "HIGH: six numbers"},
                      crop);
  commands.add_slider({"edit.floor_removal", "Remove the floor", "on|off [HEIGHT]"}, [](Call& c) {
    auto& floor = c.document.scan_edits.floor;
    floor = only_if(c.on(0), FloorCut{});
    if (floor && c.arguments.size() > 1) floor->height_m = c.number(1, "height");
  });
  commands.add_edit({"edit.clean_up", "Clean up the scan", "removes the floor and all but the largest part"},
                    [](Call& c) {
                      auto& edits = c.document.scan_edits;
                      if (!edits.floor) edits.floor = FloorCut{};
                      edits.largest_cluster = true;
                    });
  commands.add_edit({"edit.cluster", "Largest part only", "on|off"},
                    [](Call& c) { c.document.scan_edits.largest_cluster = c.on(0); });
}

bool is_seen(const Session& session, int person) {
  const auto& people = session.source.people;
  return std::any_of(people.begin(), people.end(), [&](const PersonSeen& one) { return one.id == person; });
}

/// Frames of the whole source, those that are still to be read among them.
PersonEdit person_range(const Call& c, size_t i) {
  PersonEdit edit;
  edit.first = c.number<int>(i, "frame"), edit.last = c.number<int>(i + 1, "frame");
  const auto count = std::max<int64_t>(c.session.source.count.value_or(0), ssize(c.session.source.frames));
  US_CHECK(edit.first >= 0 && edit.first <= edit.last && edit.last < count, "there are no frames ",
           edit.first, " to ", edit.last, " among ", count);
  return edit;
}

void correct_people(Call& c) {
  PersonEdit edit = person_range(c, 0);
  edit.person = c.number<int>(2, "person"), edit.other = c.number<int>(3, "person");
  edit.how = c.choice<PersonEdit::How>(4, "correction", kPersonEditNames);
  US_CHECK(is_seen(c.session, edit.person), "there is no person ", edit.person, " in the source");
  US_CHECK(edit.other != edit.person, "a correction is about two people");
  const bool joins = edit.how == PersonEdit::How::Join;
  US_CHECK(
      joins ? is_seen(c.session, edit.other) : edit.other >= kPersonIds.low && edit.other <= kPersonIds.high,
      "there is no person ", edit.other, " in the source");
  c.document.source.people.push_back(edit);
}

void add_person_edits(Commands& commands) {
  commands.add_edit(
      {"edit.people", "Correct who is who",
       "FIRST LAST PERSON OTHER exchange|join: numbers of people; one that nobody has splits the "
       "person off, join makes the other the person, too"},
      correct_people);
  commands.add_edit({"edit.people_clear", "Clear who is who"},
                    [](Call& c) { c.document.source.people.clear(); });
}

void add_skeleton_edits(Commands& commands) {
  commands.add_edit({"edit.drag", "Drag a joint", "FRAME JOINT X Y Z [FALLOFF] [children]: metres"},
                    [](Call& c) {
                      DragEdit edit;
                      edit.frame = frame_argument(c, 0);
                      edit.joint = c.joint(1);
                      c.label = "Drag " + joint_label(edit.joint);
                      edit.offset = c.vector(2, "offset");
                      edit.falloff = falloff_argument(c, 5);
                      edit.with_children = c.has("children", 5);
                      c.document.skeleton_edits.push_back(edit);
                    });
  commands.add_edit({"edit.swap", "Swap left and right", "FIRST LAST arms|legs|both"}, [](Call& c) {
    if (c.document.flat) return exchange_flat_sides(c);
    SwapEdit edit = frame_range<SwapEdit>(c, 0);
    edit.limbs = c.choice<SwapEdit::Limbs>(2, "limbs", kLimbNames);
    c.document.skeleton_edits.push_back(edit);
  });
  commands.add_edit({"edit.skeleton_clear", "Clear the skeleton's edits"},
                    [](Call& c) { c.document.skeleton_edits.clear(); });
}

void move_limb(Call& c) {
  const TakeState& state = c.take_state();
  LimbMove move;
  move.frame = frame_argument(c, 1);
  move.joint = c.joint(2);
  US_CHECK(limb_end(move.joint) >= 0, joint_label(move.joint),
           " cannot be moved: choose a wrist, an ankle or a foot");
  c.label = "Move " + limb_end_label(move.joint);
  move.offset = c.vector(3, "offset");
  move.falloff = falloff_argument(c, 6);
  US_CHECK(state.target && move.frame < ssize(state.performed), "frame ", move.frame,
           " is not performed yet");
  add_limb_move(move, state.performed[move.frame].pose, state.target->joints, c.take().pose_edits);
}

void add_pose_edits(Commands& commands) {
  commands.add_edit({"edit.rotate", "Rotate a bone", "TAKE FRAME JOINT X Y Z [FALLOFF]: axis times radians"},
                    [](Call& c) {
                      RotateEdit edit;
                      edit.frame = frame_argument(c, 1);
                      edit.joint = c.joint(2);
                      c.label = "Rotate " + joint_label(edit.joint);
                      edit.axis_angle = c.vector(3, "rotation");
                      edit.falloff = falloff_argument(c, 6);
                      c.take().pose_edits.rotate.push_back(edit);
                    });
  commands.add_edit({"edit.move_limb", "Move a hand or a foot", "TAKE FRAME JOINT X Y Z [FALLOFF]: metres"},
                    move_limb);
  commands.add_edit({"edit.pin", "Pin the feet", "TAKE on|off"},
                    [](Call& c) { c.take().pose_edits.pin = only_if(c.on(1), PinEdit{}); });
  commands.add_slider({"edit.smooth", "Smooth", "TAKE STRENGTH: 0 to 1"}, [](Call& c) {
    const float strength = c.clamped(1, "strength", 0.f, 1.f);
    c.take().pose_edits.smooth = only_if(strength > 0, SmoothEdit{strength});
  });
  commands.add_slider({"edit.raise", "Raise", "TAKE METRES", "", "edit.floor_offset"}, [](Call& c) {
    const float offset = c.number(1, "height");
    c.take().pose_edits.raise = only_if(offset != 0, RaiseEdit{offset});
  });
  commands.add_slider({"edit.turn", "Turn", "TAKE DEGREES", "", "edit.heading"}, [](Call& c) {
    const float angle = c.number(1, "angle");
    c.take().pose_edits.turn = only_if(angle != 0, TurnEdit{angle});
  });
}

template <class Edit>
void remove_at(std::vector<Edit>& edits, const Call& c, size_t i) {
  const int index = c.number<int>(i, "edit");
  US_CHECK(index >= 0 && index < ssize(edits), "there is no edit ", index, " among ", edits.size());
  edits.erase(edits.begin() + index);
}

/// The frame that an edit is of; null of an exchanged range.
int* frame_of(SkeletonEdit& edit) {
  auto* drag = std::get_if<DragEdit>(&edit);
  return drag != nullptr ? &drag->frame : nullptr;
}
int* frame_of(RotateEdit& edit) {
  return &edit.frame;
}

/// -1 of an exchanged range.
int joint_of(const SkeletonEdit& edit) {
  const auto* const drag = std::get_if<DragEdit>(&edit);
  return drag != nullptr ? drag->joint : -1;
}
int joint_of(const RotateEdit& edit) {
  return edit.joint;
}

template <class Edit>
void check_any_at(std::vector<Edit>& edits, int frame) {
  US_CHECK(std::any_of(edits.begin(), edits.end(),
                       [&](Edit& edit) { return frame_of(edit) != nullptr && *frame_of(edit) == frame; }),
           "there is no edit at frame ", frame);
}

template <class Edit>
void remove_all_at(std::vector<Edit>& edits, int frame) {
  check_any_at(edits, frame);
  const auto there = [&](Edit& edit) { return frame_of(edit) != nullptr && *frame_of(edit) == frame; };
  edits.erase(std::remove_if(edits.begin(), edits.end(), there), edits.end());
}

template <class Edit>
void move_all_at(std::vector<Edit>& edits, int frame, int to) {
  check_any_at(edits, frame);
  for (Edit& edit : edits)
    if (int* const at = frame_of(edit); at != nullptr && *at == frame) *at = to;
}

/// All edits by hand of some joints, at whatever frame.
template <class Edit>
void remove_all_of(std::vector<Edit>& edits, const std::vector<int>& joints) {
  const size_t before = edits.size();
  const auto of_one = [&](const Edit& edit) {
    return std::find(joints.begin(), joints.end(), joint_of(edit)) != joints.end();
  };
  edits.erase(std::remove_if(edits.begin(), edits.end(), of_one), edits.end());
  US_CHECK(edits.size() < before, "the joint has no edits");
}

void remove_drags_of(Call& c, int joint) {
  c.label = "Reset " + joint_label(joint);
  remove_all_of(c.document.skeleton_edits, {joint});
}

/// Of a hand or a foot with all that moving it turned.
void remove_rotations_of(Call& c, int joint) {
  c.label = "Reset " + limb_label(joint);
  remove_all_of(c.take(1).pose_edits.rotate, joints_turned_by(joint));
}

/// All that moving a hand or a foot turned at a frame.
void remove_limb_move(Call& c) {
  auto& edits = c.take(1).pose_edits.rotate;
  const int frame = c.number<int>(2, "frame"), end = limb_end(c.joint(3));
  const auto of_it = [&](const RotateEdit& edit) { return edit.frame == frame && edit.limb == end; };
  const auto first = std::remove_if(edits.begin(), edits.end(), of_it);
  US_CHECK(first != edits.end(), "no hand or foot was moved there");
  edits.erase(first, edits.end());
}

/// What it had trimmed plays again.
void remove_loop(Call& c, PoseEdits& edits) {
  const auto& loop = edits.loop;
  const auto& trim = edits.trim;
  if (loop && trim && trim->first == loop->first && trim->last == loop->last) edits.trim.reset();
  edits.loop.reset();
  c.label = "No loop";
}

void remove_edit(Call& c) {
  const size_t kind = c.choice(0, "kind",
                               {"skeleton", "drags", "rotation", "rotations", "joint", "drags_of",
                                "rotations_of", "limb", "people", "fill", "go_on", "loop", "tempo", "face"});
  if (kind == 12) return remove_tempo_mark(c);
  if (kind == 8) return remove_at(c.document.source.people, c, 1);
  if (kind == 5) return remove_drags_of(c, c.joint(1));
  if (kind == 6) return remove_rotations_of(c, c.joint(2));
  if (kind == 7) return remove_limb_move(c);
  if (kind == 0) return remove_at(c.document.skeleton_edits, c, 1);
  if (kind == 1) return remove_all_at(c.document.skeleton_edits, c.number<int>(1, "frame"));
  Take& take = c.take(1);
  if (kind == 2) return remove_at(take.pose_edits.rotate, c, 2);
  if (kind == 9) return remove_at(take.pose_edits.fill, c, 2);
  if (kind == 10) return take.pose_edits.go_on.reset();
  if (kind == 11) return remove_loop(c, take.pose_edits);
  if (kind == 13) return remove_at(take.target_edits.face, c, 2);
  if (kind == 3) return remove_all_at(take.pose_edits.rotate, c.number<int>(2, "frame"));
  remove_at(take.target_edits.joints, c, 2);
}

/// The frames that an edit of some frames is moved to: argument `i` is the first, the next the last; without
/// it there are as many as before.
Trim frames_to(Call& c, size_t i, int length) {
  Trim to;
  to.first = frame_argument(c, i);
  if (i + 1 >= c.arguments.size()) {
    to.last = checked_frame(c, to.first + length);
    return to;
  }
  c.label = "Change the frames of an edit";
  return frame_range<Trim>(c, i);
}

void move_swap(Call& c) {
  auto& edits = c.document.skeleton_edits;
  const int index = c.number<int>(1, "edit");
  auto* const swap = index >= 0 && index < ssize(edits) ? std::get_if<SwapEdit>(&edits[index]) : nullptr;
  US_CHECK(swap, "edit ", index, " does not exchange left and right");
  const Trim to = frames_to(c, 2, swap->last - swap->first);
  swap->first = to.first, swap->last = to.last;
}

void move_person_edit(Call& c) {
  auto& edits = c.document.source.people;
  const int index = c.number<int>(1, "edit");
  US_CHECK(index >= 0 && index < ssize(edits), "there is no edit ", index, " among ", edits.size());
  PersonEdit& edit = edits[static_cast<size_t>(index)];
  const Trim to = frames_to(c, 2, edit.last - edit.first);
  edit.first = to.first, edit.last = to.last;
}

void move_skips(Call& c) {
  auto& skip = c.take(1).pose_edits.skip;
  const int first = c.number<int>(2, "frame"), last = c.number<int>(3, "frame");
  const Trim to = frames_to(c, 4, last - first);
  const bool moves = to.last - to.first == last - first;
  std::set<int> frames;
  for (auto at = skip.lower_bound(first); at != skip.end() && *at <= last; at = skip.erase(at))
    if (moves) frames.insert(*at - first + to.first);
  for (int frame = to.first; !moves && frame <= to.last; ++frame) frames.insert(frame);
  skip.insert(frames.begin(), frames.end());
}

/// Fills that touch it become one with it.
void add_fill(FillEdit fill, std::vector<FillEdit>& all) {
  for (auto at = all.begin(); at != all.end();) {
    const bool apart = at->last + 1 < fill.first || at->first > fill.last + 1;
    if (!apart) fill.first = std::min(fill.first, at->first), fill.last = std::max(fill.last, at->last);
    at = apart ? at + 1 : all.erase(at);
  }
  all.push_back(fill);
}

FillEdit& fill_argument(Call& c, size_t i) {
  auto& fills = c.take(i).pose_edits.fill;
  const int index = c.number<int>(i + 1, "edit");
  US_CHECK(index >= 0 && index < ssize(fills), "there is no edit ", index, " among ", fills.size());
  return fills[static_cast<size_t>(index)];
}

void move_fill(Call& c) {
  auto& fills = c.take(1).pose_edits.fill;
  const FillEdit before = fill_argument(c, 1);
  const Trim to = frames_to(c, 3, before.last - before.first);
  fills.erase(fills.begin() + c.number<int>(2, "edit"));
  add_fill({to.first, to.last, before.learned, before.variation}, fills);
}

/// Wherever it is moved to it begins behind the last captured frame: what counts is where it ends.
void move_go_on(Call& c) {
  auto& edit = c.take(1).pose_edits.go_on;
  US_CHECK(edit, "the take does not go on beyond its last frame");
  const int last = c.number<int>(c.arguments.size() > 3 ? 3 : 2, "frame") +
                   (c.arguments.size() > 3 ? 0 : frames_added(*edit, c.session.source.fps) - 1);
  const int frames = last + 1 - static_cast<int>(c.take_state(1).performed.size());
  const double seconds = std::max(1, frames) / c.session.source.fps;
  edit->seconds = std::clamp(static_cast<float>(seconds), kGoOnSeconds.low, kGoOnSeconds.high);
}

/// Of 2D poses.
void move_point_edit(Call& c) {
  auto& edits = c.document.source.point_edits;
  const int index = c.number<int>(1, "edit");
  US_CHECK(index >= 0 && index < ssize(edits), "there is no edit ", index, " among ", edits.size());
  TrackEdit& edit = edits[static_cast<size_t>(index)];
  if (auto* const drag = std::get_if<PointDrag>(&edit)) {
    drag->frame = frame_argument(c, 2);
    return;
  }
  SidesExchange& exchange = std::get<SidesExchange>(edit);
  const Trim to = frames_to(c, 2, exchange.last - exchange.first);
  exchange.first = to.first, exchange.last = to.last;
}

void move_edit(Call& c) {
  const size_t kind = c.choice(
      0, "kind", {"drags", "swap", "rotations", "skips", "people", "fill", "go_on", "tempo", "points"});
  if (kind == 8) return move_point_edit(c);
  if (kind == 7) return move_tempo_mark(c);
  if (kind == 5) return move_fill(c);
  if (kind == 6) return move_go_on(c);
  if (kind == 0)
    return move_all_at(c.document.skeleton_edits, c.number<int>(1, "frame"), frame_argument(c, 2));
  if (kind == 1) return move_swap(c);
  if (kind == 3) return move_skips(c);
  if (kind == 4) return move_person_edit(c);
  move_all_at(c.take(1).pose_edits.rotate, c.number<int>(2, "frame"), frame_argument(c, 3));
}

void add_rearrangement(Commands& commands) {
  commands.add_edit(
      {"edit.remove", "Remove an edit",
       "skeleton INDEX | drags FRAME | drags_of JOINT | rotation TAKE INDEX | rotations TAKE FRAME | "
       "rotations_of TAKE JOINT | limb TAKE FRAME JOINT | joint TAKE INDEX | people INDEX | fill TAKE INDEX "
       "| "
       "go_on TAKE | loop TAKE | tempo TAKE INDEX | face TAKE INDEX"},
      remove_edit);
  commands.add_edit(
      {"edit.move", "Move an edit in time",
       "drags FRAME TO | swap INDEX TO [LAST] | rotations TAKE FRAME TO | skips TAKE FIRST LAST TO [LAST] | "
       "people INDEX TO [LAST] | fill TAKE INDEX TO [LAST] | go_on TAKE TO [LAST] | tempo TAKE INDEX TO | "
       "points INDEX TO [LAST]"},
      move_edit);
}

std::vector<FillEdit> all_unusable(const Session& session, size_t take) {
  std::vector<FillEdit> runs = unusable_runs(session, take);
  US_CHECK(!runs.empty(), "all frames could be used: set the loop marks around those that are to be filled");
  return runs;
}

/// What is to be filled without being told: what is between the loop marks, else the run of unusable frames
/// under the playhead, else all of them.
std::vector<FillEdit> wanted_fills(const Session& session, size_t take) {
  const FrameRange marked = play_range(session.playback, frame_count(session));
  if (!marked.empty() && (session.playback.in >= 0 || session.playback.out >= 0))
    return {{marked.first, marked.last}};
  std::vector<FillEdit> runs = all_unusable(session, take);
  const int now = shown_frame(session);
  for (const FillEdit& run : runs)
    if (run.first <= now && now <= run.last) return {run};
  return runs;
}

/// The take that the first argument names, else the current one.
size_t wanted_take(const Call& c) {
  const size_t take = c.arguments.empty() ? static_cast<size_t>(c.session.selected_take) : c.take_number();
  US_CHECK(take < c.document.takes.size(), "add a target first");
  return take;
}

void fill(Call& c) {
  const size_t take = wanted_take(c);
  const std::vector<FillEdit> wanted = c.has("bad", 1) ? all_unusable(c.session, take)
                                       : c.arguments.size() > 1
                                           ? std::vector<FillEdit>{frame_range<FillEdit>(c, 1)}
                                           : wanted_fills(c.session, take);
  auto& fills = c.document.takes[take].pose_edits.fill;
  for (const FillEdit& one : wanted) add_fill(one, fills);
  const int last = static_cast<int>(c.session.takes[take].performed.size()) - 1;
  for (const FillEdit& one : wanted)
    US_CHECK(one.last <= std::max(0, last) || !c.document.takes[take].pose_edits.go_on, "frame ", one.last,
             " is beyond the last captured one, ", last, ": it is made already");
  for (const FillEdit& one : fills)
    US_CHECK(one.first > 0 || one.last < last, "all frames would be filled: none is left that is known");
  for (const FillEdit& one : wanted)
    if (const std::string guess = guess_of(one, last + 1, c.session.source.fps); !guess.empty())
      c.studio.notify(guess);
  c.label = wanted.size() == 1
                ? "Fill frames " + std::to_string(wanted[0].first) + " to " + std::to_string(wanted[0].last)
                : "Fill all unusable frames";
}

/// "frames 24 to 53 are a guess: nothing after them is known".
void tell_go_on(const Call& c, size_t take, const GoOnEdit& edit) {
  const int first = static_cast<int>(c.session.takes[take].performed.size());
  const FillEdit added{first, first + frames_added(edit, c.session.source.fps) - 1};
  const auto& trim = c.document.takes[take].pose_edits.trim;
  const bool trimmed = trim && trim->last < added.first;
  c.studio.notify(guess_of(added, added.last + 1, c.session.source.fps) +
                  (trimmed ? "; the trim leaves them out" : ""));
}

/// Without a number it goes on a second longer.
void go_on(Call& c) {
  constexpr float kMore_s = 1;
  const size_t take = wanted_take(c);
  auto& edit = c.document.takes[take].pose_edits.go_on;
  if (c.has("off", 1)) return edit.reset();
  US_CHECK(!c.session.takes[take].performed.empty(), "no frame is performed yet that could go on");
  const float before = edit ? edit->seconds : 0;
  const float seconds = c.arguments.size() > 1 ? c.number(1, "time") : before + kMore_s;
  US_CHECK(seconds >= kGoOnSeconds.low && seconds <= kGoOnSeconds.high, "a take goes on for ",
           kGoOnSeconds.low, " to ", kGoOnSeconds.high, " seconds, not ", seconds);
  if (!edit) edit.emplace();
  edit->seconds = seconds;
  tell_go_on(c, take, *edit);
  c.label = printed("Go on for %.3g s", static_cast<double>(seconds));
}

/// One of the motion space's answers: 0 the best, from 1 on the others.
int variation_argument(const Call& c, size_t i) {
  const int variation = c.number<int>(i, "alternative");
  US_CHECK(variation >= kVariationNumbers.low && variation <= kVariationNumbers.high,
           "there is no alternative ", variation, ": they are 0, the best answer, to ",
           kVariationNumbers.high);
  return variation;
}

/// Where two moments are to be looked for without being told: between the loop marks, else in what is kept.
LoopEdit wanted_loop(const Call& c, size_t take) {
  const Motion& shown = c.session.takes[take].shown;
  const int count = static_cast<int>(shown.poses.size());
  US_CHECK(count > 0, "no frame is performed yet that could be in a loop");
  FrameRange range = play_range(c.session.playback, count);
  if (c.arguments.size() > 1) {
    const auto given = frame_range<Trim>(c, 1);
    range = {given.first, given.last};
  }
  US_CHECK(range.last < count, "frame ", range.last, " is not performed yet");
  return find_loop(shown, c.session.takes[take].target->joints, range.first, range.last);
}

/// The loop is what plays; without the loop all does.
void loop(Call& c) {
  const size_t take = wanted_take(c);
  PoseEdits& edits = c.document.takes[take].pose_edits;
  if (c.has("off", 1)) return remove_loop(c, edits);
  const LoopEdit found = wanted_loop(c, take);
  edits.loop = found;
  edits.trim = Trim{found.first, found.last};
  const LoopTravel travel = travel_of(found, c.session.takes[take].shown);
  c.studio.notify(printed("frames %d to %d play in a loop, %.2f m and %.0f\u00b0 farther each round",
                          found.first, found.last, static_cast<double>(travel.metres),
                          static_cast<double>(travel.turn_deg)));
  c.label = printed("Loop frames %d to %d", found.first, found.last);
}

void add_made_frames(Commands& commands) {
  commands.add_edit({"edit.go_on", "Go on",
                     "[TAKE [SECONDS | off]]: beyond the last captured frame; without a number a second "
                     "longer",
                     "Shift+G"},
                    go_on);
  commands.add_slider({"edit.go_on_learned", "Plain or learned",
                       "TAKE SHARE: 0 the smooth curve to 1 the motion space's answer"},
                      [](Call& c) {
                        auto& edit = c.take().pose_edits.go_on;
                        US_CHECK(edit, "the take does not go on beyond its last frame");
                        edit->learned = c.clamped(1, "share", 0.f, 1.f);
                      });
  commands.add_edit({"edit.go_on_variation", "Another alternative",
                     "TAKE N: of what goes on, 0 the motion space's best answer, 1 to 3 others"},
                    [](Call& c) {
                      auto& edit = c.take().pose_edits.go_on;
                      US_CHECK(edit, "the take does not go on beyond its last frame");
                      edit->variation = variation_argument(c, 1);
                      c.label = printed("Go on by alternative %d", edit->variation + 1);
                    });
  commands.add_edit({"edit.loop", "Make a loop",
                     "[TAKE [FIRST LAST | off]]: finds two like moments between the loop marks, or in all "
                     "frames, and closes the seam between them",
                     "Shift+L"},
                    loop);
  commands.add_slider({"edit.loop_learned", "Plain or learned",
                       "TAKE SHARE: 0 the smooth curve over the seam to 1 the motion space's answer"},
                      [](Call& c) {
                        auto& edit = c.take().pose_edits.loop;
                        US_CHECK(edit, "the take is no loop");
                        edit->learned = c.clamped(1, "share", 0.f, 1.f);
                      });
}

void add_pose_ranges(Commands& commands) {
  commands.add_edit({"edit.fill", "Fill frames",
                     "[TAKE [FIRST LAST | bad]]: between the loop marks, else the unusable frames here, else "
                     "all unusable ones (bad)",
                     "G"},
                    fill);
  commands.add_slider({"edit.fill_learned", "Plain or learned",
                       "TAKE EDIT SHARE: 0 the smooth curve to 1 the motion space's answer"},
                      [](Call& c) { fill_argument(c, 0).learned = c.clamped(2, "share", 0.f, 1.f); });
  commands.add_edit({"edit.fill_variation", "Another alternative",
                     "TAKE EDIT N: 0 the motion space's best answer, 1 to 3 others"},
                    [](Call& c) {
                      FillEdit& fill = fill_argument(c, 0);
                      fill.variation = variation_argument(c, 2);
                      c.label = printed("Fill by alternative %d", fill.variation + 1);
                    });
  commands.add_edit({"edit.trim", "Trim", "TAKE FIRST LAST | TAKE off"}, [](Call& c) {
    auto& trim = c.take().pose_edits.trim;
    trim.reset();
    if (c.word(1, "frame") != "off") trim = frame_range<Trim>(c, 1);
  });
  commands.add_edit({"edit.skip", "Skip frames", "TAKE FRAME [LAST] on|off"}, [](Call& c) {
    const int first = frame_argument(c, 1), last = c.arguments.size() > 3 ? frame_argument(c, 2) : first;
    const bool on = c.on(c.arguments.size() > 3 ? 3 : 2);
    auto& skip = c.take().pose_edits.skip;
    for (int frame = first; frame <= last; ++frame)
      if (on)
        skip.insert(frame);
      else
        skip.erase(frame);
  });
  commands.add_edit({"edit.poses_clear", "Clear the result's edits", "TAKE"},
                    [](Call& c) { c.take().pose_edits = PoseEdits{}; });
}

/// The take's weights as painted so far. Throws Error where they are not known.
const RowMatrix& painted(const Call& c) {
  const TakeState& state = c.take_state();
  US_CHECK(state.target && state.weights, "the target is still being prepared");
  US_CHECK(state.paint_problem.empty(), state.paint_problem);
  return *state.weights;
}

void keep(const Call& c, const WeightRows& changed) {
  auto& weights = c.take().target_edits.weights;
  weights = std::make_shared<const WeightRows>(
      placed(weights ? merged(*weights, changed) : changed, c.take_state().target->mesh.vertices));
}

void paint(Call& c) {
  const RowMatrix& weights = painted(c);
  Brush brush = c.session.brush;
  US_CHECK(brush.mode == BrushMode::Smooth || c.session.selected_joint >= 0,
           "choose the joint to paint first");
  brush.joint = std::max(0, c.session.selected_joint);
  const PaintSurface surface{c.take_state().target->mesh.vertices, c.studio.neighbours(c.take_number())};
  keep(c, stroke(weights, surface, c.vector(1, "place"), brush));
}

void move_face_mark(Call& c) {
  auto& face = c.take().target_edits.face;
  const FaceMove move{c.choice<FaceMark>(1, "mark", kFaceMarkNames), c.vector(2, "place")};
  c.label = "Move the " + face_mark_label(move.mark);
  put(move, face);
  if (!c.has("mirror", 5)) return;
  US_CHECK(c.take_state().target, "the target is still being prepared");
  put(mirrored(move, symmetry_centre(c.take_state().target->joints)), face);
}

void add_target_edits(Commands& commands) {
  commands.add_edit({"edit.target_joint", "Move a joint of the target", "TAKE JOINT X Y Z [mirror]: metres"},
                    [](Call& c) {
                      auto& moves = c.take().target_edits.joints;
                      const JointMove move{c.joint(1), c.vector(2, "place"), c.has("mirror", 5)};
                      c.label = "Move " + joint_label(move.joint) + " of the target";
                      const auto replaced = [&](const JointMove& old) { return old.joint == move.joint; };
                      moves.erase(std::remove_if(moves.begin(), moves.end(), replaced), moves.end());
                      moves.push_back(move);
                    });
  commands.add_edit({"edit.rest_bone", "Turn a bone of the rest pose",
                     "TAKE JOINT X Y Z [mirror]: axis times radians, in the bone's own frame"},
                    [](Call& c) {
                      auto& pose = c.take().target_edits.rest_pose;
                      const BoneTurn turn{c.joint(1), c.vector(2, "rotation")};
                      c.label = "Turn " + joint_label(turn.joint) + " of the rest pose";
                      pose = turned(pose, turn, c.has("mirror", 5));
                    });
  commands.add_edit({"edit.rest_pose_clear", "Reset the rest pose", "TAKE"},
                    [](Call& c) { c.take().target_edits.rest_pose.clear(); });
  commands.add_edit({"edit.target_joints_clear", "Reset the target's joints", "TAKE"},
                    [](Call& c) { c.take().target_edits.joints.clear(); });
  commands.add_edit({"edit.face_mark", "Move a mark of the face",
                     "TAKE nose|right_eye|left_eye|right_ear|left_ear X Y Z [mirror]: metres, in the T-pose"},
                    move_face_mark);
  commands.add_edit({"edit.face_clear", "Reset the face's marks", "TAKE"},
                    [](Call& c) { c.take().target_edits.face.clear(); });
  commands.add_slider({"edit.paint", "Paint weights", "TAKE X Y Z: a place on the T-pose's surface"}, paint);
}

void add_weight_tools(Commands& commands) {
  commands.add_edit(
      {"edit.weights_mirror", "Mirror weights", "TAKE left|right: the side that is copied"}, [](Call& c) {
        const RowMatrix& weights = painted(c);
        const auto side = c.choice(1, "side", {"left", "right"}) == 0 ? BodySide::Left : BodySide::Right;
        const Target& target = *c.take_state().target;
        keep(c, mirrored_weights(weights, target.mesh.vertices, side, symmetry_centre(target.joints)));
      });
  commands.add_edit({"edit.weights_smooth", "Smooth weights", "TAKE STRENGTH: 0 to 1"}, [](Call& c) {
    const RowMatrix& weights = painted(c);
    const float strength = c.clamped(1, "strength", 0.f, 1.f);
    keep(c, smoothed(weights, c.studio.neighbours(c.take_number()), {}, strength));
  });
  commands.add_edit(
      {"edit.weights_reproject", "Transfer painted weights to the present target", "TAKE"}, [](Call& c) {
        auto& weights = c.take().target_edits.weights;
        const auto& target = c.take_state().target;
        US_CHECK(weights && target, "there are no painted weights, or the target is still being prepared");
        weights = std::make_shared<const WeightRows>(reprojected(*weights, target->mesh.vertices));
      });
  commands.add_edit({"edit.weights_clear", "Clear painted weights", "TAKE"},
                    [](Call& c) { c.take().target_edits.weights.reset(); });
}

/// The take that an undone step had removed is the current one again.
void choose_returned(Session& session, const std::vector<Take>& before) {
  const std::vector<Take>& now = session.document.takes;
  if (now.size() <= before.size()) return;
  const auto alike = [](const Take& a, const Take& b) {
    return a.name == b.name && same(a.target, b.target);
  };
  const auto returned = std::mismatch(before.begin(), before.end(), now.begin(), alike).second;
  choose_take(session, static_cast<int>(returned - now.begin()));
}

void step_study(Call& c, bool back) {
  StudyState& state = c.session.study;
  state.study = back ? state.history.undo(*state.study) : state.history.redo(*state.study);
  state.changed = true;
  follow_design(state);
}

void add_history(Commands& commands) {
  const auto step = [](Call& c, bool back) {
    const std::string label = back ? undo_label(c.session) : redo_label(c.session);
    US_CHECK(c.arguments.empty() || c.arguments[0] == label, "'", c.word(0, "step"),
             "' is no longer the last step");
    if (back ? undoes_study(c.session) : redoes_study(c.session)) {
      step_study(c, back);
      return c.studio.notify((back ? "Undone: " : "Redone: ") + label);
    }
    History& history = c.session.history;
    const std::vector<Take> before = c.document.takes;
    const bool cropped = c.document.scan_edits.crop.has_value();
    c.document = back ? history.undo(c.document) : history.redo(c.document);
    choose_returned(c.session, before);
    if (cropped && !c.document.scan_edits.crop && c.session.tool == Tool::Crop)
      c.studio.run("tool", {"look"});
    c.session.changed = true;
    c.studio.notify((back ? "Undone: " : "Redone: ") + label);
  };
  commands.add({"edit.undo", "Undo", "[STEP: only where it is the last one]", "Ctrl+Z"},
               [step](Call& c) { step(c, true); });
  commands.add({"edit.redo", "Redo", "[STEP: only where it is the next one]", "Ctrl+Shift+Z"},
               [step](Call& c) { step(c, false); });
}

}  // namespace

void add_edit_commands(Commands& commands) {
  add_history(commands);
  add_scan_edits(commands);
  add_person_edits(commands);
  add_skeleton_edits(commands);
  add_pose_edits(commands);
  add_pose_ranges(commands);
  add_made_frames(commands);
  add_rearrangement(commands);
  add_target_edits(commands);
  add_weight_tools(commands);
}

}  // namespace understudy::app
