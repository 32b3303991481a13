// A program of another maker that listens for OSC on a port of this computer.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "retarget/live/socket.hpp"
#include "retarget/math/types.hpp"

namespace understudy::tests {

class OscReceiver {
 public:
  OscReceiver();
  std::string port() const { return port_of(socket_); }
  /// All messages that have come since the last call, without the bundles around them.
  std::vector<std::string> heard();

 private:
  Descriptor socket_;
};

/// The path of a message, and its first argument, which must be text.
std::string path_in(const std::string& message);
std::string name_in(const std::string& message);
/// The last place of each joint among messages /understudy/joint.
std::map<std::string, Vec3> joints_in(const std::vector<std::string>& messages);

}  // namespace understudy::tests
