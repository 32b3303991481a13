#include "app/run/style_teacher.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>

#include "app/run/styled_clip.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/metrics/style_metrics.hpp"
#include "retarget/style/fit_manner.hpp"

namespace understudy::app {
namespace {
namespace fs = std::filesystem;

constexpr Within<double> kStrokes{0.5, 2};

/// What recordings of one manner tell.
struct Taught {
  MannerSample sample;
  std::vector<double> rises_s;  // of the recordings in which a hand acts
};

void learn(const std::string& recording, const Networks& networks, const ClipStep& step, Taught& taught) {
  SourceOptions source;
  source.path = recording;
  source.quiet = true;
  const StyledClip clip = styled_clip(source, networks, {}, {}, step);
  taught.sample.add(style_frames(clip));
  JointSequence joints;
  for (const Pose& pose : clip.poses) joints.push_back(forward_kinematics(clip.rest, pose).joints);
  const double rise = rise_s(joints, clip.fps);
  if (std::isfinite(rise)) taught.rises_s.push_back(rise);
}

/// One that cannot be read is left out; what `look` throws is passed on.
void learn_if_readable(const std::string& recording, const Networks& networks,
                       const std::function<void()>& look, Taught& taught) {
  std::exception_ptr stopped;
  const ClipStep step = [&](auto...) {
    try {
      look();
    } catch (...) {
      stopped = std::current_exception();
      throw;
    }
  };
  const std::string problem = failure_of([&] { learn(recording, networks, step, taught); });
  if (stopped) std::rethrow_exception(stopped);
  if (!problem.empty()) log::warn(problem);
}

/// Whether a folder is in another one, however deep.
bool lies_in(const std::string& folder, const std::string& other) {
  std::error_code failed;
  const std::string inner = fs::canonical(folder, failed).string(),
                    outer = fs::canonical(other, failed).string();
  return !failed && starts_with(inner, outer + '/');
}

void complete(StyleNote& note, const std::string& from, const std::string& to) {
  if (note.sentence.empty())
    note.sentence = "Moves like the recordings of " + to + ", where the source moves like those of " + from;
  if (note.made_from.empty()) note.made_from = "recordings of " + to + " and " + from;
}

}  // namespace

std::vector<std::string> recordings(const std::string& folder, const std::function<void()>& look) {
  std::error_code failed;
  US_CHECK(fs::is_directory(folder, failed), folder, ": there is no such folder of recordings");
  std::vector<std::string> all;
  const auto search = [&](const fs::path& in, const auto& again) -> void {
    bool scans = false;
    for (const auto& entry : fs::directory_iterator(in, failed)) {
      if (look) look();
      const std::string path = entry.path().string();
      if (entry.is_directory(failed)) {
        again(entry.path(), again);
      } else if (can_be(path, kMotion)) {
        all.push_back(path);
      } else {
        scans |= can_be(path, kScanFrame);
      }
    }
    if (scans) all.push_back(in.string());
  };
  search(folder, search);
  US_CHECK(!all.empty(), folder, ": holds no skeletal motion (", format_names(kMotion),
           ") and no folder of scans");
  std::sort(all.begin(), all.end());
  return all;
}

void check_folders(const StyleLesson& lesson) {
  std::error_code failed;
  for (const std::string& folder : {lesson.from, lesson.to})
    US_CHECK(fs::is_directory(folder, failed), folder, ": there is no such folder of recordings");
  US_CHECK(!fs::equivalent(lesson.from, lesson.to, failed), lesson.to, ": is the other manner again");
  US_CHECK(!lies_in(lesson.from, lesson.to), lesson.to, ": holds the recordings of the other manner, too");
  US_CHECK(!lies_in(lesson.to, lesson.from), lesson.from, ": holds the recordings of the other manner, too");
}

MannerFile teach_style(const StyleLesson& lesson, const Networks& networks, const LessonStep& step) {
  check_folders(lesson);
  std::array<std::vector<std::string>, 2> all = {recordings(lesson.from), recordings(lesson.to)};
  const size_t count = all[0].size() + all[1].size();
  const Taught none{MannerSample(fitted_joints(lesson.joints), lesson.smooth), {}};
  std::array<Taught, 2> taught = {none, none};
  size_t done = 0;
  for (const size_t side : {0, 1})
    for (const std::string& recording : all[side]) {
      const auto look = [&] {
        if (step) step(done, count, recording);
      };
      learn_if_readable(recording, networks, look, taught[side]);
      ++done;
      look();
    }
  for (const size_t side : {0, 1})
    US_CHECK(taught[side].sample.clips() > 1, side == 0 ? lesson.from : lesson.to, ": holds ",
             taught[side].sample.clips() == 1 ? "one recording" : "no recording",
             " that can be used; a manner of moving needs several");
  const std::string from = file_name(lesson.from), to = file_name(lesson.to);
  MannerFile file;
  file.note = lesson.note;
  complete(file.note, from, to);
  file.manner = fit_manner(taught[0].sample, taught[1].sample, lesson.coupled);
  const FigureOrigin origin{detail::join("fitted to ", taught[1].sample.clips(), " recordings of ", to,
                                         " and ", taught[0].sample.clips(), " of ", from),
                            ""};
  file.origins["coupling"] = origin;
  if (!taught[0].rises_s.empty() && !taught[1].rises_s.empty()) {
    file.stroke = static_cast<float>(
        std::clamp(median_of(taught[1].rises_s) / median_of(taught[0].rises_s), kStrokes.low, kStrokes.high));
    file.origins["stroke"] = origin;
  }
  return file;
}

}  // namespace understudy::app
