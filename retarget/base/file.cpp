#include "retarget/base/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "retarget/base/descriptor.hpp"
#include "retarget/base/error.hpp"

namespace understudy {
namespace {

std::string reason() {
  return errno == ENOENT ? ": there is no such file"
                         : std::string(": cannot be opened (") + std::strerror(errno) + ")";
}

uint64_t regular_size(const struct stat& about, const std::string& path) {
  US_CHECK(!S_ISDIR(about.st_mode), path, ": is a folder, not a file");
  US_CHECK(S_ISREG(about.st_mode), path, ": is a pipe or a device, not a file");
  return static_cast<uint64_t>(about.st_size);
}

}  // namespace

uint64_t check_file(const std::string& path) {
  struct stat about {};
  US_CHECK(::stat(path.c_str(), &about) == 0, path, reason());
  const uint64_t size = regular_size(about, path);
  US_CHECK(::access(path.c_str(), R_OK) == 0, path, reason());
  return size;
}

std::string read_file(const std::string& path, uint64_t most) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  US_CHECK(file.is_open(), path, reason());
  struct stat about {};
  US_CHECK(::fstat(file.value(), &about) == 0, path, ": cannot be read (", std::strerror(errno), ")");
  const uint64_t size = regular_size(about, path);
  US_CHECK(size <= most, path, ": has ", size, " bytes, more than the expected ", most);

  std::string bytes(size, '\0');
  size_t have = 0;
  while (have < bytes.size()) {
    const ssize_t got = ::read(file.value(), bytes.data() + have, bytes.size() - have);
    if (got < 0 && errno == EINTR) continue;
    US_CHECK(got >= 0, path, ": cannot be read (", std::strerror(errno), ")");
    if (got == 0) break;  // it shrank meanwhile
    have += static_cast<size_t>(got);
  }
  bytes.resize(have);
  return bytes;
}

}  // namespace understudy
