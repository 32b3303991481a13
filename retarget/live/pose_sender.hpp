// Sends what is performed to an engine: "vmc://HOST:PORT" or "osc://HOST:PORT".
#pragma once

#include <string>

#include "retarget/live/sent_pose.hpp"

namespace understudy {

/// One receiver. One thread at a time.
class PoseSender {
 public:
  /// vmc: the VMC protocol, port 39539 where none is given; osc: plain joints, port 9000. The host is this
  /// machine where none is given. Throws Error naming the address.
  explicit PoseSender(const std::string& address);
  /// rest: the target's T-pose.
  void send(const Joints& rest, const SentPose& sent);
  /// In full.
  std::string address() const { return address_.text(); }

 private:
  Address address_;
  OscSocket socket_;
};

/// The address in full. Throws Error where it is none of these.
Address send_address(const std::string& text);

}  // namespace understudy
