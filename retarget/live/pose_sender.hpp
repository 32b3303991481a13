// Sends what is performed to an engine: "vmc://HOST:PORT" or "osc://HOST:PORT".
#pragma once

#include <string>

#include "retarget/live/sent_pose.hpp"

namespace understudy {

/// One receiver. One thread at a time.
class PoseSender {
 public:
  /// vmc: the VMC protocol, port 39539 where none is given; osc: plain joints, port 9000. The host is this
  /// machine where none is given. rest: the target's T-pose. Throws Error naming the address.
  PoseSender(const std::string& address, const Joints& rest);
  void send(const SentPose& sent);

 private:
  Address address_;
  Joints rest_;
  OscSocket socket_;
};

/// The address in full. Throws Error where it is none of these.
Address send_address(const std::string& text);

}  // namespace understudy
