#include "app/run/flat_suite.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "app/run/case_writer.hpp"
#include "app/run/flat_cast.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"
#include "retarget/pose2d/flat_people.hpp"

namespace understudy::app {
namespace {
namespace fs = std::filesystem;

constexpr int kPairs = 60, kTrackPoses = 10;
constexpr float kRate = 30, kTrackSeconds = 2;
constexpr int kCutOneIn = 6;

struct FlatSuite {
  const char* name;
  bool odd;
  float jitter_m, missing, exchanged;
  bool cut;
};
constexpr std::array<FlatSuite, 4> kSuites = {{{"pose2d", false, 0, 0, 0, false},
                                               {"pose2d-odd", true, 0, 0, 0, false},
                                               {"pose2d-noisy", true, 0.015f, 0, 0, false},
                                               {"pose2d-seen", true, 0.015f, 0.08f, 0.02f, true}}};

const FlatSuite* suite_named(const std::string& name) {
  const auto found = std::find_if(kSuites.begin(), kSuites.end(),
                                  [&](const FlatSuite& suite) { return suite.name == name; });
  return found == kSuites.end() ? nullptr : &*found;
}

/// The same person seen over some frames by one camera.
struct Shot {
  KeypointReading seen;
  BoneLengths length;  // pixels, of the first frame
};

Shot shot_of(const FlatPerson& person, const std::vector<Pose>& poses, const Pinhole& camera, double fps,
             const DetectorErrors& errors, Rng* rng) {
  Shot shot;
  shot.seen.fps = fps;
  shot.seen.canvas = {static_cast<int>(2 * camera.centre.x()), static_cast<int>(2 * camera.centre.y())};
  shot.seen.tracks.resize(1);
  shot.seen.tracks[0].person = 1;
  for (size_t t = 0; t < poses.size(); ++t) {
    const FlatSight sight = seen_flat(person, poses[t], camera);
    if (t == 0) shot.length = sight.length;
    KeypointFrame frame;
    frame.number = static_cast<int64_t>(t);
    shot.seen.frames.push_back(frame);
    TrackedPose tracked;
    tracked.frame = static_cast<int64_t>(t);
    tracked.pose = rng ? detected(sight, errors, *rng) : sight.pose;
    shot.seen.tracks[0].poses.push_back(std::move(tracked));
  }
  return shot;
}

Json lengths_json(const BoneLengths& lengths) {
  Json json = Json::array();
  for (const float length : lengths) json.push_back(length);
  return json;
}

/// One source, one target, and what is known of the target.
class FlatCaseMaker {
 public:
  FlatCaseMaker(const SuiteOptions& options, const FlatSuite& suite)
      : options_(options), suite_(suite), cast_(options, kTrackSeconds) {}

  int make(const std::function<void(const std::string&)>& done) {
    const int pairs = options_.cases > 0 ? options_.cases : kPairs;
    int count = 0;
    for (int pair = 0; pair < pairs; ++pair) {
      check_interrupt("before pair " + std::to_string(pair));
      prepare(pair);
      for (const bool track : {false, true}) {
        if (!track && suite_.cut) continue;
        const std::string name = printed("%03d_%s", pair, track ? "track" : "picture");
        write(name, track);
        done(name);
        ++count;
      }
    }
    return count;
  }

 private:
  void prepare(int pair) {
    rng_ = Rng(case_seed(std::to_string(pair), options_.seed));
    const int people = cast_.people(), runs = cast_.runs(), a = rng_.below(people), run = rng_.below(runs);
    FlatPerson source = cast_.person(a), target = cast_.person((a + 1 + rng_.below(people - 1)) % people);
    const int other = (run + 1 + rng_.below(runs - 1)) % runs;
    if (suite_.odd) {
      target = scaled_apart(target, random_scales(rng_));
      if (pair % 2 == 0) source = scaled_apart(source, random_scales(rng_));
    }
    DetectorErrors errors;
    errors.jitter_m = suite_.jitter_m;
    errors.missing = suite_.missing;
    errors.exchanged = suite_.exchanged;
    Rng* const detector = suite_.jitter_m > 0 ? &rng_ : nullptr;
    const std::vector<Pose> poses = cast_.poses(run, options_.frames, kRate),
                            known = cast_.poses(other, kTrackPoses, kTrackPoses / kTrackSeconds);
    const Pinhole camera = random_view(middle_of(poses), {}, rng_);
    truth_ = shot_of(target, poses, camera, static_cast<double>(kRate), {}, nullptr);
    target_ = shot_of(target, known, random_view(middle_of(known), {}, rng_), kTrackPoses / kTrackSeconds,
                      errors, detector);
    if (suite_.cut && pair % kCutOneIn == 0) errors.cut = Cut::Hips;
    source_ = shot_of(source, poses, camera, static_cast<double>(kRate), errors, detector);
  }

  void write(const std::string& name, bool track) const {
    const fs::path folder = fs::path(options_.out) / name;
    fs::create_directories(folder);
    KeypointReading known = target_.seen;
    if (!track) {
      known.frames.resize(1);
      known.tracks[0].poses.resize(1);
    }
    write_keypoint_npz((folder / "source.npz").string(), source_.seen);
    write_keypoint_npz((folder / "target.npz").string(), known);
    write_keypoint_npz((folder / "truth.npz").string(), truth_.seen);
    write_json((folder / "case.json").string(), {{"fps", kRate},
                                                 {"source", "source.npz"},
                                                 {"target", "target.npz"},
                                                 {"truth", "truth.npz"},
                                                 {"flat",
                                                  {{"source_lengths", lengths_json(source_.length)},
                                                   {"target_lengths", lengths_json(truth_.length)}}},
                                                 {"tags", {suite_.name, track ? "track" : "picture"}}});
  }

  const SuiteOptions& options_;
  const FlatSuite& suite_;
  FlatCast cast_;
  Rng rng_{0};
  Shot source_, target_, truth_;
};

}  // namespace

bool is_flat_suite(const std::string& suite) {
  return suite_named(suite) != nullptr;
}

int make_flat_suite(const SuiteOptions& options, const std::function<void(const std::string&)>& done) {
  const FlatSuite* const suite = suite_named(options.suite);
  US_CHECK(suite, "there is no suite ", options.suite, " of 2D poses");
  return FlatCaseMaker(options, *suite).make(done);
}

}  // namespace understudy::app
