#include "tests/session/full_document.hpp"

#include "retarget/base/rng.hpp"

namespace understudy::app {
namespace {

ScanEdits scan_edits() {
  ScanEdits edits;
  edits.crop = Box{Vec3(-1.1f, 0.1f, -2), Vec3(1.2f, 2.1f, 2)};
  edits.floor = FloorCut{0.03f, FloorPlane{Vec3(0.1f, 0.99f, 0), 0.02f}, 0.03f, 0.04f, 0.11f};
  edits.largest_cluster = true;
  edits.cluster_gap_m = 0.07f;
  return edits;
}

std::shared_ptr<const WeightRows> weight_rows() {
  WeightRows rows;
  Rng rng(3);
  for (int v = 5; v < 60; v += 1 + rng.below(4)) rows.vertex.push_back(v);
  rows.rows = RowMatrix::Zero(static_cast<Eigen::Index>(rows.vertex.size()), kJointCount);
  for (Eigen::Index i = 0; i < rows.rows.rows(); ++i) {
    for (int k = 0; k < 4; ++k) rows.rows(i, rng.below(kJointCount)) += rng.uniform();
    rows.rows.row(i) /= rows.rows.row(i).sum();
  }
  return std::make_shared<const WeightRows>(std::move(rows));
}

PoseEdits pose_edits() {
  PoseEdits edits;
  edits.fill = {{14, 16, 0.5f, 2}};
  edits.go_on = GoOnEdit{2.5f, 0.25f, 1};
  edits.rotate = {{12, LeftElbow, Vec3(0.1f, -0.2f, 1 / 3.0f), 7, LeftWrist},
                  {0, Head, Vec3(1e-7f, 0, 0), 0}};
  edits.smooth = SmoothEdit{0.7f};
  edits.raise = RaiseEdit{-0.012f};
  edits.pin = PinEdit{false, false, {0.02f, 0.06f, 0.5f, 1.1f}, 0.3f, false, false, 0.05f};
  edits.turn = TurnEdit{-91.5f};
  edits.loop = LoopEdit{20, 47, 0.25f, 0.75f};
  edits.trim = Trim{3, 95};
  edits.skip = {4, 50, 51};
  edits.tempo = TempoEdit{TempoBy::Number, 0.8f, 1.1f, 0.87f, 1.2f, 0.036f, {{12, 0.25f}, {60, -0.125f}}};
  return edits;
}

Take take(const std::string& folder) {
  Take take;
  take.name = "Gräfin \"Zwei\"";
  take.target = {folder + "/targets/a b ü.obj",
                 {0.5f, -1.25f},
                 {"cm", "-z", 12.5f, 0.01f, 1.62f},
                 false,
                 Rig::Ours,
                 {{"left_wrist", "Hand.L"}, {"head", ""}},
                 NotAPerson::Use};
  take.method = {
      "paper", "paper", false, false, false,
      false,   false,   false, false, RootMode::InPlace,
      1.25f,   -0.05f,  0.5f,  true,  {"", folder + "/styles/mine.json", 0.75f, 0.5f, 1.25f, 0.1f}};
  take.target_edits.joints = {{LeftWrist, Vec3(0.7f, 1.4f, 0.02f), false}, {Spine1, Vec3(0, 1.1f, 0), true}};
  take.target_edits.weights = weight_rows();
  take.target_edits.rest_pose = {{LeftShoulder, Vec3(0, 0.1f, -0.75f)}};
  take.target_edits.face = {{FaceMark::RightEye, Vec3(-0.03f, 1.6f, 1 / 9.0f)}};
  take.pose_edits = pose_edits();
  return take;
}

std::vector<RigEdit> rig_edits() {
  return {MergeBone{3},
          SplitBone{2, Vec3(0.1f, 1 / 3.0f, -0.2f)},
          MoveJoint{1, Vec3(0, 0.5f, 0)},
          SetJointKind{4, JointKind::Hinge, Vec3(0, 0.6f, 0.8f)},
          RootAt{2},
          RenameBone{1, "tail \"one\""},
          PaintBone{5, {Vec3(0.3f, 0.2f, 0.1f), Vec3(0, 1 / 3.0f, 0)}, 0.04f, 0.75f, BrushMode::Subtract},
          TurnBone{3, 17, Vec3(0.1f, 0, -0.2f), 9},
          SmoothBones{4, 2, 30, 0.25f},
          KeepFrames{1, 40},
          FitAgain{}};
}

View view() {
  View view;
  view.layout = Layout::Wipe;
  view.linked = false;
  view.cameras = {{Vec3(1, 2, 3), -0.5f, 0.25f, 3.3f, 0.6f, true}, {}};
  view.follow = false;
  view.turntable_deg_s = 12;
  view.source = {false, true, false, false, true,  false,
                 true,  true, true,  false, false, Colouring::Confidence};
  view.take = {false, true, false, false, true, false, true, true, true, false, false, Colouring::Difference};
  view.active_pane = 2;
  view.weights_joint = LeftKnee;
  view.trail_joints = {LeftFoot, Head, Pelvis};
  view.ghost_count = 5;
  view.ghost_step = 3;
  view.ghosts_by_time = true;
  view.error_scale_mm = 25;
  view.wipe = 0.3f;
  view.cube = false;
  view.overlay = {0.5f, 0.25f, 0.75f, 1.5f};
  view.light = {-30, 12, 1.25f};
  view.background = Background::Custom;
  view.background_color = Vec3(0.25f, 0.5f, 0.75f);
  view.metric = "foot_skate";
  view.steps = false;
  view.bone_surface = BoneSurface::Beside;
  view.made_motions = BoneSurface::Over;
  view.canvases = {{0.25f, 0.75f, 2}, {}};
  view.lifted = true;
  view.reference = 0.75f;
  return view;
}

}  // namespace

SavedDocument full_document(const std::string& folder) {
  SavedDocument saved;
  saved.document.source = {folder + "/scans/läuft schnell",
                           folder + "/walk.npz",
                           {1.5f, 0},
                           59.94,
                           {"mm", "z", -90, 0.25f, 1.75f},
                           /*follow=*/true,
                           /*as_scan=*/false,
                           "clip 2",
                           {{"head", "Head"}},
                           /*quiet=*/false,
                           /*edits=*/{}};
  saved.document.source.person = "2";
  saved.document.source.times = folder + "/scans/times.csv";
  saved.document.source.complete = 60;
  saved.document.source.markers = folder + "/scans/markers.csv";
  saved.document.source.people = {{PersonEdit::How::Join, 3, 9, 1, 4}};
  saved.document.source.blend =
      BlendRecipe{{{folder + "/a walk.bvh", BlendRange{3, 40}, 0.25f, "0123456789abcdef"},
                   {folder + "/b.npz", {}, 0.75f, ""}},
                  2,
                  "plain"};
  saved.document.truth = folder + "/truth.npz";
  saved.document.scan_edits = scan_edits();
  saved.document.skeleton_edits = {DragEdit{7, RightAnkle, Vec3(0.01f, 0.02f, -0.03f), 9, true},
                                   SwapEdit{10, 20, SwapEdit::Limbs::Legs}};
  saved.document.bones = {true,
                          {12, "slots", "quadruped"},
                          rig_edits(),
                          {folder + "/an other.glb", {{"tail", "tail 2"}, {"horn", ""}}},
                          {{"trot", {40, FramesBetween{3, 17}, true, 7, 1, "vrnn", true}}}};
  saved.document.takes = {take(folder), Take{}};
  saved.document.takes[1].target.path = folder + "/b.glb";
  saved.document.source.layout = "coco17", saved.document.source.canvas = "1280x720";
  saved.document.source.stature = 1.5, saved.document.source.fov = 60, saved.document.source.pitch = 12;
  saved.document.source.smoothing = 0.5f;
  saved.document.source.point_edits = {PointDrag{7, body25::LeftWrist, 20.5f, 30, 4},
                                       SidesExchange{3, 9, SidesExchange::Limbs::Legs}};
  saved.document.flat = FlatSource{false};
  saved.document.takes[1].flat =
      FlatTake{"paper", FlatPlace::Source, false, false, "2", "640x360", {{"left_thigh", 120.5f, true}}};
  saved.view = view();
  saved.playback.loop = false;
  saved.playback.rate = 0.25;
  saved.playback.frame = 17.5;
  saved.playback.in = 3;
  saved.playback.out = 77;
  saved.weights = "skeleton.weights:0a1b2c3d";
  saved.selected_take = 1;
  return saved;
}

}  // namespace understudy::app
