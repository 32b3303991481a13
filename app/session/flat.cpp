// 2D poses, as the document wants them: read, put right, performed by the people of pictures, in one job
// in the background, anew at every change. What is costly, reading, is done once a file.
#include <algorithm>
#include <cmath>
#include <map>

#include "app/run/flat_figures.hpp"
#include "app/run/flat_performance.hpp"
#include "app/session/background.hpp"
#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/metrics/keypoint_metrics.hpp"

namespace understudy::app {

/// What is wanted, what is known of it from before, and the answers. The job alone has it until it has ended.
struct FlatJob {
  struct Wanted {
    int64_t id = 0;
    std::string path;
    FlatTake how;
    std::shared_ptr<const FlatResult> result;
    std::string problem;
    bool not_opened = false;  // its file is to blame
    bool wants_canvas = false;
  };
  std::string key, raw_key, cleaned_key, poses_key;
  bool has_source = false;
  FlatSourceOptions source;
  FlatSource how;
  float smoothing = 1;
  std::vector<TrackEdit> source_edits;
  std::string person;  // as SourceOptions'
  std::vector<Wanted> takes;
  std::function<std::shared_ptr<const LengthReader>()> load_lengths;
  FlatEngineMaker make_engine;

  std::shared_ptr<const LengthReader> lengths;
  std::shared_ptr<const KeypointReading> raw;
  std::shared_ptr<const FlatPoses> cleaned, poses;                         // before edits, and after
  std::map<std::string, std::shared_ptr<const FlatReference>> references;  // by reference_key
  std::string problem;                                                     // of the source
  bool wants_canvas = false;                                               // what that is
  int64_t job = 0;                                                         // the UI thread's own
  bool cancelled = false;
};

namespace {

/// The number of who performs, where it is one.
int performer_of(const KeypointReading& reading, const std::string& person) {
  int64_t number = 0;
  if (!parse_integer(person, number)) return reading.performer;
  const int track = reading.track_of(number);
  US_CHECK(track >= 0, reading.path, ": nobody in it is number ", number);
  return track;
}

float mean_confidence(const FlatPose& pose) {
  const int seen = points_seen(pose);
  return seen > 0 ? pose.body.col(2).sum() / static_cast<float>(seen) : 0;
}

/// Without edits.
FlatPoses cleaned_poses(const FlatJob& work) {
  FlatPoses poses;
  poses.reading = *work.raw;
  KeypointReading& reading = poses.reading;
  reading.performer = performer_of(reading, work.person);
  KeypointFilterOptions filter;
  filter.smoothing = work.smoothing;
  poses.clean = clean_track(reading, reading.performer, filter);
  poses.lengths = proportions_of(reading, *work.lengths);
  return poses;
}

FlatPoses edited_poses(const FlatJob& work) {
  FlatPoses poses = *work.cleaned;
  edit_track(work.source_edits, poses.clean);
  for (const CleanPose& clean : poses.clean)
    poses.confidence.push_back(clean.is_usable ? mean_confidence(clean.pose) : 0);
  return poses;
}

void read_source(FlatJob& work) {
  if (!work.has_source) return;
  if (!work.raw) work.raw = std::make_shared<const KeypointReading>(open_keypoints(work.source));
  if (!work.cleaned) work.cleaned = std::make_shared<const FlatPoses>(cleaned_poses(work));
  if (!work.poses) work.poses = std::make_shared<const FlatPoses>(edited_poses(work));
}

std::string reference_key(const FlatJob::Wanted& take) {
  return key_of(take.path, take.how.person, take.how.canvas);
}

FlatReference reference_of(const FlatJob::Wanted& take, const LengthReader& lengths) {
  FlatReference reference;
  FlatSourceOptions options;
  options.path = take.path, options.person = take.how.person;
  if (!take.how.canvas.empty()) options.canvas = parse_canvas(take.how.canvas);
  if (is_proportions_file(take.path)) {
    reference.target = open_flat_target(options, lengths, reference.told);
    return reference;
  }
  std::string picture;
  const KeypointReading reading = open_keypoints(options, &picture);
  reference.told = reading.told;
  reference.target = flat_target(reading, lengths);
  reference.told.push_back("proportions are " + evidence_of(reference.target.lengths));
  if (picture.empty()) return reference;
  reference.picture = std::make_shared<const Pixels>(decode_picture(read_file(picture)));
  reference.told.push_back("stands in " + file_name(picture));
  return reference;
}

/// The chosen ones over those that were read.
Proportions chosen_lengths(const FlatTake& how, Proportions lengths) {
  for (int b = 0; b < kFlatBoneCount; ++b)
    if (const ChosenLength* chosen = chosen_length(how, kFlatBones[static_cast<size_t>(b)].name))
      lengths.length[b] = chosen->pixels, lengths.doubt[b] = 0;
  return lengths;
}

void add_figures(const FlatPoses& source, const LengthReader& lengths, FlatResult& result) {
  std::vector<FlatPose> clean;
  double sum = 0, count = 0;
  for (size_t t = 0; t < source.clean.size(); ++t) {
    clean.push_back(source.clean[t].pose);
    const double value = order_violation(result.poses[t], clean.back());
    result.violation.push_back(static_cast<float>(value));
    if (std::isfinite(value)) sum += value, ++count;
  }
  const auto add = [&](const char* key, double value) {
    if (std::isfinite(value)) result.figures.emplace_back(key, value);
  };
  const auto size = [](const Proportions& of) { return static_cast<double>(stature_of(of.length)); };
  add(kFlatFigures[0].key, sum / count);
  add(kFlatFigures[1].key, length_drift(result.poses, lengths));
  add(kFlatFigures[2].key, mean_second_difference(result.poses) / size(result.lengths) /
                               (mean_second_difference(clean) / size(source.lengths)));
}

void perform(FlatJob& work, FlatJob::Wanted& take) {
  auto& reference = work.references[reference_key(take)];
  take.not_opened = !reference;
  try {
    if (!reference) reference = std::make_shared<const FlatReference>(reference_of(take, *work.lengths));
  } catch (const CanvasUnknownError&) {
    take.wants_canvas = true;
    throw;
  }
  take.not_opened = false;
  FlatResult result;
  result.reference = reference;
  result.lengths = chosen_lengths(take.how, reference->target.lengths);
  if (work.poses) {
    FlatTarget target = reference->target;
    target.lengths = result.lengths;
    FlatOptions options;
    options.engine = take.how.engine, options.growth = take.how.growth;
    options.place = take.how.place, options.touches = take.how.touches;
    FlatTrack track =
        perform_track(work.poses->reading, work.poses->clean, only_if(work.how.ahead, work.poses->lengths),
                      target, options, {work.lengths, work.make_engine});
    result.made = std::move(track.result);
    result.poses.resize(work.poses->clean.size());
    for (const TrackedPose& tracked : result.made.performing().poses)
      result.poses[static_cast<size_t>(tracked.frame)] = tracked.pose;
    add_figures(*work.poses, *work.lengths, result);
  }
  take.result = std::make_shared<const FlatResult>(std::move(result));
}

void make_flat(FlatJob& work, JobControl& control) {
  work.problem = failure_of([&] {
    US_CHECK(work.load_lengths, "there is no network here that reads proportions off 2D poses");
    if (!work.lengths) work.lengths = work.load_lengths();
    control.progress(0.1f);
    try {
      read_source(work);
    } catch (const CanvasUnknownError&) {
      work.wants_canvas = true;
      throw;
    }
  });
  if (!work.problem.empty()) work.poses.reset();
  if (!work.lengths) return;
  for (FlatJob::Wanted& take : work.takes) {
    control.check();
    take.problem = failure_of([&] { perform(work, take); });
  }
}

SourceFrames source_frames(const FlatPoses& poses) {
  SourceFrames event;
  for (size_t t = 0; t < poses.clean.size(); ++t) {
    const CleanPose& clean = poses.clean[t];
    KeptSource kept;
    kept.flagged = !clean.is_usable;
    kept.reason = clean.problem;
    kept.confidence = poses.confidence[t];
    kept.confidence_of.setOnes();  // of joints in space nothing is known
    kept.points = clean.is_usable ? points_seen(clean.pose) : 0;
    event.frames.push_back(std::move(kept));
  }
  const std::string path = poses.reading.path + ": ";
  for (const std::string& sentence : poses.reading.told)
    append_item(event.decision, starts_with(sentence, path) ? sentence.substr(path.size()) : sentence, "; ");
  return event;
}

/// As the document has it, and what the mouse drags now.
SourceOptions source_with_drag(const Session& session) {
  SourceOptions source = session.document.source;
  if (const auto& dragging = session.flat.dragging) add_drag(*dragging, source.point_edits);
  return source;
}

bool wants_flat(const Document& document) {
  return document.flat || std::any_of(document.takes.begin(), document.takes.end(),
                                      [](const Take& take) { return take.flat.has_value(); });
}

}  // namespace

/// Makes what the document wants of 2D poses; where the last work is not done yet, after it.
void Studio::follow_flat() {
  Background& b = *background_;
  const Document& document = session_.document;
  if (!wants_flat(document)) {
    if (session_.flat.poses) ++session_.flat.generation;
    session_.flat.poses.reset(), session_.flat.dragging.reset();
    b.flat_key.clear(), b.flat_shown.clear();
    return;
  }
  std::string key = key_of(document.flat, source_with_drag(session_), performs_in_space(document));
  for (size_t k = 0; k < document.takes.size(); ++k)
    if (const Take& take = document.takes[k]; take.flat)
      key += key_of(b.take_ids[k], take.target.path, take.flat);
  const auto views = jobs_.views();
  const bool works = b.flat_work && std::any_of(views.begin(), views.end(), [&](const JobView& view) {
                       return view.id == b.flat_work->job;
                     });
  if (key == b.flat_key || works) return;
  start_flat(std::move(key));
}

void Studio::start_flat(std::string key) {
  Background& b = *background_;
  const Document& document = session_.document;
  const auto work = std::make_shared<FlatJob>();
  work->key = key;
  work->has_source = document.flat.has_value();
  if (document.flat) {
    work->how = *document.flat;
    work->source.path = document.source.path, work->source.fps = document.source.fps;
    work->source.layout = document.source.layout;
    if (!document.source.canvas.empty()) work->source.canvas = parse_canvas(document.source.canvas);
    work->person = document.source.person;
    work->raw_key =
        key_of(document.source.path, document.source.fps, document.source.canvas, document.source.layout);
    work->smoothing = document.source.smoothing, work->source_edits = source_with_drag(session_).point_edits;
    work->cleaned_key = work->raw_key + key_of(work->person, work->smoothing);
    work->poses_key = work->cleaned_key + key_of(work->source_edits);
  }
  for (size_t k = 0; k < document.takes.size(); ++k)
    if (const Take& take = document.takes[k]; take.flat)
      work->takes.push_back({b.take_ids[k], take.target.path, *take.flat, nullptr, "", false, false});
  work->load_lengths = services_.lengths;
  work->make_engine = services_.flat_engine;
  if (const auto& last = b.flat_work) {
    work->lengths = last->lengths;
    if (last->raw_key == work->raw_key) work->raw = last->raw;
    if (last->cleaned_key == work->cleaned_key) work->cleaned = last->cleaned;
    if (last->poses_key == work->poses_key) work->poses = last->poses;
    for (const FlatJob::Wanted& take : work->takes)
      if (const auto known = last->references.find(reference_key(take));
          known != last->references.end() && known->second)
        work->references.insert(*known);
  }
  work->job = jobs_.start(
      "Performing 2D poses",
      [work](JobControl& control) {
        try {
          make_flat(*work, control);
        } catch (const Cancelled&) {
          work->cancelled = true;
        }
      },
      [this, work] { take_in_flat(*work); });
  b.flat_work = work;
  b.flat_key = std::move(key);
}

void Studio::take_in_flat(FlatJob& work) {
  if (work.cancelled) return;
  if (work.has_source && session_.document.source.path == work.source.path) {
    if (!work.problem.empty()) {
      SourceFailed failed{work.problem, work.wants_canvas};
      return take_in(failed);
    }
    show_flat_source(work);
  }
  for (FlatJob::Wanted& wanted : work.takes) {
    TakeState* const take = take_of(wanted.id);
    if (take == nullptr) continue;
    if (!wanted.problem.empty()) {
      TakeFailed failed{wanted.id, wanted.problem, wanted.not_opened, false, wanted.wants_canvas};
      take_in(failed);
      continue;
    }
    take->problem.clear();
    take->flat = wanted.result;
    take->metrics = wanted.result->figures;
    const FlatFigure& violation = kFlatFigures[0];
    take->series = {{violation.key, violation.label, violation.unit, wanted.result->violation}};
    ++take->generation;
    if (background_->opened_targets.erase(wanted.id) > 0)
      remember(session_.settings.recent_targets, wanted.path);
  }
}

/// As the engine's source is taken in, so that timeline, marks and figures have one.
void Studio::show_flat_source(const FlatJob& work) {
  const bool in_space = performs_in_space(session_.document);  // the engine lifts it, and tells
  const bool is_whole = session_.source.problem.empty() && !session_.source.name.empty() &&
                        session_.source.frames.size() == work.poses->clean.size();
  if (session_.flat.poses == work.poses && (in_space || is_whole)) return;
  const bool is_new = std::exchange(background_->flat_shown, work.raw_key) != work.raw_key;
  session_.flat.poses = work.poses;
  ++session_.flat.generation;
  if (is_new) session_.playback.live = false;
  if (in_space) return;
  if (is_new || !is_whole) {
    SourceOpened opened;
    opened.name = file_name(work.source.path);
    opened.fps = work.raw->fps;
    opened.count = ssize(work.raw->frames);
    take_in(opened);
  }
  SourceFrames frames = source_frames(*work.poses);
  take_in(frames);
}

}  // namespace understudy::app
