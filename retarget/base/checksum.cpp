#include "retarget/base/checksum.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"

namespace understudy {

std::string checksum_text(uint64_t checksum) {
  return printed("%016llx", static_cast<unsigned long long>(checksum));
}

std::string checksum_of_file(const std::string& path) {
  std::string bytes;
  if (!failure_of([&] { bytes = read_file(path); }).empty()) return {};
  return checksum_text(fnv1a(bytes));
}

}  // namespace understudy
