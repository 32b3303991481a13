// Files that appear whole: written beside their path, synced and renamed at the end.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace understudy {

/// Until finish() what was at the path stays; without it nothing is left behind. A link is followed: what it
/// leads to is replaced. A file that was there hands its permissions on. Nobody else's file is touched: the
/// one beside the path has a name of its own, PATH.PROCESS.part.
class PartFile {
 public:
  /// Throws Error naming the path and the reason: a folder, a pipe or device, read-only, no such folder.
  explicit PartFile(const std::string& path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Throws Error when the disk is full.
  void write(const void* data, size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Over what was written at this place.
  void rewrite(size_t at, std::string_view text);
  /// Synced, so that a power cut leaves the old file or the new one, unless speed is asked for
  /// more. Throws Error; then the file that was there is as it was.
  void finish(bool synced = true);
  const std::string& path() const { return path_; }
  /// Where libraries write that open files by name; all that was written so far is in it.
  const std::string& part();

 private:
  void open_part();
  void check(bool good) const;

  std::string path_, target_, part_;
  std::FILE* file_ = nullptr;
  int mode_ = -1;  // of the file that is replaced
};

/// The whole file at once. Throws Error as PartFile does.
void write_file(const std::string& path, std::string_view bytes, bool synced = true);
/// Throws Error when a file cannot be written there; changes nothing. An empty path is good.
void check_writable(const std::string& path);

/// The same of a folder of frames: `FOLDER.part` is synced and takes the place of `FOLDER` at the end; or,
/// where somebody waits for each frame, every file appears whole at once and stays whatever comes. A folder
/// that is there already is replaced only where it is empty or holds nothing but frames written so before.
class PartFolder {
 public:
  enum class Frames { Together, AsTheyCome };
  /// Every file in it must have this among its first 200 bytes.
  static constexpr const char* kMark = "a frame exported by Understudy";
  /// Throws Error naming the folder when it holds anything else, or cannot be made.
  explicit PartFolder(const std::string& path, Frames appear = Frames::Together);
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  /// Writes one file; throws Error when the disk is full.
  void add(const std::string& name, std::string_view bytes);
  /// Throws Error; then the folder that was there is as it was, unless frames appear as they come.
  void finish();
  const std::string& path() const { return path_; }

 private:
  std::string path_, part_;  // the same where frames appear as they come
  bool finished_ = false;
};

}  // namespace understudy
