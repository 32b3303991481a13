#include "retarget/formats/folder_follower.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/scan_frames.hpp"

namespace understudy {
namespace fs = std::filesystem;
namespace {

constexpr double kPatienceForGap = 0.5;  // seconds that a file may come after its successor

}  // namespace

FolderFollower::FolderFollower(std::string folder, FolderFollowOptions options, Choice choice)
    : folder_(std::move(folder)),
      options_(std::move(options)),
      choice_(std::move(choice)),
      last_news_(std::chrono::steady_clock::now()) {
  folder_files(folder_);  // throws when it cannot be read
}

std::optional<FollowedFile> FolderFollower::next(const Read& read) {
  while (!ended_) {
    if (options_.cancelled && options_.cancelled()) break;
    if (auto file = look(read)) return file;
    if (!ended_) std::this_thread::sleep_for(std::chrono::duration<double>(options_.poll_s));
  }
  ended_ = true;
  return {};
}

std::optional<FollowedFile> FolderFollower::look(const Read& read) {
  if (waiting_.size() > 1 && file_of(waiting_.front()).missing == 0)
    return take(true, read);  // the writer is ahead: no need to list the folder for each file
  const auto names = folder_files(folder_);
  std::error_code failed;
  const bool done =
      fs::exists(fs::path(folder_) / "done", failed) || fs::exists(fs::path(folder_) / ".done", failed);
  list_waiting(names);
  const bool late = idle_s() >= options_.timeout_s;
  if (waiting_.empty()) {
    US_CHECK(!late || place_.count > 0, folder_, ": no frame came within ", options_.timeout_s, " s");
    US_CHECK(!done || place_.count > 0, folder_, ": holds no frames");
    ended_ = done || late;
    return {};
  }
  const FollowedFile first = file_of(waiting_.front());
  const bool written = done || waiting_.size() > 1;  // its writer has gone on to the next
  if (!written && !late && !stands_still(first.path)) return {};
  if (first.missing > 0 && !done && !late && idle_s() < kPatienceForGap) return {};
  return take(written || late, read);
}

void FolderFollower::list_waiting(const std::vector<std::string>& names) {
  std::vector<std::string> open;
  for (const std::string& name : names)
    if (name[0] != '.' && (place_.count == 0 || natural_less(last_name_, name))) open.push_back(name);
  open = choice_(std::move(open));
  std::sort(open.begin(), open.end(), natural_less);
  waiting_.assign(open.begin(), open.end());
}

FolderFollower::FileState FolderFollower::state_of(const std::string& path) {
  std::error_code no_size, no_time;
  const FileState state{fs::file_size(path, no_size), fs::last_write_time(path, no_time)};
  return no_size || no_time ? FileState() : state;
}

bool FolderFollower::stands_still(const std::string& path) {
  const FileState now = state_of(path);
  const bool still = path == watched_ && now == state_ && now.first > 0;
  watched_ = path;
  state_ = now;
  return still;
}

FollowedFile FolderFollower::file_of(const std::string& name) const {
  FollowedFile file;
  file.name = name;
  file.path = (fs::path(folder_) / name).string();
  const auto number = frame_number(name);
  file.number = number.value_or(place_.count);
  if (!number || !place_.number || !place_.step) return file;
  file.last_number = *place_.number;
  file.step = *place_.step;
  file.missing = std::max<int64_t>(missing_between(*number - *place_.number, file.step), 0);
  return file;
}

std::optional<FollowedFile> FolderFollower::take(bool written, const Read& read) {
  FollowedFile file = file_of(waiting_.front());
  const bool is_whole = read(file);  // what cannot be read may still be growing, unless its writer went on
  if (!written && (!is_whole || state_of(file.path) != state_)) return {};
  waiting_.pop_front();
  last_name_ = file.name;
  last_news_ = std::chrono::steady_clock::now();
  place_before_ = place_;
  const auto number = frame_number(file.name);
  if (number && place_.number && !place_.step && *number > *place_.number)
    place_.step = *number - *place_.number;
  place_.number = number;
  ++place_.count;
  return file;
}

double FolderFollower::idle_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_news_).count();
}

}  // namespace understudy
