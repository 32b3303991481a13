// TCP sockets of this machine's system, as few of their calls as a receiver needs.
#pragma once

#include <string>
#include <utility>

#include "retarget/live/address.hpp"

namespace understudy {

/// Owns a file descriptor. Move-only; -1: none.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  int value() const { return value_; }
  bool is_open() const { return value_ >= 0; }

 private:
  int value_;
};

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
