#include "tests/app/osc_receiver.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstring>

namespace understudy::tests {
namespace {

uint32_t int_at(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return ntohl(value);
}

/// Behind a text that begins at a place: texts are filled with zeros to whole fours.
size_t end_of_text(const std::string& bytes, size_t at) {
  return (bytes.find('\0', at) / 4 + 1) * 4;
}

/// Behind the path and the types.
size_t values_of(const std::string& message) {
  return end_of_text(message, end_of_text(message, 0));
}

}  // namespace

OscReceiver::OscReceiver() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(bind(socket_.value(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
}

std::vector<std::string> OscReceiver::heard() {
  std::vector<std::string> messages;
  std::array<char, 65536> packet;
  for (ssize_t n; (n = recv(socket_.value(), packet.data(), packet.size(), 0)) > 0;) {
    const std::string bundle(packet.data(), static_cast<size_t>(n));
    for (size_t at = 16; at + 4 <= bundle.size();) {  // behind "#bundle" and the time
      const size_t size = int_at(bundle, at);
      messages.push_back(bundle.substr(at + 4, size));
      at += 4 + size;
    }
  }
  return messages;
}

std::string path_in(const std::string& message) {
  return message.c_str();
}

std::string name_in(const std::string& message) {
  return message.c_str() + values_of(message);
}

std::map<std::string, Vec3> joints_in(const std::vector<std::string>& messages) {
  std::map<std::string, Vec3> joints;
  for (const std::string& message : messages) {
    if (path_in(message) != "/understudy/joint") continue;
    const size_t numbers = end_of_text(message, values_of(message));
    Vec3& place = joints[name_in(message)];
    for (int k = 0; k < 3; ++k) {
      const uint32_t bits = int_at(message, numbers + 4 * static_cast<size_t>(k));
      std::memcpy(&place[k], &bits, sizeof bits);
    }
  }
  return joints;
}

}  // namespace understudy::tests
