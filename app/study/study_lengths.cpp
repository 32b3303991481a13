// How long motions and imported animations are.
#include <algorithm>
#include <cmath>

#include "app/study/study.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/motion/clip.hpp"
#include "retarget/motion/read_motion.hpp"

namespace understudy::app {
namespace {

struct Length {
  double seconds = 0, fps = 30;
};

/// None where it has no known end.
std::optional<Length> length_of(SourceOptions options) {
  options.quiet = true;
  const auto source = open_source(options);
  const auto frames = source->count();
  if (!frames) return std::nullopt;
  return Length{static_cast<double>(*frames) / source->fps(), source->fps()};
}

/// The part of the source that is shown. Throws Error when there is none.
std::optional<Length> length_of(const StudyMotion& motion) {
  auto length = length_of(motion.source);
  if (!length) return length;
  const double from = motion.from_s;
  US_CHECK(from < length->seconds, "motion '", motion.name, "' starts at ", printed("%.2f", from),
           " s, its source lasts ", printed("%.2f", length->seconds), " s");
  length->seconds -= from;
  if (motion.seconds) length->seconds = std::min(length->seconds, static_cast<double>(*motion.seconds));
  return length;
}

/// Of a skeletal animation, or of scans: these have frames and no rate, the motion's is theirs.
Length length_of(const StimulusFile& file, double fps) {
  if (const auto character = read_motion(file.path)) {
    const ClipTimes times = clip_times(*character, chosen_clip(*character, ""));
    return {static_cast<double>(times.count) / times.fps, times.fps};
  }
  return {static_cast<double>(ScanSource(file.path).count().value_or(0)) / fps, fps};
}

void check_length(const Condition& condition, const StudyMotion& motion, const StudyTarget& target,
                  const Length& wanted) {
  const StimulusFile* file = file_for(condition, motion, target);
  if (file == nullptr) return;
  const Length length = length_of(*file, wanted.fps);
  const double tolerance = 2 / std::min(wanted.fps, length.fps) + 1e-6;
  US_CHECK(std::abs(length.seconds - wanted.seconds) <= tolerance, "condition '", condition.name,
           "', motion '", motion.name, "', target '", target.name, "': ", file_name(file->path), " lasts ",
           printed("%.2f", length.seconds), " s, the motion ", printed("%.2f", wanted.seconds),
           " s; the clips of a trial must be equally long");
}

}  // namespace

void check_lengths(const Study& study) {
  for (const StudyMotion& motion : study.motions) {
    const auto wanted = length_of(motion);
    if (!wanted) continue;
    for (const Condition& condition : study.conditions)
      for (const StudyTarget& target : study.targets)
        if (condition.kind != ConditionKind::Method) check_length(condition, motion, target, *wanted);
  }
}

}  // namespace understudy::app
