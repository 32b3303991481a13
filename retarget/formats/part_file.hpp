// Files that appear whole: written beside their path, renamed at the end.
#pragma once

#include <fstream>
#include <string>
#include <string_view>

namespace understudy {

/// Until finish() what was at the path stays; without it nothing is left behind.
class PartFile {
 public:
  /// Throws Error naming the path when it cannot be written.
  explicit PartFile(const std::string& path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Throws Error when the disk is full.
  void write(const void* data, size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Over what was written at this place.
  void rewrite(size_t at, std::string_view text);
  /// Throws Error; then the file that was there is as it was.
  void finish();
  const std::string& path() const { return path_; }

 private:
  std::string path_, part_;
  std::ofstream file_;
  bool finished_ = false;
};

/// The same of a folder of frames: `FOLDER.part` takes the place of `FOLDER` at the end. A folder that is
/// there already is replaced only where it is empty or holds nothing but frames written so before.
class PartFolder {
 public:
  /// Every file in it must have this among its first 200 bytes.
  static constexpr const char* kMark = "a frame exported by Understudy";
  /// Throws Error naming the folder when it holds anything else, or cannot be made.
  explicit PartFolder(const std::string& path);
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  /// Writes one file; throws Error when the disk is full.
  void add(const std::string& name, std::string_view bytes);
  /// Throws Error; then the folder that was there is as it was.
  void finish();
  const std::string& path() const { return path_; }

 private:
  std::string path_, part_;
  bool finished_ = false;
};

}  // namespace understudy
