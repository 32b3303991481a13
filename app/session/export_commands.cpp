#include <filesystem>

#include "app/run/report.hpp"
#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/glb_writer.hpp"
#include "retarget/formats/result_writer.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

/// What is exported: the shown motion without what trim and skip leave out, copied for the job's thread.
struct Export {
  std::string path;
  GlbCharacter character;
  std::shared_ptr<const Deformer> deformer;
  Motion motion;
  std::vector<Joints> source;  // of the frames that stay
};

std::shared_ptr<Export> prepared(Studio& studio, const Arguments& a) {
  const Take& take = take_argument(studio.session(), a, 0);
  const TakeState& state = studio.session().takes[static_cast<size_t>(whole_number(a, 0, "take"))];
  US_CHECK(state.ready && !state.shown.poses.empty(), "there is nothing to export yet");
  auto job = std::make_shared<Export>();
  job->path = fs::absolute(word(a, 1, "path")).lexically_normal().string();
  check_writable(job->path);
  job->character = {state.target->mesh, state.target->joints, *state.weights, take.name};
  job->deformer = state.deformer;
  job->motion.fps = state.shown.fps;
  for (const int frame : kept_frames(take.pose_edits, static_cast<int>(state.shown.poses.size()))) {
    const size_t t = static_cast<size_t>(frame);
    job->motion.poses.push_back(state.shown.poses[t]);
    const auto& frames = studio.session().source.frames;
    job->source.push_back(t < frames.size() ? frames[t].joints : Joints::Zero());
  }
  return job;
}

void write_glb(Export& job, JobControl& control) {
  GlbWriter writer(job.path, std::move(job.character));
  for (size_t t = 0; t < job.motion.poses.size(); ++t) {
    control.check();
    control.progress(static_cast<float>(t) / static_cast<float>(job.motion.poses.size()));
    writer.push(job.motion.poses[t], static_cast<float>(t) / job.motion.fps);
  }
  control.check();
  writer.finish();
}

void write_figures(Export& job, JobControl& control) {
  ResultWriter writer(job.path, job.character.mesh.vertices.rows());
  for (size_t t = 0; t < job.motion.poses.size(); ++t) {
    control.check();
    control.progress(static_cast<float>(t) / static_cast<float>(job.motion.poses.size()));
    const Pose& pose = job.motion.poses[t];
    writer.push(job.deformer->deform(pose), forward_kinematics(job.character.joints, pose).joints, pose.local,
                job.source[t]);
  }
  writer.finish();
}

void start(Studio& studio, const Arguments& a, void (*write)(Export&, JobControl&)) {
  const auto job = prepared(studio, a);
  const std::string name = fs::path(job->path).filename().string();
  studio.jobs().start(
      "Exporting " + name, [job, write](JobControl& control) { write(*job, control); },
      [&studio, name] { studio.notify("Exported " + name); });
}

}  // namespace

void add_export_commands(Commands& commands) {
  commands.add({"export.glb", "Export GLB", "TAKE PATH: the animated target", "", false, false,
                [](Studio& s, const Arguments& a) { start(s, a, write_glb); }});
  commands.add({"export.npz", "Export NPZ", "TAKE PATH: vertices, joints and rotations as arrays", "", false,
                false, [](Studio& s, const Arguments& a) { start(s, a, write_figures); }});
  commands.add({"export.csv", "Export figures as CSV", "TAKE PATH", "", false, false,
                [](Studio& s, const Arguments& a) {
                  take_argument(s.session(), a, 0);
                  const TakeState& state = s.session().takes[static_cast<size_t>(whole_number(a, 0, "take"))];
                  US_CHECK(!state.series.empty(), "there are no figures yet");
                  const std::string path = fs::absolute(word(a, 1, "path")).lexically_normal().string();
                  s.jobs().start(
                      "Exporting " + fs::path(path).filename().string(),
                      [path, series = state.series, fps = s.session().source.fps](JobControl&) {
                        write_csv(path, series, fps);
                      },
                      [&s, path] { s.notify("Exported " + fs::path(path).filename().string()); });
                }});
}

}  // namespace understudy::app
