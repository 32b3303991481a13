// TCP sockets of this machine's system, as few of their calls as a receiver needs.
#pragma once

#include <string>
#include <utility>

#include "retarget/base/descriptor.hpp"
#include "retarget/live/address.hpp"

namespace understudy {

/// Throws Error naming the address where there is no such host.
void check_host(const Address& address);
/// Waits for connections there; port 0: any free one. Throws Error naming the address: no such host, no
/// permission, the port is taken.
Descriptor listen_at(const Address& address);
/// The port that a listening socket has.
std::string port_of(const Descriptor& listening);
/// Whether the host is this machine as it sees itself alone.
bool is_local(const Address& address);
/// The next one that waits, and where it comes from, "127.0.0.1:4711". Closed: there is none.
std::pair<Descriptor, std::string> accept_from(const Descriptor& listening);

}  // namespace understudy
