#include "app/session/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "retarget/base/error.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// A file that is removed at the end unless it was renamed.
class PartFile {
 public:
  PartFile(const std::string& target, mode_t mode)
      : target_(target), part_(target + "." + std::to_string(getpid()) + ".part") {
    handle_ = open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode);
    if (handle_ < 0) fail();
  }
  ~PartFile() {
    if (handle_ >= 0) close(handle_);
    if (!renamed_) std::remove(part_.c_str());
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  void write(const std::string& text) {
    for (size_t at = 0; at < text.size();) {
      const ssize_t count = ::write(handle_, text.data() + at, text.size() - at);
      if (count < 0 && errno != EINTR) fail();
      if (count > 0) at += static_cast<size_t>(count);
    }
    if (fsync(handle_) != 0 && errno != EINVAL) fail();  // a disk may only now find that it is full
    const int closed = close(handle_);
    handle_ = -1;
    if (closed != 0) fail();
  }
  void rename() {
    if (std::rename(part_.c_str(), target_.c_str()) != 0) fail();
    renamed_ = true;
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(target_ + ": cannot be written (" + std::strerror(errno) + ")");
  }

  std::string target_, part_;
  int handle_ = -1;
  bool renamed_ = false;
};

}  // namespace

void write_whole_file(const std::string& path, const std::string& text) {
  US_CHECK(!path.empty(), "a file without a name cannot be written");
  std::error_code error;
  const fs::path followed = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : fs::path(path);
  const std::string target = error ? path : followed.string();
  struct stat old {};
  const bool exists = stat(target.c_str(), &old) == 0;
  US_CHECK(!exists || !S_ISDIR(old.st_mode), path, ": is a folder, not a file");
  US_CHECK(!exists || S_ISREG(old.st_mode), path, ": is a device, not a file");
  US_CHECK(!exists || access(target.c_str(), W_OK) == 0, path, ": is read-only");
  PartFile part(target, exists ? old.st_mode & 07777 : 0666);
  part.write(text);
  part.rename();
}

std::string read_whole_file(const std::string& path, int64_t limit) {
  struct stat status {};
  US_CHECK(stat(path.c_str(), &status) == 0, path, ": ",
           errno == ENOENT ? "there is no such file"
                           : std::string("cannot be read (") + std::strerror(errno) + ")");
  US_CHECK(!S_ISDIR(status.st_mode), path, ": is a folder, not a file");
  US_CHECK(S_ISREG(status.st_mode), path, ": is a device, not a file");
  US_CHECK(status.st_size <= limit, path, ": has ", status.st_size, " bytes, at most ", limit,
           " are expected");
  return read_file(path);
}

}  // namespace understudy::app
