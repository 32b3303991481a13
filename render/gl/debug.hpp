// The driver's debug messages (KHR_debug).
#pragma once

#include "render/gl/functions.hpp"

namespace understudy::render::gl {

enum class DebugMode {
  Off,
  Log,   ///< errors become warnings in the log, each once
  Fatal  ///< check_debug() throws the first error since the last check; what tests use
};

/// Listens to the current context, which needs the debug flag. Without KHR_debug, check_debug() asks
/// glGetError.
void install_debug(DebugMode mode);
/// In Fatal mode throws Error with the driver's first message; else does nothing. (A C library's callback
/// must not throw through its caller: so the message is kept until someone asks here.)
void check_debug();

}  // namespace understudy::render::gl
