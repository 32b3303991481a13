// FBX and DAE, read by a process of its own, which may crash, hang or run out of memory.
#pragma once

#include <string>

#include "retarget/character/character.hpp"
#include "retarget/character/read_character.hpp"

namespace understudy {

/// Runs the worker on the file and reads what it made. Throws Error naming the file: what the worker said,
/// that it crashed, or that it took too long or too much memory.
Character read_in_process(const std::string& path, const ReadCharacterOptions& options);

/// The last line of what a worker said, fit for a dialog box whatever it said: 200 printable characters at
/// most. May be empty.
std::string last_words(std::string_view said);

}  // namespace understudy
