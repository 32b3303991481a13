// A camera that is none: connects to a receiver of live streams on this machine.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "retarget/base/error.hpp"
#include "retarget/live/socket.hpp"

namespace understudy::tests {

class StreamSender {
 public:
  /// "tcp://127.0.0.1:PORT". Throws Error where nobody listens there.
  explicit StreamSender(const std::string& address)
      : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    place.sin_port = htons(static_cast<uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
    US_CHECK(connect(socket_.value(), reinterpret_cast<sockaddr*>(&place), sizeof place) == 0, address,
             ": cannot be connected to (", std::strerror(errno), ")");
    const int on = 1;  // each piece goes by itself
    setsockopt(socket_.value(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  /// Throws Error where it has been closed.
  void send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t n = TEMP_FAILURE_RETRY(::send(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL));
      US_CHECK(n > 0, "the stream is closed");
      bytes.remove_prefix(static_cast<size_t>(n));
    }
  }
  /// No more will come.
  void end() const { shutdown(socket_.value(), SHUT_WR); }
  /// What is said to it until it is closed.
  std::string heard() const {
    const timeval patience{20, 0};
    setsockopt(socket_.value(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    std::string all;
    std::array<char, 256> buffer;
    for (ssize_t n; (n = TEMP_FAILURE_RETRY(read(socket_.value(), buffer.data(), buffer.size()))) > 0;)
      all.append(buffer.data(), static_cast<size_t>(n));
    return all;
  }

 private:
  Descriptor socket_;
};

}  // namespace understudy::tests
