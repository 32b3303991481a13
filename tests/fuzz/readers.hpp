// Every reader of files and streams that strangers make, by one signature, for the fuzzer.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace understudy::fuzz {

struct Reader {
  std::string name;
  /// Reads the bytes and uses what comes out as the program does. Throws Error, and nothing else.
  std::function<void(const std::string& bytes)> read;
  /// The size in memory of what the bytes say they hold: what the largest allocation is measured by.
  size_t (*declared)(const std::string& bytes);
};

const std::vector<Reader>& readers();

}  // namespace understudy::fuzz
