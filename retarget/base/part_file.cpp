#include "retarget/base/part_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "retarget/base/descriptor.hpp"
#include "retarget/base/error.hpp"

namespace understudy {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFull = ": cannot be written, the disk may be full";

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
  US_CHECK(replaceable(path), path, ": exists and holds more than exported frames; choose another folder");
  US_CHECK(replaceable(part), part, ": exists but was not left by an export; remove it first");
}

/// Brings what is `at` to the disk, which may only now find that it is full: a file; of a folder all that is
/// in it, by one call for the whole disk, as each file's own would wait for the disk anew.
void sync_to_disk(const std::string& at, const std::string& path) {
  const Descriptor file(::open(at.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat about {};
  const bool is_folder = file.is_open() && ::fstat(file.value(), &about) == 0 && S_ISDIR(about.st_mode);
  const bool good = file.is_open() &&
                    ((is_folder ? ::syncfs(file.value()) : ::fsync(file.value())) == 0 || errno == EINVAL);
  US_CHECK(good, path, ": cannot be written (", std::strerror(errno), ")");
}

}  // namespace

PartFile::PartFile(const std::string& path) : path_(path), target_(path) {
  US_CHECK(!path.empty(), "a file without a name cannot be written");
  std::error_code error;
  if (fs::is_symlink(path, error)) target_ = fs::weakly_canonical(path, error).string();
  if (error) target_ = path;
  struct stat old {};
  if (::stat(target_.c_str(), &old) == 0) {
    US_CHECK(!S_ISDIR(old.st_mode), path, ": is a folder, not a file");
    US_CHECK(S_ISREG(old.st_mode), path, ": is a pipe or a device, not a file");
    US_CHECK(::access(target_.c_str(), W_OK) == 0, path, ": is read-only");
    mode_ = static_cast<int>(old.st_mode & 07777);
  }
  open_part();
}

void PartFile::open_part() {
  int handle = -1;
  for (int n = 0; handle < 0; ++n) {
    part_ = target_ + "." + std::to_string(::getpid()) + (n > 0 ? "-" + std::to_string(n) : "") + ".part";
    handle = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    check(handle >= 0 || (errno == EEXIST && n < 1000));
  }
  file_ = ::fdopen(handle, "wb");
}

PartFile::~PartFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (!part_.empty()) std::remove(part_.c_str());
}

void PartFile::check(bool good) const {
  US_CHECK(good, path_, ": cannot be written (", std::strerror(errno), ")");
}

void PartFile::write(const void* data, size_t size) {
  check(std::fwrite(data, 1, size, file_) == size);
}

void PartFile::rewrite(size_t at, std::string_view text) {
  check(std::fseek(file_, static_cast<long>(at), SEEK_SET) == 0);
  write(text);
  check(std::fseek(file_, 0, SEEK_END) == 0);
}

const std::string& PartFile::part() {
  check(std::fflush(file_) == 0);
  return part_;
}

void PartFile::finish(bool synced) {
  check(std::fclose(std::exchange(file_, nullptr)) == 0);
  if (synced) sync_to_disk(part_, path_);  // opened anew: a library may have put a file of its own here
  check((mode_ < 0 || ::chmod(part_.c_str(), static_cast<mode_t>(mode_)) == 0) &&
        std::rename(part_.c_str(), target_.c_str()) == 0);
  part_.clear();
}

void write_file(const std::string& path, std::string_view bytes, bool synced) {
  PartFile file(path);
  file.write(bytes);
  file.finish(synced);
}

void check_writable(const std::string& path) {
  if (!path.empty()) const PartFile made_and_removed(path);
}

PartFolder::PartFolder(const std::string& path, Frames appear)
    : path_(folder_name(path)), part_(path_ + (appear == Frames::Together ? ".part" : "")) {
  US_CHECK(!path_.empty(), "a folder without a name cannot be written");
  check_replaceable(path_, part_);
  std::error_code error;
  fs::remove_all(part_, error);
  US_CHECK(fs::create_directories(part_, error) && !error, path_, ": cannot be written");
  finished_ = part_ == path_;  // nothing is to be moved or removed
}

PartFolder::~PartFolder() {
  std::error_code error;
  if (!finished_) fs::remove_all(part_, error);
}

void PartFolder::add(const std::string& name, std::string_view bytes) {
  if (finished_) return write_file(part_ + "/" + name, bytes, /*synced=*/false);
  std::ofstream file(part_ + "/" + name, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  US_CHECK(file, path_, kFull);
}

void PartFolder::finish() {
  sync_to_disk(part_, path_);
  if (finished_) return;
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
