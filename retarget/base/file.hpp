// Files that are read: regular ones alone, since a pipe may never end and a device has no size.
#pragma once

#include <cstdint>
#include <string>

namespace understudy {

/// For readers that open a path by themselves (streams, libzip, libpng, Assimp, LibTorch); its size in bytes.
/// Throws Error naming the path when nothing is there, or a folder, a pipe or another special file.
uint64_t check_file(const std::string& path);

/// The whole file. Throws Error naming the path and the system's reason (no such file, no permission, a
/// folder, a pipe), or when it has more than `most` bytes.
std::string read_file(const std::string& path, uint64_t most = uint64_t{4} << 30);

}  // namespace understudy
