// Where a live stream comes in or goes out: "tcp://HOST:PORT".
#pragma once

#include <string>

namespace understudy {

struct Address {
  std::string scheme, host, port;
  /// "tcp://127.0.0.1:9000".
  std::string text() const;
};

/// "SCHEME://HOST:PORT"; host and port may be left out, as in "tcp://:9000", "vmc://", "vmc": what is missing
/// is taken from `defaults`. A host with colons stands in brackets: "tcp://[::1]:9000".
/// Throws Error, naming the text, where the scheme is another or the port is no number from 0 to 65535.
Address parse_address(const std::string& text, const Address& defaults);

}  // namespace understudy
