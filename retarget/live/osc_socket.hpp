// OSC messages, and sending them by UDP.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "retarget/live/address.hpp"

namespace understudy {

struct OscMessage {
  std::string path;
  std::vector<std::variant<int32_t, float, std::string>> values;
};

/// Sends to one address. Nobody need listen there. One thread at a time.
class OscSocket {
 public:
  /// Throws Error naming the address where there is no such host.
  explicit OscSocket(const Address& address);
  ~OscSocket();
  OscSocket(OscSocket&&) noexcept;
  OscSocket& operator=(OscSocket&&) noexcept;

  /// The messages in their order, in as few bundles as fit into an Ethernet frame each. What the system
  /// refuses to send is told once and lost.
  void send(const std::vector<OscMessage>& messages);

 private:
  struct Handle;
  Address address_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace understudy
