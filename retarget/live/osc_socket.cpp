#include "retarget/live/osc_socket.hpp"

#include <lo/lo.h>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/live/socket.hpp"

namespace understudy {
namespace {

constexpr size_t kMostBytes = 1400;  // of a bundle: a datagram of more is cut into pieces on its way
constexpr size_t kBundleHead = 16, kMessageHead = 4;

struct FreesMessage {
  void operator()(lo_message message) const { lo_message_free(message); }
};
struct FreesBundle {
  void operator()(lo_bundle bundle) const { lo_bundle_free_recursive(bundle); }
};
using Message = std::unique_ptr<std::remove_pointer_t<lo_message>, FreesMessage>;
using Bundle = std::unique_ptr<std::remove_pointer_t<lo_bundle>, FreesBundle>;

void add(lo_message message, int32_t value) {
  lo_message_add_int32(message, value);
}
void add(lo_message message, float value) {
  lo_message_add_float(message, value);
}
void add(lo_message message, const std::string& value) {
  lo_message_add_string(message, value.c_str());
}

}  // namespace

struct OscSocket::Handle {
  lo_address address = nullptr;
  ~Handle() {
    if (address != nullptr) lo_address_free(address);
  }
  void send(lo_bundle bundle, const std::string& name) const {
    if (lo_send_bundle(address, bundle) >= 0) return;
    const char* const why = lo_address_errstr(address);
    log::warn_once(name + ": cannot be sent to (" + (why != nullptr ? why : "no reason given") + ")");
  }
};

OscSocket::OscSocket(const Address& address) : address_(address), handle_(std::make_unique<Handle>()) {
  check_host(address);
  handle_->address = lo_address_new(address.host.c_str(), address.port.c_str());
  US_CHECK(handle_->address != nullptr, address.text(), ": cannot be sent to");
}
OscSocket::~OscSocket() = default;
OscSocket::OscSocket(OscSocket&&) noexcept = default;
OscSocket& OscSocket::operator=(OscSocket&&) noexcept = default;

void OscSocket::send(const std::vector<OscMessage>& messages) {
  Bundle bundle;
  size_t bytes = 0;
  for (const OscMessage& one : messages) {
    Message message(lo_message_new());
    for (const auto& value : one.values) std::visit([&](const auto& v) { add(message.get(), v); }, value);
    const size_t more = kMessageHead + lo_message_length(message.get(), one.path.c_str());
    if (bundle && bytes + more > kMostBytes) {
      handle_->send(bundle.get(), address_.text());
      bundle.reset();
    }
    if (!bundle) bundle.reset(lo_bundle_new(LO_TT_IMMEDIATE)), bytes = kBundleHead;
    lo_bundle_add_message(bundle.get(), one.path.c_str(), message.release());
    bytes += more;
  }
  if (bundle) handle_->send(bundle.get(), address_.text());
}

}  // namespace understudy
