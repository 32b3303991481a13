#include "ui/panels/export_poses.hpp"

#include <algorithm>
#include <optional>

#include "retarget/base/text.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

void draw_drawing(Ui& ui, app::PoseChoice& poses) {
  render::PosePictureOptions& drawing = poses.drawing;
  int points = static_cast<int>(drawing.layout);
  if (choice_row(ui,
                 {"export.points",
                  "Points",
                  "Which of them are drawn",
                  "",
                  {"What ControlNet's models know: no mid-hip, no feet", "OpenPose's 25, with the feet"}},
                 {"OpenPose-18", "BODY_25"}, points))
    drawing.layout = static_cast<render::PoseLayout>(points);
  if (const auto width = typed_number_row(
          ui, {"export.stick_width", "Stick width", "Half of it, pixels; 0: as the canvas asks, 4 up to 512"},
          static_cast<double>(drawing.half_width), 1))
    drawing.half_width = static_cast<float>(std::clamp(*width, 0.0, 200.0));
}

void draw_count(Ui& ui, app::PoseChoice& poses) {
  int how = poses.count.is_4n_plus_1 ? 1 : 0;
  if (choice_row(ui,
                 {"export.count",
                  "Pictures",
                  "How many",
                  "",
                  {"As many as the take lasts", "Cut to 1, 5, 9, ... as film generators ask"}},
                 {"All", "4n + 1"}, how))
    poses.count = {0, how == 1};
}

/// Sizes that generators ask for; before them, where there is a reference, its own.
void draw_canvas(Ui& ui, app::PoseChoice& poses, bool has_reference) {
  const auto& presets = app::kCanvasPresets;
  const std::optional<Canvas> now = poses.canvas || has_reference ? poses.canvas : Canvas{832, 480};
  std::vector<std::string> labels;
  int chosen = -1;
  if (has_reference) {
    if (!now) chosen = 0;
    labels.push_back("As the reference");
  }
  const size_t before = labels.size();
  for (const app::CanvasPreset& preset : presets) {
    if (preset.canvas == now) chosen = static_cast<int>(labels.size());
    labels.push_back(canvas_text(preset.canvas) + "   " + preset.words);
  }
  row(ui, "Canvas", "Size of the pictures, and who asks for it");
  if (!dropdown(ui, "export.canvas", labels, chosen)) return;
  const auto k = static_cast<size_t>(chosen);
  poses.canvas = k < before ? std::nullopt : std::optional<Canvas>(presets[k - before].canvas);
}

/// Files of 2D poses that the document has open.
std::vector<std::string> open_poses(const app::Session& session) {
  std::vector<std::string> paths;
  const auto add = [&](const std::string& path) {
    if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
  };
  if (session.document.flat) add(session.document.source.path);
  for (size_t k = 0; k < session.takes.size(); ++k)
    if (const auto& flat = session.takes[k].flat; flat && flat->reference->target.standing)
      add(session.document.takes[k].target.path);
  return paths;
}

/// What the first frame is laid onto.
void draw_reference(const app::Session& session, Ui& ui, ExportState& state, FilesState& files) {
  std::vector<std::string> paths = open_poses(session), labels;
  std::string& now = state.choice.poses.camera.reference;
  if (now.empty() && !paths.empty()) now = paths.front();
  auto found = std::find(paths.begin(), paths.end(), now);
  if (found == paths.end() && !now.empty()) found = paths.insert(paths.end(), now);
  int chosen = now.empty() ? -1 : static_cast<int>(found - paths.begin());
  for (const std::string& path : paths) labels.push_back(file_name(path));
  labels.push_back("Choose poses\u2026");
  row(ui, "Reference", "2D poses of a picture: the first frame is laid onto the first of them");
  if (paths.empty()) {
    ButtonOptions wide;
    wide.width = -1;
    if (button(ui, "export.reference", labels.back(), wide))
      choose_file(session, files, FilePurpose::Reference);
    return;
  }
  if (!dropdown(ui, "export.reference", labels, chosen, paths)) return;
  if (static_cast<size_t>(chosen) < paths.size())
    now = paths[static_cast<size_t>(chosen)];
  else
    choose_file(session, files, FilePurpose::Reference);
}

void draw_camera(const app::Session& session, Ui& ui, ExportState& state, FilesState& files) {
  int camera = state.choice.pane_camera ? 0 : state.lays_onto ? 2 : 1;
  if (choice_row(
          ui,
          {"export.camera",
           "Camera",
           "What the pictures are seen through",
           "",
           {"As the take's view is seen now", "Before the front of the first frame, all of the take in view",
            "In which the first frame lies on the person of a picture, by their 2D poses"}},
          {"This view", "Whole take", "Onto poses"}, camera)) {
    state.choice.pane_camera = camera == 0, state.lays_onto = camera == 2;
    if (!state.lays_onto) state.choice.poses.camera.reference.clear();
  }
  if (state.lays_onto) draw_reference(session, ui, state, files);
}

/// Leaves the dialog for the tool.
void draw_face_button(PanelContext& context) {
  ButtonOptions options;
  options.width = -1;
  options.tooltip = "Shows where nose, eyes and ears are on the head, to drag what lies wrong";
  if (!button(context.ui, "export.face", "Place the face's marks\u2026", options)) return;
  context.ask("tool", {app::kToolNames[static_cast<size_t>(app::Tool::Face)]});
  context.ask("dialog.open", {"none"});
}

void draw_beside(Ui& ui, app::PoseChoice& poses) {
  int file = static_cast<int>(poses.file);
  if (choice_row(ui,
                 {"export.pose_file",
                  "Points beside",
                  "The same points as a file",
                  "",
                  {"One list, as ControlNet and ComfyUI have it", "A folder of OpenPose's JSONs", "No file"}},
                 {"ControlNet", "OpenPose", "None"}, file))
    poses.file = static_cast<app::PoseFile>(file);
}

}  // namespace

void draw_pose_rows(const app::Session& session, PanelContext& context, ExportState& state,
                    FilesState& files) {
  Ui& ui = context.ui;
  app::PoseChoice& poses = state.choice.poses;
  draw_camera(session, ui, state, files);
  draw_canvas(ui, poses, state.lays_onto);
  if (const auto rate = typed_number_row(ui, {"export.rate", "Pictures/s", "0: the source's"}, poses.rate, 2))
    poses.rate = std::clamp(*rate, 0.0, 1000.0);
  draw_count(ui, poses);
  draw_drawing(ui, poses);
  toggle_row(
      ui,
      {"export.hide_limbs", "Hide limbs", "What another part of the body hides vanishes; detectors guess it"},
      poses.hides_limbs);
  toggle_row(ui, {"export.hide_face", "Hide face", "Nose, eyes and ears vanish where the head turns away"},
             poses.hides_face);
  draw_face_button(context);
  draw_beside(ui, poses);
  toggle_row(ui, {"export.depth", "Depth", "Of the same view, beside"}, poses.depth);
  toggle_row(ui, {"export.normals", "Normals", "Of the same view, beside"}, poses.normals);
  toggle_row(ui, {"export.mask", "Mask", "Of the same view, beside"}, poses.mask);
  hint(ui, "PNG pictures have the exact colours that generators know; a film smears them.");
}

bool draw_flat_rows(Ui& ui, ExportState& state) {
  const bool changed = choice_row(
      ui,
      {"export.as",
       "As",
       "What is written",
       "",
       {"One film of pose pictures, with its points beside", "A folder of PNGs in exact colours",
        "The points, as ControlNet has them", "A table, a line a frame", "NumPy arrays of all points"}},
      {"Film", "Pictures", "JSON", "CSV", "NPZ"}, state.flat_as);
  draw_count(ui, state.choice.poses);
  if (state.flat_as < 2) draw_drawing(ui, state.choice.poses), draw_beside(ui, state.choice.poses);
  return changed;
}

app::Arguments pose_words(const app::ExportChoice& choice, bool is_flat) {
  const app::PoseChoice& poses = choice.poses;
  const render::PosePictureOptions& drawing = poses.drawing;
  app::Arguments words;
  const auto add = [&](bool is_chosen, const std::string& key, const std::string& value) {
    if (is_chosen) words.push_back(key + "=" + value);
  };
  add(poses.count.is_4n_plus_1, "count", "4n+1");
  add(drawing.layout != render::PoseLayout::OpenPose18, "points",
      render::kPoseLayoutNames[static_cast<size_t>(drawing.layout)]);
  add(drawing.half_width > 0, "stick_width", argument(static_cast<double>(drawing.half_width)));
  add(poses.file != app::PoseFile::ControlNet, "pose_file",
      app::kPoseFileNames[static_cast<size_t>(poses.file)]);
  if (is_flat) return words;
  add(choice.pane_camera, "camera", "view");
  add(!poses.camera.reference.empty(), "camera", poses.camera.reference);
  if (poses.canvas)
    add(true, "canvas", std::to_string(poses.canvas->width) + "x" + std::to_string(poses.canvas->height));
  add(poses.rate > 0, "rate", argument(poses.rate));
  add(poses.hides_limbs, "hide_limbs", "on");
  add(!poses.hides_face, "whole_face", "on");
  add(poses.depth, "depth", "on"), add(poses.normals, "normals", "on"), add(poses.mask, "mask", "on");
  return words;
}

}  // namespace understudy::ui
