// The files of a folder that is still being written, one after the other as they become whole.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace understudy {

struct FolderFollowOptions {
  double timeout_s = 10;            ///< the folder ends when no new file came for so long
  double poll_s = 0.03;             ///< between two looks
  std::function<bool()> cancelled;  ///< asked at every look; true ends the folder
};

struct FollowedFile {
  std::string name, path;
  int64_t number = 0;       ///< the last one in its name; without any how many came before
  int64_t last_number = 0;  ///< of the file before, where frames are missing between
  int64_t step = 1;         ///< between two numbers, as between the first two
  int64_t missing = 0;      ///< how many numbers are left out before it
};

/// A file is whole where a later one is there, or nobody wrote to it between two looks and it can be read.
/// One that comes up to half a second after its successor still finds its place. A file `done` or `.done`
/// ends the folder. One thread at a time.
class FolderFollower {
 public:
  /// Which of the names, hidden ones and earlier ones left out, are frames; in any order.
  using Choice = std::function<std::vector<std::string>(std::vector<std::string> names)>;
  /// Reads the file and says whether it could be. It may be asked again for the same one.
  using Read = std::function<bool(const FollowedFile& file)>;

  /// Throws Error when the folder cannot be read.
  FolderFollower(std::string folder, FolderFollowOptions options, Choice choice);
  /// Waits for the next file, the one that was read last. None at the end. Throws Error where none came at
  /// all.
  std::optional<FollowedFile> next(const Read& read);
  /// The last file does not count: numbers go on from the one before.
  void forget_last() { place_ = place_before_; }

 private:
  // Size and time of change: two equal looks mean that nobody wrote in between. Size 0: no such file.
  using FileState = std::pair<uintmax_t, std::filesystem::file_time_type>;
  struct Place {
    int64_t count = 0;
    std::optional<int64_t> number, step;
  };

  static FileState state_of(const std::string& path);
  std::optional<FollowedFile> look(const Read& read);
  void list_waiting(const std::vector<std::string>& names);
  bool stands_still(const std::string& path);
  FollowedFile file_of(const std::string& name) const;
  std::optional<FollowedFile> take(bool written, const Read& read);
  double idle_s() const;

  std::string folder_;
  FolderFollowOptions options_;
  Choice choice_;
  std::deque<std::string> waiting_;
  std::string last_name_, watched_;
  FileState state_;
  Place place_, place_before_;
  std::chrono::steady_clock::time_point last_news_;
  bool ended_ = false;
};

}  // namespace understudy
