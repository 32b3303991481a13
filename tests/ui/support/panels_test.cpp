#include "tests/ui/support/panels_test.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace understudy::ui {
namespace {

Joints standing(int frame) {
  Joints joints;
  for (int j = 0; j < kJointCount; ++j)
    joints.row(j) << 0.1f * static_cast<float>(j % 3), 1.8f - 0.07f * static_cast<float>(j),
        0.01f * static_cast<float>(frame);
  return joints;
}

app::KeptSource source_frame(int frame) {
  app::KeptSource kept;
  kept.raw = kept.joints = standing(frame);
  kept.confidence_of.setConstant(0.9f);
  kept.confidence = 0.8f + 0.1f * std::sin(0.3f * static_cast<float>(frame));
  kept.points = 8000 + frame;
  if (frame == 20) kept.flagged = true, kept.reason = "no points";
  if (frame == 31) kept.confidence = 0.2f;
  return kept;
}

std::shared_ptr<const Target> small_target() {
  auto target = std::make_shared<Target>();
  target->mesh.vertices = Points::Random(120, 3);
  target->mesh.faces = Faces::Zero(40, 3);
  target->joints = standing(0);
  target->warnings = {"the arms hang: a T-pose is expected"};
  return target;
}

std::vector<float> wave(int count, float base, float phase) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i)
    values.push_back(base * (1.2f + std::sin(0.2f * static_cast<float>(i) + phase)));
  return values;
}

app::TakeState performed_take(int frames, float phase) {
  app::TakeState take;
  take.ready = true;
  take.target = small_target();
  take.shown.poses.resize(static_cast<size_t>(frames));
  take.joints.assign(static_cast<size_t>(frames), standing(0));
  take.series = {{"confidence", "Confidence", "", wave(frames, 0.4f, phase)},
                 {"foot_skate", "Foot skate", "m/s", wave(frames, 0.1f, phase)},
                 {"pa_mpjpe_m", "PA-MPJPE", "m", wave(frames, 0.02f, phase)}};
  take.metrics = {{"pa_mpjpe_m", 0.0213}, {"foot_skate", 0.11 + phase}};
  for (int i = 0; i < frames; ++i) take.latency.add({2.1, 9.5 + 0.1 * i, 1.2, 3.4, 16.2 + 0.1 * i});
  take.cost = {3.2, 1.1, 0.008, 0.03};
  return take;
}

void add_takes(app::Session& session) {
  for (const char* name : {"adult", "child"}) {
    app::Take take;
    take.name = name, take.target.path = std::string("/data/") + name + ".glb";
    session.document.takes.push_back(take);
  }
  session.document.takes[1].method.engine = "paper";
  PoseEdits& edits = session.document.takes[0].pose_edits;
  edits.rotate.push_back({12, LeftElbow, Vec3(0.1f, 0, 0), 5});
  edits.trim = Trim{2, 40};
  edits.smooth = SmoothEdit{0.5f};
  session.document.takes[0].target_edits.joints.push_back({LeftWrist, Vec3(0.7f, 1.4f, 0), true});
  auto rows = std::make_shared<WeightRows>();
  rows->vertex = {3, 7}, rows->rows = RowMatrix::Constant(2, kJointCount, 1.f / kJointCount);
  session.document.takes[0].target_edits.weights = rows;
  session.takes = {performed_take(48, 0), performed_take(48, 0.7f)};
}

}  // namespace

app::Session loaded_session() {
  app::Session session;
  session.document.source.path = "/data/dance";
  session.document.scan_edits.crop = Box{Vec3(-1, 0, -1), Vec3(1, 2, 1)};
  session.document.scan_edits.floor = FloorCut{};
  session.document.skeleton_edits = {DragEdit{4, LeftWrist, Vec3(0, 0.05f, 0), 5, false},
                                     SwapEdit{10, 14, SwapEdit::Limbs::Legs}};
  session.source.name = "dance", session.source.count = 60, session.source.fps = 30;
  session.source.decision = "units: millimetres (from the height 1750), up: z, floor at 0.03 m";
  session.source.has_faces = true;
  for (int i = 0; i < 48; ++i) session.source.frames.push_back(source_frame(i));
  add_takes(session);
  session.working = true;
  session.playback.frame = 20, session.playback.live = false;
  session.playback.in = 5, session.playback.out = 30;
  session.jobs = {{7, "Retargeting", 0.6f, 12, true}};
  session.log = {{false, "opened dance"}, {true, "frame 20 has no points"}};
  session.selected_joint = LeftWrist;
  return session;
}

void PanelsTest::flag_frame(int frame, const std::string& reason) {
  session.source.frames.write(frame, frame + 1,
                              [&](size_t, app::KeptSource& bad) { bad.flagged = true, bad.reason = reason; });
}

void PanelsTest::panel(std::function<void()> draw) {
  in_window([draw = std::move(draw)](Ui&) { draw(); });
  frame(3);
  queue.clear();
}

void PanelsTest::panel(const std::string& name) {
  panel([this, draw = panel_of(name).draw] { draw(session, context); });
}

void PanelsTest::expect_known(const std::string& command) const {
  static const std::set<std::string> kOfTheWindow = {"dialog.open", "panel.show", "help.keys",
                                                     "help.here",   "menu.open",  "picture.save",
                                                     "video.save",  "file.show"};
  EXPECT_TRUE(kOfTheWindow.count(command) > 0 || studio.commands().find(command) != nullptr)
      << "there is no command " << command;
}

std::vector<std::string> PanelsTest::asked() {
  std::vector<std::string> lines;
  for (const auto& [name, arguments] : queue) expect_known(name);
  for (const auto& [name, arguments] : queue) lines.push_back(app::join_line(name, arguments));
  queue.clear();
  return lines;
}

void PanelsTest::expect_click(const std::string& mark, const std::vector<std::string>& lines) {
  queue.clear();
  click(mark);
  EXPECT_EQ(asked(), lines) << "by a click at " << mark;
}

void PanelsTest::expect_choice(const std::string& mark, int choice, const std::vector<std::string>& lines) {
  queue.clear();
  click(mark);
  frame(2);
  click(mark + "." + std::to_string(choice));
  EXPECT_EQ(asked(), lines) << "by choosing " << choice << " of " << mark;
}

void PanelsTest::write_into(const std::string& mark, const std::string& text) {
  click(mark);
  key(render::Key::A, {false, true});
  type(text);
}

void PanelsTest::expect_typed(const std::string& mark, const std::string& text,
                              const std::vector<std::string>& lines) {
  queue.clear();
  write_into(mark, text);
  key(render::Key::Enter);
  EXPECT_EQ(asked(), lines) << "by writing " << text << " into " << mark;
}

void PanelsTest::expect_drag(const std::string& mark, const std::string& beginning) {
  queue.clear();
  drag(mark, 0.3f, 0.7f);
  const std::vector<std::string> lines = asked();
  EXPECT_FALSE(lines.empty()) << "by dragging " << mark;
  for (const std::string& line : lines)
    EXPECT_EQ(line.rfind(beginning, 0), 0u) << line << ", by dragging " << mark;
}

WorkspaceTest::WorkspaceTest()
    : workspace(
          {[this] { ++views_drawn; },
           {{"A walk", "3D scans of a person", {"/samples/scan", "/samples/adult.glb"}, nullptr},
            {"A child walks", "A motion and a child", {"/samples/walk", "/samples/child.glb"}, nullptr}},
           [] { return std::string("understudy 0.1.0\nEGL, llvmpipe"); }}) {
  input.size = {1280, 800};
  content = [this](Ui&) {
    workspace.draw(session, context, 60);
    obey();
  };
}

void WorkspaceTest::obey() {
  for (const auto& [name, arguments] : std::exchange(queue, {})) {
    expect_known(name);
    log.push_back(app::join_line(name, arguments));
    if (name == "panel.show") workspace.show_panel(session.settings, arguments[0], arguments[1] == "on");
    if (name == "dialog.open") workspace.open_dialog(session, arguments[0]);
    if (name == "menu.open") workspace.open_menu(session, arguments.empty() ? "" : arguments[0]);
    if (name == "help.keys") workspace.open_dialog(session, "keys");
    if (name == "help.here") workspace.open_dialog(session, "here");
    if (name == "question.answer") session.question.reset();
    if (name == "error.dismiss") session.errors.pop_front();
    if (name == "notice.dismiss") {
      auto& all = session.notices;
      all.erase(
          std::remove_if(all.begin(), all.end(),
                         [&, id = std::stoll(arguments[0])](const app::Notice& one) { return one.id == id; }),
          all.end());
    }
    if (name == "help.getting_started")
      session.settings.getting_started = arguments.empty()       ? 1
                                         : arguments[0] == "off" ? 0
                                                                 : std::stoi(arguments[0]);
  }
}

std::vector<std::string> WorkspaceTest::take_log() {
  return std::exchange(log, {});
}

}  // namespace understudy::ui
