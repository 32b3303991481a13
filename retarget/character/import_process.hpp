// FBX and DAE, read by a process of its own, which may crash, hang or run out of memory.
#pragma once

#include <string>

#include "retarget/character/character.hpp"
#include "retarget/character/read_character.hpp"

namespace understudy {

/// Runs the worker on the file and reads what it made. Throws Error naming the file: what the worker said,
/// that it crashed, or that it took too long or too much memory.
Character read_in_process(const std::string& path, const ReadCharacterOptions& options);

}  // namespace understudy
