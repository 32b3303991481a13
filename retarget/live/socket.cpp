#include "retarget/live/socket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

using Places = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Places places_of(const Address& address) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int failed = getaddrinfo(address.host.c_str(), address.port.c_str(), &wanted, &found);
  US_CHECK(failed == 0, address.text(), ": there is no such host (", gai_strerror(failed), ")");
  return {found, &freeaddrinfo};
}

/// "127.0.0.1", "4711".
std::pair<std::string, std::string> name_of(const sockaddr_storage& place, socklen_t size) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  getnameinfo(reinterpret_cast<const sockaddr*>(&place), size, host.data(), host.size(), port.data(),
              port.size(), NI_NUMERICHOST | NI_NUMERICSERV);
  return {host.data(), port.data()};
}

}  // namespace

void check_host(const Address& address) {
  places_of(address);
}

Descriptor listen_at(const Address& address) {
  const Places place = places_of(address);
  Descriptor listening(
      socket(place->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, place->ai_protocol));
  const int on = 1;  // a port whose last connection has just ended is free
  const bool works =
      listening.is_open() && setsockopt(listening.value(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
      bind(listening.value(), place->ai_addr, place->ai_addrlen) == 0 && listen(listening.value(), 4) == 0;
  US_CHECK(works, address.text(), ": cannot be listened at (", std::strerror(errno), ")");
  return listening;
}

std::string port_of(const Descriptor& listening) {
  sockaddr_storage place{};
  socklen_t size = sizeof place;
  getsockname(listening.value(), reinterpret_cast<sockaddr*>(&place), &size);
  return name_of(place, size).second;
}

bool is_local(const Address& address) {
  const Places place = places_of(address);
  if (place->ai_family == AF_INET6)
    return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6*>(place->ai_addr)->sin6_addr);
  const auto* const four = reinterpret_cast<const sockaddr_in*>(place->ai_addr);
  return place->ai_family == AF_INET && (ntohl(four->sin_addr.s_addr) >> 24) == 127;
}

std::pair<Descriptor, std::string> accept_from(const Descriptor& listening) {
  sockaddr_storage place{};
  socklen_t size = sizeof place;
  Descriptor sender(
      accept4(listening.value(), reinterpret_cast<sockaddr*>(&place), &size, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!sender.is_open()) return {Descriptor(), std::string()};
  const int on = 1;
  setsockopt(sender.value(), SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
  const auto [host, port] = name_of(place, size);
  return {std::move(sender), Address{"", host, port}.text().substr(3)};
}

}  // namespace understudy
