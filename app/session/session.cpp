#include "app/session/session.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/editing/skeleton_edits.hpp"

namespace understudy::app {
namespace {

constexpr float kLowConfidence = 0.5f, kWeakLimb = 0.3f, kLengthOff = 0.2f;
constexpr float kAroundJoints = 0.3f,
                kBelowJoints = 0.12f;  // metres that a body reaches further than its joints, at most
constexpr float kAroundPoints = 0.03f, kThinnest = 0.05f;  // metres, of a box
constexpr float kLengthOffM = 0.05f;                       // short bones are never seen to 20 %

constexpr double kStatusSeconds = 10;
/// Commands of which the success of one mends the failure of another.
const std::vector<std::vector<std::string>> kMendEachOther = {
    {"open", "document.open", "source.open", "source.motion"},
    {"open", "target.add", "target.replace", "target.remove"},
    {"document.save", "document.save_as"},
    {"picture.save", "video.save"},
    {"export.run", "export.all", "export.csv"}};

/// The joints as extracted and then edited, but not repaired.
Joints seen_joints(const Session& session, int frame) {
  Extraction seen;
  seen.joints = session.source.frames[frame].raw;
  return understudy::apply(session.document.skeleton_edits, seen, frame).joints;
}

/// Why a frame of the source is not to be trusted; empty when it is. `seen`: its seen_joints(). A bone that a
/// user has put right is right, and what they make of one that was is their choice.
std::string badness(const KeptSource& frame, const Joints& seen,
                    const Eigen::Array<float, kJointCount, 1>& usual) {
  if (frame.flagged || !frame.reason.empty()) return frame.reason;
  if (frame.confidence < kLowConfidence) return "Low confidence";
  for (int j = 1; j < kJointCount; ++j)
    if (frame.visibility[j] >= kSeen && frame.confidence_of[j] < kWeakLimb)
      return "Low confidence: " + joint_label(j);
  for (int j = 1; j < kJointCount; ++j) {
    if (std::min(frame.visibility[j], frame.visibility[kParents[j]]) < kSeen) continue;
    const auto length_in = [j](const Joints& joints) {
      return (joints.row(j) - joints.row(kParents[j])).norm();
    };
    const auto is_off = [&](float length) {
      return usual[j] > 0.05f && std::abs(length - usual[j]) > std::max(kLengthOff * usual[j], kLengthOffM);
    };
    if (const float length = length_in(seen); is_off(length) && is_off(length_in(frame.raw)))
      return bone_label(j) + printed(" changed length (%+.0f %%)", 100 * (length / usual[j] - 1));
  }
  return "";
}

/// Each bone's mean length over the good frames, metres.
Eigen::Array<float, kJointCount, 1> usual_lengths(const SharedFrames<KeptSource>& frames) {
  Eigen::Array<float, kJointCount, 1> sum = Eigen::Array<float, kJointCount, 1>::Zero();
  int good = 0;
  for (const KeptSource& frame : frames) {
    if (frame.flagged) continue;
    for (int j = 1; j < kJointCount; ++j)
      sum[j] += (frame.joints.row(j) - frame.joints.row(kParents[j])).norm();
    ++good;
  }
  return good > 0 ? Eigen::Array<float, kJointCount, 1>(sum / static_cast<float>(good)) : sum;
}

/// Around a body with the joints of a frame; none where it has no person.
std::optional<Box> around(const KeptSource& frame) {
  if (frame.flagged || !frame.joints.allFinite()) return std::nullopt;
  return Box{frame.joints.colwise().minCoeff().transpose() - Vec3(kAroundJoints, kBelowJoints, kAroundJoints),
             frame.joints.colwise().maxCoeff().transpose() + Vec3::Constant(kAroundJoints)};
}

/// Around all frames so far; none before the first.
std::optional<Box> everything(const Session& session) {
  const Vec3 margin = Vec3::Constant(kAroundPoints);
  if (const std::optional<Box>& points = session.source.extent)
    return Box{points->low - margin, points->high + margin};
  std::optional<Box> all;
  for (const KeptSource& frame : session.source.frames) all = united(all, around(frame));
  return all;
}

}  // namespace

SourceOptions source_as_read(const Session& session) {
  SourceOptions source = session.document.source;
  if (session.source.import) source.import = *session.source.import;
  if (source.complete > 0) source.made = session.source.made;
  return source;
}

bool has_several_people(const Session& session) {
  const auto& people = session.source.people;
  return std::count_if(people.begin(), people.end(), [](const PersonSeen& one) { return one.is_sure; }) > 1;
}

bool undoes_study(const Session& session) {
  const auto of_study = session.study.history.undo_time(), of_document = session.history.undo_time();
  return of_study && (!of_document || *of_study > *of_document);
}

bool redoes_study(const Session& session) {
  const auto of_study = session.study.history.redo_time(), of_document = session.history.redo_time();
  return of_study && (!of_document || *of_study < *of_document);
}

std::string undo_label(const Session& session) {
  return undoes_study(session) ? session.study.history.undo_label() : session.history.undo_label();
}

std::string redo_label(const Session& session) {
  return redoes_study(session) ? session.study.history.redo_label() : session.history.redo_label();
}

void choose_take(Session& session, int take) {
  session.selected_take = take;
  session.view.active_pane = take + 1;
}

void choose_pane(Session& session, int pane) {
  session.view.active_pane = pane;
  if (pane > 0) session.selected_take = pane - 1;
}

void settle_current_take(Session& session) {
  const int last = static_cast<int>(session.document.takes.size()) - 1;
  session.selected_take = std::max(0, std::min(session.selected_take, last));
  int& pane = session.view.active_pane;
  pane = last < 0 || pane <= 0 ? 0 : session.selected_take + 1;
}

const SharedFrames<KeptSource>& performed_by(const Session& session, size_t take) {
  const bool is_another = performs_another(session.document, session.document.takes[take]);
  return is_another ? session.takes[take].another : session.source.frames;
}

bool is_flat_take(const Session& session, int take) {
  const Take* const found = at_or_null(session.document.takes, take);
  return found != nullptr && found->flat && take < ssize(session.takes);
}

bool is_canvas(const Session& session, int pane) {
  return pane == 0 ? session.document.flat && !(session.view.lifted && performs_in_space(session.document))
                   : is_flat_take(session, pane - 1);
}

int frame_count(const Session& session) {
  const size_t selected = session.selected_take;
  if (is_flat_take(session, session.selected_take)) {
    const auto& flat = session.takes[selected].flat;
    return flat ? static_cast<int>(flat->poses.size()) : 0;
  }
  if (selected < session.takes.size()) return session.takes[selected].shown.poses.size();
  return session.source.frames.size();
}

std::optional<LogLine> status_line(const Session& session) {
  if (!session.log.empty()) {
    const LogLine& newest = session.log.back();
    if (newest.time > session.said_before && session.time < newest.time + kStatusSeconds) return newest;
  }
  if (session.failures.empty()) return std::nullopt;
  return LogLine{true, session.failures.back().text};
}

void mend(Session& session, const std::string& command) {
  const auto mended = [&](const Failure& failure) {
    if (failure.command == command) return true;
    const auto holds = [](const auto& names, const std::string& name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    return std::any_of(kMendEachOther.begin(), kMendEachOther.end(), [&](const auto& names) {
      return holds(names, command) && holds(names, failure.command);
    });
  };
  auto& failures = session.failures;
  failures.erase(std::remove_if(failures.begin(), failures.end(), mended), failures.end());
}

int shown_frame(const Session& session) {
  return shown_frame(session.playback, frame_count(session));
}

std::vector<MomentBetween> moments_of(const Session& session, size_t take) {
  const TakeState& state = session.takes[take];
  const std::vector<int> kept =
      kept_frames(session.document.takes[take].pose_edits, ssize(state.shown.poses));
  const bool all_known = state.times.size() == state.shown.poses.size();  // not while more are made
  return understudy::moments_of(kept, all_known ? state.times : std::vector<double>(),
                                static_cast<float>(session.source.fps));
}

double length_at(const std::vector<double>& times, double fps, double frame) {
  const auto t = static_cast<size_t>(std::max(frame, 0.0));
  return t + 1 < times.size() ? (times[t + 1] - times[t]) * fps : 1;
}

const std::vector<double>& clock_times(const Session& session) {
  static const std::vector<double> kNone;
  const TakeState* const take = at_or_null(session.takes, session.selected_take);
  const bool all_known = take != nullptr && take->times.size() == take->shown.poses.size();
  return all_known ? take->times : kNone;
}

double moment_of(const Session& session, double frame) {
  const std::vector<double>& times = clock_times(session);
  const double fps = session.source.fps;
  if (times.empty()) return frame / fps;
  const double whole = std::clamp(std::floor(frame), 0.0, static_cast<double>(times.size() - 1));
  return times[static_cast<size_t>(whole)] + (frame - whole) * length_at(times, fps, whole) / fps;
}

double frame_at(const Session& session, double seconds) {
  const std::vector<double>& times = clock_times(session);
  const double fps = session.source.fps;
  if (times.empty()) return seconds * fps;
  const auto after = std::upper_bound(times.begin() + 1, times.end(), seconds);
  const auto whole = static_cast<double>(after - times.begin() - 1);
  return whole + (seconds - *(after - 1)) * fps / length_at(times, fps, whole);
}

Box shown_crop(const Session& session) {
  Box box = everything(session).value_or(Box{{-1, -0.1f, -1}, {1, 2.2f, 1}});
  const std::optional<Box>& crop = session.document.scan_edits.crop;
  for (int side = 0; crop && side < 6; ++side)
    if (std::abs(crop->side(side)) < kOpenSide) box.side(side) = crop->side(side);
  for (int axis = 0; axis < 3; ++axis) {  // a side may be beyond all points
    const bool low_is_open = !crop || crop->low[axis] <= -kOpenSide;
    if (low_is_open) box.low[axis] = std::min(box.low[axis], box.high[axis] - kThinnest);
    box.high[axis] = std::max(box.high[axis], box.low[axis] + kThinnest);
  }
  return box;
}

/// What was found is not to be trusted there.
std::vector<BadFrame> doubted_frames(const Session& session) {
  std::vector<BadFrame> bad;
  const auto& rig = session.bones.rig;
  if (!rig) return bad;
  for (int t = 0; t < ssize(session.source.frames); ++t)
    if (const int at = frame_of_rig(*rig, t); at >= 0 && rig->doubted[static_cast<size_t>(at)])
      bad.push_back({t, "the found bones fit clearly worse than in other frames"});
  return bad;
}

std::vector<BadFrame> bad_frames(const Session& session) {
  if (session.source.no_person && session.document.bones.wanted) return doubted_frames(session);
  std::vector<BadFrame> bad;
  if (const auto& poses = session.document.flat ? session.flat.poses : nullptr) {
    // The filter says what is wrong; a network that lifts is never sure of depth.
    const size_t count = std::min(poses->clean.size(), session.source.frames.size());
    for (size_t i = 0; i < count; ++i)
      if (!poses->clean[i].problem.empty()) bad.push_back({static_cast<int>(i), poses->clean[i].problem});
    return bad;
  }
  const auto usual = usual_lengths(session.source.frames);
  for (size_t i = 0; i < session.source.frames.size(); ++i) {
    const std::string why =
        badness(session.source.frames[i], seen_joints(session, static_cast<int>(i)), usual);
    if (!why.empty()) bad.push_back({static_cast<int>(i), why});
  }
  return bad;
}

std::vector<FillEdit> unusable_runs(const Session& session, size_t take) {
  const auto& frames = performed_by(session, take);
  std::vector<FillEdit> runs;
  for (int t = 0; t < ssize(frames); ++t) {
    if (!frames[t].flagged) continue;
    if (runs.empty() || runs.back().last + 1 < t) runs.push_back({t, t});
    runs.back().last = t;
  }
  return runs;
}

}  // namespace understudy::app
