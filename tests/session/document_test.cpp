#include "app/session/document.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "app/session/background.hpp"
#include "app/session/history.hpp"
#include "retarget/base/error.hpp"
#include "tests/session/full_document.hpp"

namespace understudy::app {
namespace {

using Change = std::function<void(SavedDocument&)>;
using Changes = std::vector<std::pair<const char*, Change>>;

DragEdit& drag(Document& d) {
  return std::get<DragEdit>(d.skeleton_edits[0]);
}
SwapEdit& swap(Document& d) {
  return std::get<SwapEdit>(d.skeleton_edits[1]);
}
void change_weights(SavedDocument& s, const std::function<void(WeightRows&)>& change) {
  WeightRows rows = *s.document.takes[0].target_edits.weights;
  change(rows);
  s.document.takes[0].target_edits.weights = std::make_shared<const WeightRows>(std::move(rows));
}

#define CHANGE(what)                                              \
  {                                                               \
#what, [](SavedDocument& s) { Document& d = s.document; d.what; } \
  }
#define TAKE(what)                                                     \
  {                                                                    \
#what, [](SavedDocument& s) { Take& t = s.document.takes[0]; t.what; } \
  }
#define POSES(what)                                                                    \
  {                                                                                    \
#what, [](SavedDocument& s) { PoseEdits& p = s.document.takes[0].pose_edits; p.what; } \
  }

/// One change of each member of a document.
const Changes& document_changes() {
  static const Changes changes{
      CHANGE(source.path += "x"),
      CHANGE(source.motion.clear()),
      CHANGE(source.betas[0] += 1),
      CHANGE(source.betas.pop_back()),
      CHANGE(source.fps = 30),
      CHANGE(source.times.clear()),
      CHANGE(source.complete = 0),
      CHANGE(source.markers.clear()),
      CHANGE(source.import.units = "m"),
      CHANGE(source.import.up = "y"),
      CHANGE(source.import.turn_deg += 1),
      CHANGE(source.import.floor.reset()),
      CHANGE(source.import.floor = 0),
      CHANGE(source.as_scan = true),
      CHANGE(source.clip += "x"),
      CHANGE(source.bones.clear()),
      CHANGE(source.import.height.reset()),
      CHANGE(source.person = "7"),
      CHANGE(source.people.clear()),
      CHANGE(source.people[0].how = PersonEdit::How::Exchange),
      CHANGE(source.people[0].first += 1),
      CHANGE(source.people[0].last += 1),
      CHANGE(source.people[0].person += 10),
      CHANGE(source.people[0].other += 10),
      CHANGE(source.blend.reset()),
      CHANGE(source.blend->parts.pop_back()),
      CHANGE(source.blend->parts[0].path += "x"),
      CHANGE(source.blend->parts[0].range.reset()),
      CHANGE(source.blend->parts[0].range->first += 1),
      CHANGE(source.blend->parts[0].range->last += 1),
      CHANGE(source.blend->parts[0].weight += 0.125f),
      CHANGE(source.blend->parts[0].checksum.clear()),
      CHANGE(source.blend->cycles += 1),
      CHANGE(source.blend->coder = "paper"),
      CHANGE(truth.clear()),
      CHANGE(scan_edits.crop.reset()),
      CHANGE(scan_edits.crop->low.x() -= 1),
      CHANGE(scan_edits.crop->high.z() += 1),
      CHANGE(scan_edits.floor.reset()),
      CHANGE(scan_edits.floor->height_m += 1),
      CHANGE(scan_edits.floor->plane.reset()),
      CHANGE(scan_edits.floor->plane->normal.x() = 0),
      CHANGE(scan_edits.floor->plane->height_m = 0),
      CHANGE(scan_edits.floor->tolerance_m += 1),
      CHANGE(scan_edits.floor->sole_radius_m += 1),
      CHANGE(scan_edits.floor->sole_band_m += 1),
      CHANGE(scan_edits.largest_cluster = false),
      CHANGE(scan_edits.cluster_gap_m += 1),
      CHANGE(skeleton_edits.pop_back()),
      CHANGE(flat.reset()),
      CHANGE(source.canvas.clear()),
      CHANGE(source.layout.clear()),
      CHANGE(source.stature = 1.7),
      CHANGE(source.fov = 40),
      CHANGE(source.pitch.reset()),
      CHANGE(source.smoothing = 1),
      CHANGE(flat->ahead = true),
      CHANGE(source.point_edits.pop_back()),
      CHANGE(source.point_edits[0] = SidesExchange{}),
      CHANGE(takes[1].flat.reset()),
      CHANGE(takes[1].flat->engine = "limbs"),
      CHANGE(takes[1].flat->place = FlatPlace::Reference),
      CHANGE(takes[1].flat->touches = true),
      CHANGE(takes[1].flat->growth = true),
      CHANGE(takes[1].flat->person.clear()),
      CHANGE(takes[1].flat->canvas.clear()),
      CHANGE(takes[1].flat->lengths[0].bone = "trunk"),
      CHANGE(takes[1].flat->lengths[0].pixels = 1),
      CHANGE(takes[1].flat->lengths[0].locked = false),
      CHANGE(skeleton_edits[0] = SwapEdit{}),
      {"drag.frame", [](SavedDocument& s) { ++drag(s.document).frame; }},
      {"drag.joint", [](SavedDocument& s) { ++drag(s.document).joint; }},
      {"drag.offset", [](SavedDocument& s) { drag(s.document).offset.y() = 0; }},
      {"drag.falloff", [](SavedDocument& s) { ++drag(s.document).falloff; }},
      {"drag.with_children", [](SavedDocument& s) { drag(s.document).with_children = false; }},
      {"swap.first", [](SavedDocument& s) { ++swap(s.document).first; }},
      {"swap.last", [](SavedDocument& s) { ++swap(s.document).last; }},
      {"swap.limbs", [](SavedDocument& s) { swap(s.document).limbs = SwapEdit::Limbs::Arms; }},
      CHANGE(bones.wanted = false),
      CHANGE(bones.search.most = 7),
      CHANGE(bones.search.method = "parts"),
      CHANGE(bones.search.kind = "hand"),
      CHANGE(bones.edits.pop_back()),
      CHANGE(bones.edits[0] = FitAgain{}),
      CHANGE(bones.second.path += "x"),
      CHANGE(bones.second.matches.push_back({"arm", "leg"})),
      CHANGE(bones.second.clip += "x"),
      CHANGE(bones.clips.pop_back()),
      CHANGE(bones.clips[0].name = "other"),
      CHANGE(bones.clips[0].how.frames = 3),
      CHANGE(bones.clips[0].how.between->first = 4),
      CHANGE(bones.clips[0].how.between->last = 4),
      CHANGE(bones.clips[0].how.between.reset()),
      CHANGE(bones.clips[0].how.loop = false),
      CHANGE(bones.clips[0].how.seed = 2),
      CHANGE(bones.clips[0].how.engine = "match"),
      CHANGE(bones.clips[0].how.paper_sampling = false),
      CHANGE(takes.pop_back()),
      TAKE(name = "other"),
      TAKE(person = "7"),
      TAKE(target.path += "x"),
      TAKE(target.betas.clear()),
      TAKE(target.import.units = "m"),
      TAKE(target.import.height.reset()),
      TAKE(target.forward = true),
      TAKE(target.not_a_person = NotAPerson::Refuse),
      TAKE(target.rig = Rig::Own),
      TAKE(target.bones.erase("head")),
      TAKE(target.bones["left_wrist"] = "hand.L"),
      TAKE(method.engine = "copy"),
      TAKE(method.extractor = "dense"),
      TAKE(method.offsets = true),
      TAKE(method.repair_swaps = true),
      TAKE(method.smooth_joints = true),
      TAKE(method.fix_lengths = true),
      TAKE(method.lock_feet = true),
      TAKE(method.hand_contacts = true),
      TAKE(method.part_refiner = true),
      TAKE(method.path = RootMode::Original),
      TAKE(method.stride = 1),
      TAKE(method.hip_height = 0),
      TAKE(method.arm_reach = 0),
      TAKE(method.predict = false),
      TAKE(method.style.name = "child"),
      TAKE(method.style.file.clear()),
      TAKE(method.style.strength = 1),
      TAKE(method.style.posture = 1),
      TAKE(method.style.size = 1),
      TAKE(method.style.liveliness = 1),
      TAKE(target_edits.joints.pop_back()),
      TAKE(target_edits.joints[0].joint = Head),
      TAKE(target_edits.joints[0].position.x() = 0),
      TAKE(target_edits.joints[0].mirror = true),
      TAKE(target_edits.weights.reset()),
      TAKE(target_edits.rest_pose.pop_back()),
      TAKE(target_edits.face.pop_back()),
      TAKE(target_edits.face[0].mark = FaceMark::LeftEar),
      TAKE(target_edits.face[0].place.y() = 0),
      TAKE(target_edits.rest_pose[0].joint = RightCollar),
      TAKE(target_edits.rest_pose[0].axis_angle.z() = 0),
      {"weights.vertex",
       [](SavedDocument& s) { change_weights(s, [](WeightRows& rows) { --rows.vertex[0]; }); }},
      {"weights.rows",
       [](SavedDocument& s) {
         change_weights(s, [](WeightRows& rows) { rows.rows.row(0) = RowMatrix::Identity(1, kJointCount); });
       }},
      {"weights.places",
       [](SavedDocument& s) {
         change_weights(s, [](WeightRows& rows) { rows = placed(rows, Points::Random(100, 3)); });
       }},
      {"weights.of",
       [](SavedDocument& s) {
         change_weights(s, [](WeightRows& rows) { rows = placed(rows, Points::Random(101, 3)); });
       }},
      POSES(fill.pop_back()),
      POSES(fill[0].first = 1),
      POSES(fill[0].last = 17),
      POSES(fill[0].learned = 0.25f),
      POSES(fill[0].variation = 1),
      POSES(go_on.reset()),
      POSES(go_on->seconds += 1),
      POSES(go_on->learned = 1),
      POSES(go_on->variation = 3),
      POSES(rotate.pop_back()),
      POSES(rotate[0].frame = 1),
      POSES(rotate[0].joint = 1),
      POSES(rotate[0].axis_angle.z() += 0.1f),
      POSES(rotate[0].falloff = 1),
      POSES(rotate[0].limb.reset()),
      POSES(smooth.reset()),
      POSES(smooth->strength = 0.5f),
      POSES(raise.reset()),
      POSES(raise->offset_m = 0),
      POSES(pin.reset()),
      POSES(pin->left = true),
      POSES(pin->right = true),
      POSES(pin->contact.begin_height_m += 1),
      POSES(pin->contact.end_height_m += 1),
      POSES(pin->contact.begin_speed += 1),
      POSES(pin->contact.end_speed += 1),
      POSES(pin->blend_s += 1),
      POSES(pin->keep_soles_up = true),
      POSES(pin->to_floor = true),
      POSES(pin->max_drop_m += 1),
      POSES(turn.reset()),
      POSES(turn->turn_deg += 1),
      POSES(loop.reset()),
      POSES(loop->first += 1),
      POSES(loop->last += 1),
      POSES(loop->seam_s = 0),
      POSES(loop->learned = 0),
      POSES(trim.reset()),
      POSES(trim->first = 0),
      POSES(trim->last = 9),
      POSES(skip.insert(6)),
      POSES(tempo.reset()),
      POSES(tempo->by = TempoBy::Body),
      POSES(tempo->length = 1),
      POSES(tempo->anticipation = 1),
      POSES(tempo->stroke = 1),
      POSES(tempo->recovery = 1),
      POSES(tempo->spread = 0),
      POSES(tempo->marks.pop_back()),
      POSES(tempo->marks[0].frame = 13),
      POSES(tempo->marks[0].later_s = 0),
  };
  return changes;
}

/// Does not compile once a member is added: then it belongs into fields() and the changes above, too.
[[maybe_unused]] void all_members_are_known() {
  [[maybe_unused]] const auto& [source, truth, scan, skeleton, flat_source, bones, takes] = Document();
  [[maybe_unused]] const auto& [ahead] = FlatSource();
  [[maybe_unused]] const auto& [point_frame, point, point_x, point_y, point_falloff] = PointDrag();
  [[maybe_unused]] const auto& [sides_first, sides_last, sides] = SidesExchange();
  [[maybe_unused]] const auto& [flat_engine, place, touches, grows, flat_person, flat_canvas, flat_lengths] =
      FlatTake();
  [[maybe_unused]] const auto& [bone, pixels, locked] = ChosenLength();
  [[maybe_unused]] const auto& [canvas_x, canvas_y, zoom] = CanvasView();
  [[maybe_unused]] const auto& [wanted, search, bone_edits, second, clips] = OwnBones();
  [[maybe_unused]] const auto& [most, bones_method, body_kind] = BoneSearch();
  [[maybe_unused]] const auto& [clip_name, clip_how] = MadeClip();
  [[maybe_unused]] const auto& [made_frames, between, made_loop, seed, count, made_engine, paper_sampling] =
      GenerationOptions();
  [[maybe_unused]] const auto& [between_first, between_last] = FramesBetween();
  [[maybe_unused]] const auto& [second_path, matches, second_clip] = SecondBody();
  [[maybe_unused]] const auto& [path, motion, betas, fps, import, follow, stream, wait, as_scan, clip,
                                source_bones, quiet, with_truth, person, times, complete, markers, made,
                                people, recipe, point_order, picture_size, stature, view_fov, view_pitch,
                                calm, point_edits, edits] = SourceOptions();
  [[maybe_unused]] const auto& [parts, cycles, coder] = BlendRecipe();
  [[maybe_unused]] const auto& [part_path, part_range, part_weight, part_checksum] = BlendPart();
  [[maybe_unused]] const auto& [range_first, range_last] = BlendRange();
  [[maybe_unused]] const auto& [how, edit_first, edit_last, whose, other] = PersonEdit();
  [[maybe_unused]] const auto& [units, up, yaw, floor, body_height] = ImportOptions();
  [[maybe_unused]] const auto& [crop, cut, cluster, gap] = ScanEdits();
  [[maybe_unused]] const auto& [low, high] = Box();
  [[maybe_unused]] const auto& [cut_height, plane, tolerance, radius, band] = FloorCut();
  [[maybe_unused]] const auto& [normal, height] = FloorPlane();
  [[maybe_unused]] const auto& [drag_frame, drag_joint, offset, drag_falloff, children] = DragEdit();
  [[maybe_unused]] const auto& [swap_first, swap_last, limbs] = SwapEdit();
  [[maybe_unused]] const auto& [name, performed, target, method, target_edits, pose_edits, flat] = Take();
  [[maybe_unused]] const auto& [target_path, target_betas, target_import, target_forward, target_rig,
                                target_bones, not_a_person] = TargetOptions();
  [[maybe_unused]] const auto& [engine, extractor, near, offsets, swaps, smooth, lengths, feet, contacts,
                                root, stride, hip_height, arm_reach, predict, style] = Method();
  [[maybe_unused]] const auto& [style_name, style_file, style_strength, posture, size, liveliness] =
      StyleChoice();
  [[maybe_unused]] const auto& [by, length, anticipation, stroke, recovery, unlike, tempo_marks] =
      TempoEdit();
  [[maybe_unused]] const auto& [mark_frame, later] = TempoMark();
  [[maybe_unused]] const auto& [moves, weights, rest_pose, face] = TargetEdits();
  [[maybe_unused]] const auto& [face_mark, face_place] = FaceMove();
  [[maybe_unused]] const auto& [turned_joint, axis_angle] = BoneTurn();
  [[maybe_unused]] const auto& [moved, position, mirror] = JointMove();
  [[maybe_unused]] const auto& [vertex, rows, places, of] = WeightRows();
  [[maybe_unused]] const auto& [fill, go_on, rotate, smoothing, floors, pin, heading, looped, trim, skip,
                                tempo] = PoseEdits();
  [[maybe_unused]] const auto& [seconds, on_learned, on_variation] = GoOnEdit();
  [[maybe_unused]] const auto& [loop_first, loop_last, seam, loop_learned] = LoopEdit();
  [[maybe_unused]] const auto& [fill_first, fill_last, fill_learned, fill_variation] = FillEdit();
  [[maybe_unused]] const auto& [frame, joint, turn, falloff, limb] = RotateEdit();
  [[maybe_unused]] const auto& [left, right, contact, blend, soles, to_floor, drop] = PinEdit();
  [[maybe_unused]] const auto& [begin_height, end_height, begin_speed, end_speed] = FootContactOptions();
  [[maybe_unused]] const auto& [strength] = SmoothEdit();
  [[maybe_unused]] const auto& [offset_m] = RaiseEdit();
  [[maybe_unused]] const auto& [turn_deg] = TurnEdit();
  [[maybe_unused]] const auto& [first, last] = Trim();
  [[maybe_unused]] const auto& [layout, linked, cameras, follows, turntable, of_source, of_take, pane,
                                weights_joint, trails, ghosts, step, by_time, scale, wipe, cube, overlay,
                                light, background, background_color, metric, steps, bone_surface,
                                made_motions, canvases, lifted, reference] = View();
  [[maybe_unused]] const auto& [of_scan, of_skeletons, of_results, spread] = OverlayLook();
  [[maybe_unused]] const auto& [light_turn, light_height, brightness] = LightLook();
  [[maybe_unused]] const auto& [at, yaw_rad, pitch, distance, fov, orthographic] = CameraState();
  [[maybe_unused]] const auto& [surface, points, joint_layer, x_ray, names, ground, trail, ghost, wireframe,
                                scenery, bone_layer, colouring] = Layers();
  [[maybe_unused]] const auto& [playing, loop, live, rate, now, in, out] = Playback();
}

TEST(Document, IsAnotherAfterAnyChange) {
  const SavedDocument before = full_document("/a");
  EXPECT_TRUE(same(before.document, full_document("/a").document));  // weights of another address
  for (const auto& [name, change] : document_changes()) {
    SavedDocument after = before;
    change(after);
    EXPECT_FALSE(same(before.document, after.document)) << name;
    EXPECT_FALSE(same(after.document, before.document)) << name;
  }
}

TEST(Document, SameAreThoseWithTheSameText) {
  const SavedDocument before = full_document("/a");
  const std::string text = to_json(before, "/a").dump();
  EXPECT_EQ(text, to_json(full_document("/a"), "/a").dump());
  for (const auto& [name, change] : document_changes()) {
    SavedDocument after = before;
    change(after);
    const auto json = to_json(after, "/a");
    EXPECT_TRUE(json.dump() != text) << name;
    EXPECT_TRUE(same(from_json(json, "/a", "doc").document, after.document)) << name;
  }
}

TEST(Document, FillsOfOlderOnesAreTheBestAnswerAndThereAreFour) {
  auto json = to_json(full_document("/a"), "/a");
  auto& edits = json["takes"][0]["pose_edits"];
  EXPECT_EQ(edits["fill"][0]["variation"], 2);
  edits["fill"][0]["variation"] = 4;
  EXPECT_THROW(from_json(json, "/a", "doc"), Error);
  edits["fill"][0].erase("variation");
  edits["go_on"].erase("variation");
  const PoseEdits read = from_json(json, "/a", "doc").document.takes[0].pose_edits;
  EXPECT_EQ(read.fill[0].variation, 0);
  EXPECT_EQ(read.go_on->variation, 0);
}

TEST(Document, WhatBelongsToOneRunIsNoMatter) {
  Document a, b;
  b.source.quiet = b.source.follow = true;
  b.source.edits.largest_cluster = true;
  EXPECT_TRUE(same(a, b));
}

/// The document without what needs no new frames.
Document made_anew(Document document) {
  document.truth.clear();
  document.bones = {};  // they are found beside the frames
  document.flat.reset();
  auto& takes = document.takes;  // those of people in pictures are performed beside it
  takes.erase(
      std::remove_if(takes.begin(), takes.end(), [](const Take& take) { return take.flat.has_value(); }),
      takes.end());
  for (Take& take : document.takes)
    take.name.clear(), take.target_edits.weights.reset(), take.target_edits.face.clear(),
        take.pose_edits = {};
  return document;
}

TEST(Document, EachChangeThatNeedsNewFramesGivesAnotherPlan) {
  const Document before = full_document("/a").document;
  std::set<std::string> keys{key_of(before)};
  for (const auto& [name, change] : document_changes()) {
    SavedDocument after = full_document("/a");
    change(after);
    const Document& now = after.document;
    EXPECT_TRUE(keys.insert(key_of(now)).second) << name;
    EXPECT_EQ(key_of(plan_of(before, {1, 2})) == key_of(plan_of(now, {1, 2})),
              same(made_anew(before), made_anew(now)))
        << name;
    EXPECT_EQ(key_of(before.source, before.scan_edits) == key_of(now.source, now.scan_edits),
              same(before.source, now.source) && same(before.scan_edits, now.scan_edits))
        << name;
  }
}

TEST(Document, EachEditOfTheResultGivesOtherPosesButTrimAndSkip) {
  const PoseEdits before = full_document("/a").document.takes[0].pose_edits;
  for (const auto& [name, change] : document_changes()) {
    SavedDocument after = full_document("/a");
    change(after);
    const PoseEdits& now = after.document.takes[0].pose_edits;
    const bool only_plays =
        std::string(name).rfind("trim", 0) == 0 || std::string(name).rfind("skip", 0) == 0;
    EXPECT_EQ(same_poses(before, now), only_plays || same(before, now)) << name;
  }
}

TEST(Document, NoWeightsAreAsGoodAsNone) {
  TargetEdits a, b;
  b.weights = std::make_shared<const WeightRows>();
  EXPECT_TRUE(same(a, b));
}

class HistoryTest : public testing::Test {
 protected:
  static Document state(double fps) {
    Document document;
    document.source.fps = fps;
    return document;
  }
  History history;
  History::Time now{};
  void later(int ms) { now += std::chrono::milliseconds(ms); }
};

TEST_F(HistoryTest, GoesBackAndForth) {
  history.add(state(1), "First");
  history.add(state(2), "Second");
  EXPECT_EQ(history.undo_label(), "Second");
  EXPECT_EQ(history.undo(state(3)).source.fps, 2);
  EXPECT_EQ(history.undo_label(), "First");
  EXPECT_EQ(history.redo_label(), "Second");
  EXPECT_EQ(history.undo(state(2)).source.fps, 1);
  EXPECT_FALSE(history.can_undo());
  EXPECT_EQ(history.undo_label(), "");
  EXPECT_THROW(history.undo(state(1)), Error);
  EXPECT_EQ(history.redo(state(1)).source.fps, 2);
  EXPECT_EQ(history.redo(state(2)).source.fps, 3);
  EXPECT_FALSE(history.can_redo());
  EXPECT_THROW(history.redo(state(3)), Error);
}

TEST_F(HistoryTest, AStepForgetsWhatWasUndone) {
  history.add(state(1), "First");
  history.undo(state(2));
  history.add(state(1), "Other");
  EXPECT_FALSE(history.can_redo());
  EXPECT_EQ(history.undo(state(5)).source.fps, 1);
}

TEST_F(HistoryTest, ADragIsOneStep) {
  for (int i = 0; i < 10; ++i) {
    history.add(state(i), "Drag", "drag left_wrist", now);
    later(900);  // each within a second of the last, not of the first
  }
  EXPECT_EQ(history.undo(state(10)).source.fps, 0);
  EXPECT_FALSE(history.can_undo());
}

TEST_F(HistoryTest, APauseAnotherDragOrNoNameIsANewStep) {
  history.add(state(0), "Drag", "left", now);
  later(1001);
  history.add(state(1), "Drag", "left", now);
  history.add(state(2), "Drag", "right", now);
  history.add(state(3), "Add", "", now);
  history.add(state(4), "Add", "", now);
  for (const double fps : {4, 3, 2, 1, 0}) EXPECT_EQ(history.undo(state(9)).source.fps, fps);
}

TEST_F(HistoryTest, ADragAfterAnUndoIsANewStep) {
  history.add(state(0), "Drag", "left", now);
  history.add(state(1), "Drag", "right", now);
  history.undo(state(2));
  history.add(state(1), "Drag", "right", now);
  EXPECT_EQ(history.undo(state(2)).source.fps, 1);
  EXPECT_EQ(history.undo(state(1)).source.fps, 0);
}

TEST_F(HistoryTest, ForgetsWhatIsTooOld) {
  History shallow(3);
  for (int i = 0; i < 10; ++i) shallow.add(state(i), "Step");
  for (const double fps : {9, 8, 7}) EXPECT_EQ(shallow.undo(state(10)).source.fps, fps);
  EXPECT_FALSE(shallow.can_undo());
  for (int i = 0; i < 10; ++i) history.add(state(i), "Step");
  history.set_depth(2);
  history.undo(state(10));
  history.undo(state(9));
  EXPECT_FALSE(history.can_undo());
}

TEST_F(HistoryTest, SharesWhatIsLarge) {
  Document document = full_document("/a").document;
  const auto weights = document.takes[0].target_edits.weights;
  const long users = weights.use_count();
  for (int i = 0; i < 5; ++i) history.add(document, "Step");
  EXPECT_EQ(weights.use_count(), users + 5);
  EXPECT_EQ(history.undo(document).takes[0].target_edits.weights, weights);
}

TEST(BadFrames, AJointThatWasDraggedToItsPlaceIsNoLongerOne) {
  Session session;
  KeptSource good;
  good.confidence = 1, good.confidence_of.setOnes();
  for (int j = 1; j < kJointCount; ++j)
    good.joints.row(j) = good.joints.row(kParents[j]) + Vec3(0, 0.3f, 0).transpose();
  good.raw = good.joints;
  for (int i = 0; i < 20; ++i) session.source.frames.push_back(good);
  KeptSource wrong = good;
  wrong.raw.row(LeftWrist) += Vec3(0, 0.2f, 0).transpose();
  session.source.frames.write(7, 8, [&](size_t, KeptSource& frame) { frame = wrong; });
  ASSERT_EQ(bad_frames(session).size(), 1u);
  EXPECT_NE(bad_frames(session)[0].why.find("changed length (+67 %)"), std::string::npos);
  session.document.skeleton_edits = {DragEdit{7, LeftWrist, Vec3(0, -0.2f, 0), 0, false}};
  EXPECT_TRUE(bad_frames(session).empty());
  session.document.skeleton_edits = {DragEdit{7, LeftWrist, Vec3(0, 0.2f, 0), 0, false}};
  ASSERT_EQ(bad_frames(session).size(), 1u) << "dragged further away";
}

}  // namespace
}  // namespace understudy::app
