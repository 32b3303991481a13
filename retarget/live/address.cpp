#include "retarget/live/address.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy {

std::string Address::text() const {
  const bool colons = host.find(':') != std::string::npos;
  return scheme + "://" + (colons ? "[" + host + "]" : host) + ":" + port;
}

Address parse_address(const std::string& text, const Address& defaults) {
  Address address = defaults;
  const std::string start = defaults.scheme + "://", form = start + "HOST:PORT";
  if (text == defaults.scheme) return address;
  US_CHECK(starts_with(text, start), text, ": is no address of the form ", form);
  const std::string place = text.substr(start.size());
  const bool brackets = starts_with(place, "[");
  const size_t host_end = brackets ? place.find(']') : place.find(':');
  US_CHECK(!brackets || host_end != std::string::npos, text, ": is no address of the form ", form);
  const std::string host = brackets ? place.substr(1, host_end - 1) : place.substr(0, host_end);
  const std::string rest = host_end == std::string::npos ? "" : place.substr(host_end + (brackets ? 1 : 0));
  US_CHECK(rest.empty() || rest[0] == ':', text, ": is no address of the form ", form);
  if (!host.empty()) address.host = host;
  if (rest.size() > 1) address.port = rest.substr(1);
  int64_t port = -1;
  US_CHECK(parse_integer(address.port, port) && port >= 0 && port <= 65535, text,
           ": needs a port from 0 to 65535, as in ", form);
  return address;
}

}  // namespace understudy
