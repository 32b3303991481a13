// What a job reads, by content: files, folders, and the files that those name.
#pragma once

#include <string>
#include <vector>

#include "app/run/report.hpp"

namespace understudy::app {

/// The files that an input is: a folder's own (no folders in it, no hidden ones), by name; a file itself and
/// what it names: a glTF's buffers and pictures, an OBJ's materials and their pictures, a list's scans.
/// Throws Error naming the path when nothing is there.
std::vector<std::string> files_of(const std::string& path);

/// Names, sizes and times of change: equal where nobody wrote to any of them. Throws Error.
std::string stamp_of(const std::vector<std::string>& files);
/// Names and contents, as FNV-1a with 64 bits. Throws Error naming a file that cannot be read.
std::string hash_of(const std::vector<std::string>& files);

/// One input as records have it.
struct InputRecord {
  std::string path;
  int64_t files = 0, bytes = 0;
  std::string hash, stamp;
};

/// Throws Error.
InputRecord record_input(const std::string& path);
/// Whether what is at its path still is what the record says: by its stamp, or, where that is another (a
/// copy, a new checkout), by its content. Throws Error.
bool is_as_recorded(const InputRecord& record);

Json to_json(const InputRecord& record);
/// Throws nlohmann's exceptions where it is none.
InputRecord input_record(const Json& json);

}  // namespace understudy::app
