#include "app/run/inbetween_suite.hpp"

#include <algorithm>
#include <filesystem>

#include "app/run/case_writer.hpp"
#include "app/run/gap_case_writer.hpp"
#include "app/run/gap_plan.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr int kEnds = 10, kEvery = 15, kWalkEnds = 5, kWalkEvery = 3;
constexpr int kSeen = 8;        // frames, of what is to go on
constexpr int kPredicted = 15;  // where no gap is given

bool predicts(const SuiteOptions& options) {
  return options.suite == "predict";
}

/// Where there are scans the missing frames are those of windows that follow one another.
GapPlan plan_of(const SuiteOptions& options, const Clip& clip) {
  GapPlan plan;
  const int all = static_cast<int>(ssize(clip.motion.poses));
  plan.frames = options.points > 0 ? std::min(all, options.frames) : all;
  plan.gap = predicts(options) && options.gap == 0 ? kPredicted : options.gap;
  plan.before = predicts(options) ? kSeen : options.walks ? kWalkEnds : kEnds;
  plan.after = predicts(options) ? 0 : plan.before;
  plan.every = options.points > 0 ? plan.before + plan.gap : options.walks ? kWalkEvery : kEvery;
  for (int t = 0; t < plan.frames; ++t)
    if (!std::binary_search(clip.good.begin(), clip.good.end(), t)) plan.bad_frames.push_back(t);
  return plan;
}

struct InbetweenCase {
  std::string name, path;
  std::vector<std::string> tags;
  GapPlan plan;
};

std::vector<InbetweenCase> cases_of(const SuiteOptions& options, const DataSplit& split) {
  std::vector<InbetweenCase> cases;
  each_clip(options, split, [&](const LabelledClip& clip) {
    InbetweenCase made{clip.name(), clip.path, gap_tags(options.suite, clip.clip.motion, clip.labels),
                       plan_of(options, clip.clip)};
    if (!window_starts(made.plan).empty()) cases.push_back(std::move(made));
  });
  US_CHECK(!cases.empty(), options.data, ": no ", options.walks ? "walk or run" : "clip", " of the split \"",
           options.split, "\" has a gap of ", plan_of(options, {}).gap, " frames with known ones beside it");
  return cases;
}

Json case_json(const InbetweenCase& made, bool with_scans) {
  Json json = {{"fps", 30}};
  if (with_scans) json["source"] = "source", json["target"] = "target.obj";
  json["truth"] = "truth.npz";
  json["frames"] = made.plan.frames;
  json["gap"] = made.plan.gap;
  json[made.plan.after > 0 ? "ends" : "seen"] = made.plan.before;
  json["every"] = made.plan.every;
  if (!made.plan.bad_frames.empty()) json["bad_frames"] = made.plan.bad_frames;
  json["tags"] = made.tags;
  return json;
}

void write_scans(const SuiteOptions& options, const InbetweenCase& made, const ExactPerson& person,
                 const Performance& shown, const fs::path& folder) {
  make_scan_folder(folder / "source");
  NumpyRandom random(static_cast<uint32_t>(case_seed(made.name, options.seed)));
  const std::vector<bool> known = known_frames(made.plan);
  for (size_t t = 0; t < known.size(); ++t) {
    if (!known[t]) continue;
    const auto count = static_cast<int64_t>(options.points * random.uniform(0.8, 1.2));
    write_scan(folder / "source", t,
               points_on_surface(random, shown.vertices[t], person.faces, count).cast<float>());
  }
}

void make_case(const SuiteOptions& options, const ExactPerson& person, const InbetweenCase& made) {
  const fs::path folder = fs::path(options.out) / made.name;
  const bool with_scans = options.points > 0;
  fs::remove_all(folder);
  fs::create_directories(folder);
  const ExactMotion motion = read_exact_motion(made.path, 0, made.plan.frames);
  const Performance shown = grounded(person, motion, with_scans);
  if (with_scans) {
    write_target((folder / "target.obj").string(), person);
    write_scans(options, made, person, shown, folder);
  }
  write_npz((folder / "truth.npz").string(), gap_truth(person, motion, shown));
  write_json((folder / "case.json").string(), case_json(made, with_scans));
}

}  // namespace

int make_inbetween_suite(const SuiteOptions& options, const DataSplit& split,
                         const std::function<void(const std::string& name)>& done) {
  US_CHECK(options.gap > 0 || predicts(options),
           "the suite inbetween needs --gap, the frames that are not known");
  std::vector<InbetweenCase> cases = cases_of(options, split);
  if (options.cases > 0 && ssize(cases) > options.cases) cases.resize(static_cast<size_t>(options.cases));
  const Body body = read_smpl_body(options.body.empty() ? split.body : options.body);
  const ExactPerson person = ExactBody(body).shaped({});
  for (const InbetweenCase& made : cases) {
    check_interrupt("before case " + made.name);
    make_case(options, person, made);
    done(made.name);
  }
  return static_cast<int>(ssize(cases));
}

}  // namespace understudy::app
