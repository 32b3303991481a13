#include "retarget/live/pose_sender.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy {

Address send_address(const std::string& text) {
  const bool is_vmc = starts_with(text, "vmc"), is_osc = starts_with(text, "osc");
  US_CHECK(is_vmc || is_osc, text, ": is no address to send to, which is vmc://HOST:PORT or osc://HOST:PORT");
  Address address = parse_address(text, {is_vmc ? "vmc" : "osc", "127.0.0.1", is_vmc ? "39539" : "9000"});
  US_CHECK(address.port != "0", text, ": needs a port from 1 to 65535");
  return address;
}

PoseSender::PoseSender(const std::string& address) : address_(send_address(address)), socket_(address_) {}

void PoseSender::send(const Joints& rest, const SentPose& sent) {
  socket_.send(address_.scheme == "vmc" ? vmc_messages(rest, sent) : joint_messages(sent));
}

}  // namespace understudy
