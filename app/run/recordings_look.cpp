#include "app/run/recordings_look.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/run/source.hpp"
#include "app/run/style_teacher.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy::app {
namespace {

constexpr size_t kMostEntries = 100000;  // of a whole disk somebody has chosen the root

std::string kind_of_recording(const std::string& path) {
  const FileFormat* const format = format_of_suffix(path, kMotion);
  std::error_code failed;
  return std::filesystem::is_directory(path, failed) || format == nullptr ? "scans" : format->name;
}

double seconds_of_recording(const std::string& path) {
  SourceOptions options;
  options.path = path;
  options.quiet = true;
  const auto source = open_source(options);
  return static_cast<double>(source->count().value_or(0)) / source->fps();
}

}  // namespace

std::string RecordingsHeld::sentence() const {
  if (!listed || count == 0) return "";
  std::string of_kinds;
  for (const auto& [kind, many] : kinds) append_item(of_kinds, std::to_string(many) + " " + kind);
  std::string text = grouped(static_cast<int64_t>(count)) + (count == 1 ? " recording: " : " recordings: ") +
                     of_kinds + printed("; %.1f s", seconds);
  if (timed < count) text += " so far";
  if (unreadable > 0) text += "; " + std::to_string(unreadable) + " of them cannot be read";
  return text;
}

void RecordingsLook::look(const std::string& folder) {
  const auto held = worker_.lock();
  folder_ = folder;
  left_.clear();
  held_ = {};
  to_list_ = !folder.empty();
  worker_.wake();
}

RecordingsHeld RecordingsLook::held() const {
  const auto held = worker_.lock();
  return held_;
}

Worker::Task RecordingsLook::next() {
  if (std::exchange(to_list_, false)) return [this, folder = folder_] { list(folder); };
  if (left_.empty()) return nullptr;
  const std::string recording = left_.back();
  left_.pop_back();
  return [this, folder = folder_, recording] { time(folder, recording); };
}

/// What is no longer wanted breaks off.
void RecordingsLook::list(const std::string& folder) {
  size_t entries = 0;
  std::vector<std::string> all;
  RecordingsHeld found;
  found.problem = failure_of([&] {
    all = recordings(folder, [&] {
      US_CHECK(++entries < kMostEntries, folder, ": holds too many files to look through");
      const auto held = worker_.lock();
      US_CHECK(folder_ == folder, folder, ": is no longer wanted");
    });
  });
  found.listed = true;
  found.count = all.size();
  for (const std::string& path : all) ++found.kinds[kind_of_recording(path)];
  std::reverse(all.begin(), all.end());  // taken from its end
  const auto held = worker_.lock();
  if (folder_ != folder || to_list_) return;
  held_ = std::move(found);
  left_ = std::move(all);
}

void RecordingsLook::time(const std::string& folder, const std::string& recording) {
  double seconds = 0;
  const std::string problem = failure_of([&] { seconds = seconds_of_recording(recording); });
  const auto held = worker_.lock();
  if (folder_ != folder || to_list_) return;
  ++held_.timed;
  held_.seconds += seconds;
  if (!problem.empty()) ++held_.unreadable;
}

}  // namespace understudy::app
