#include "tests/app/stimuli/gl/small_study.hpp"

#include "retarget/base/file.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy::app {
namespace {

/// The target's vertices alone, in another dance than the source's.
void write_truth(const std::string& path, int frames) {
  const fixtures::PointBody body(human_rest());
  NpyArray vertices;
  vertices.shape = {frames, body.mesh.vertices.rows(), 3};
  for (int t = 0; t < frames; ++t) {
    const Pose pose = fixtures::dance(2 + 0.1f * static_cast<float>(t));
    const Points points = linear_blend_skinning(body.mesh.vertices, body.weights, human_rest(),
                                                forward_kinematics(human_rest(), pose));
    vertices.values.insert(vertices.values.end(), points.data(), points.data() + points.size());
  }
  write_npz(path, {{"vertices", vertices}});
}

}  // namespace

void SmallStudy::SetUp() {
  StudioTest::SetUp();
  write_truth(path("truth.npz"), kFrames);
  study_.name = "small";
  study_.conditions.resize(3);
  study_.conditions[0].name = "copy";
  study_.conditions[1].name = "long steps";
  study_.conditions[1].method.stride = 2;
  study_.conditions[2].name = "truth";
  study_.conditions[2].kind = ConditionKind::GroundTruth;
  study_.conditions[2].files = {{"", "", path("truth.npz")}};
  study_.motions.resize(2);
  for (StudyMotion& motion : study_.motions) motion.source.path = path("scan.npz");
  study_.motions[0].name = "start", study_.motions[0].seconds = 0.3f;
  study_.motions[1].name = "rest", study_.motions[1].from_s = 0.3f;
  study_.targets.resize(1);
  study_.targets[0].name = "doll", study_.targets[0].target.path = path("target.obj");
  study_.questions.resize(1);
  study_.questions[0].name = "q", study_.questions[0].text = "?";
  study_.questions[0].low = "no", study_.questions[0].high = "yes";
  study_.layout.labels = true;
  study_.plan.repetitions = 2, study_.plan.practice = 2;
  study_.picture.width = 160, study_.picture.height = 90, study_.picture.fps = 10;
  study_.clip.seconds = 1.3f, study_.clip.card_s = 0.2f;
}

StimuliReport SmallStudy::make(const std::string& folder, bool separate) {
  StimuliOptions options;
  options.study_folder = folder_.string();
  options.out = path(folder), options.separate = separate;
  return make_stimuli(study_, {services().networks, progress_}, options);
}

void SmallStudy::write_dance(const std::string& file, const Vec3& stray) const {
  const fixtures::PointBody body(human_rest());
  NpyArray points;
  for (int t = 0; t < kFrames; ++t) {
    const Mesh scan = fixtures::scan_of(body, human_rest(), fixtures::dance(0.1f * static_cast<float>(t)));
    Points with(scan.vertices.rows() + 1, 3);
    with << (scan.vertices.row(0) + stray.transpose()), scan.vertices;
    points.shape = {kFrames, with.rows(), 3};
    points.values.insert(points.values.end(), with.data(), with.data() + with.size());
  }
  write_npz(file, {{"points", points}});
}

std::map<std::string, std::string> SmallStudy::files_in(const std::string& folder) const {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(path(folder)))
    if (entry.is_regular_file() && entry.path().filename() != "made.json")
      files[fs::relative(entry.path(), path(folder)).string()] = read_file(entry.path().string());
  return files;
}

}  // namespace understudy::app
