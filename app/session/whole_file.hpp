// Small files written as a whole: the old one stays until the new one is complete.
#pragma once

#include <cstdint>
#include <string>

namespace understudy::app {

/// Writes beside and renames; the old file's permissions stay, a link's target is replaced. Two programs that
/// write the same file leave one of both texts. Throws Error naming the path and the reason (a full disk, a
/// folder that is not there or read-only); then the old file is as it was.
void write_whole_file(const std::string& path, const std::string& text);

/// The text of a regular file of at most `limit` bytes. Throws Error naming the path and the reason.
std::string read_whole_file(const std::string& path, int64_t limit);

}  // namespace understudy::app
