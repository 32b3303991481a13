// Every reader of files that strangers make, by one signature, for the fuzzer.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace understudy::fuzz {

struct Reader {
  const char* name;
  /// Reads the bytes and uses what comes out as the program does. Throws Error, and nothing else.
  void (*read)(const std::string& bytes);
  /// The size in memory of what the bytes say they hold: what the largest allocation is measured by.
  size_t (*declared)(const std::string& bytes);
};

const std::vector<Reader>& readers();

}  // namespace understudy::fuzz
