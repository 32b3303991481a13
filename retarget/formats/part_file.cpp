#include "retarget/formats/part_file.hpp"

#include <cstdio>
#include <filesystem>

#include "retarget/base/error.hpp"

namespace understudy {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFull = ": writing failed, the disk may be full";

/// Without the slash at its end.
std::string folder_name(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).string();
}

bool is_exported_frame(const fs::path& path) {
  if (!fs::is_regular_file(fs::symlink_status(path))) return false;
  std::ifstream file(path, std::ios::binary);
  std::string head(200, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(PartFolder::kMark) != std::string::npos;
}

/// Whether nothing is lost with what is there.
bool replaceable(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder, error))) return true;
  if (!fs::is_directory(fs::symlink_status(folder, error))) return false;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (!is_exported_frame(entry.path())) return false;
  return !error;
}

void check_replaceable(const std::string& path, const std::string& part) {
  US_CHECK(replaceable(path), path,
           ": is there and holds other things than exported frames; name another folder");
  US_CHECK(replaceable(part), part, ": is there and is no leftover of an export; it is in the way");
}

}  // namespace

PartFile::PartFile(const std::string& path) : path_(path), part_(path + ".part") {
  US_CHECK(!fs::is_directory(path), path, ": is a folder, not a file");
  file_.open(part_, std::ios::binary);
  US_CHECK(file_, path_, ": cannot be written");
}

PartFile::~PartFile() {
  if (finished_) return;
  file_.close();
  std::remove(part_.c_str());
}

void PartFile::write(const void* data, size_t size) {
  file_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  US_CHECK(file_, path_, kFull);
}

void PartFile::rewrite(size_t at, std::string_view text) {
  file_.seekp(static_cast<std::streamoff>(at));
  write(text);
  file_.seekp(0, std::ios::end);
}

void PartFile::finish() {
  file_.close();
  US_CHECK(file_, path_, kFull);
  US_CHECK(std::rename(part_.c_str(), path_.c_str()) == 0, path_, ": cannot be written");
  finished_ = true;
}

PartFolder::PartFolder(const std::string& path) : path_(folder_name(path)), part_(path_ + ".part") {
  US_CHECK(!path_.empty(), "a folder without a name cannot be written");
  check_replaceable(path_, part_);
  std::error_code error;
  fs::remove_all(part_, error);
  US_CHECK(fs::create_directories(part_, error) && !error, path_, ": cannot be written");
}

PartFolder::~PartFolder() {
  std::error_code error;
  if (!finished_) fs::remove_all(part_, error);
}

void PartFolder::add(const std::string& name, std::string_view bytes) {
  std::ofstream file(part_ + "/" + name, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  US_CHECK(file, path_, kFull);
}

void PartFolder::finish() {
  US_CHECK(replaceable(path_), path_, ": something else was put there meanwhile");
  const std::string old = path_ + ".old.part";
  std::error_code error;
  fs::remove_all(old, error);
  const bool was_there = fs::exists(path_);
  if (was_there) fs::rename(path_, old, error);
  US_CHECK(!error, path_, ": cannot be replaced (", error.message(), ")");
  fs::rename(part_, path_, error);
  if (error) {
    const std::string why = error.message();
    if (was_there) fs::rename(old, path_, error);
    throw Error(path_ + ": cannot be written (" + why + ")");
  }
  finished_ = true;
  fs::remove_all(old, error);
}

}  // namespace understudy
