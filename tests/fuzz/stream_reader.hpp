// What a stranger sends over a live stream, in the pieces that a socket gives.
#pragma once

#include <string>

namespace understudy::fuzz {

/// The first byte chooses the form of the stream, the second its pieces; the stream is what follows. Throws
/// Error where a length or a frame lies.
void stream(const std::string& bytes);

}  // namespace understudy::fuzz
