#include "retarget/live/stream_receiver.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy {
namespace {

using Clock = std::chrono::steady_clock;
constexpr size_t kReadAtOnce = size_t{1} << 16;
constexpr const char* kPipe = "-";

std::pair<Descriptor, Descriptor> pipe_ends() {
  std::array<int, 2> ends{};
  US_CHECK(pipe2(ends.data(), O_CLOEXEC) == 0, "the system allows no further pipe (", std::strerror(errno),
           ")");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

}  // namespace

bool is_live_address(const std::string& address) {
  return address == kPipe || address == "tcp" || starts_with(address, "tcp://");
}

StreamReceiver::StreamReceiver(const ReceiverOptions& options)
    : options_(options), address_(options.address), cutter_(options.format) {
  std::tie(stopped_, stop_) = pipe_ends();
  if (options_.address == kPipe) {
    sender_ = Descriptor(dup(STDIN_FILENO));
    US_CHECK(sender_.is_open(), "standard input cannot be read (", std::strerror(errno), ")");
    sender_name_ = "standard input";
  } else {
    listen();
  }
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    throw Error(address_ + ": the system allows no further thread");
  }
}

Address listen_address(const std::string& text) {
  return parse_address(text, {"tcp", "127.0.0.1", "9000"});
}

StreamReceiver::~StreamReceiver() {
  stop_ = Descriptor();  // the other end wakes up
  thread_.join();
}

void StreamReceiver::listen() {
  Address address = listen_address(options_.address);
  listening_ = listen_at(address);
  address.port = port_of(listening_);
  address_ = address.text();
  log::info(address_ + ": waits for a sender");
  if (!is_local(address))
    log::warn(address_ + ": whoever reaches this machine may send; tcp://127.0.0.1:" + address.port +
              " is for this machine alone");
}

std::optional<ReceivedFrame> StreamReceiver::newest(Moment until) {
  std::unique_lock<std::mutex> lock(mutex_);
  news_.wait_until(lock, until, [this] { return newest_ || ended_; });
  return std::exchange(newest_, std::nullopt);
}

bool StreamReceiver::ended() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ended_ && !newest_;
}

int64_t StreamReceiver::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

void StreamReceiver::run() {
  for (;;) {
    std::vector<pollfd> all = {{stopped_.value(), POLLIN, 0}};
    if (listening_.is_open()) all.push_back({listening_.value(), POLLIN, 0});
    if (sender_.is_open()) all.push_back({sender_.value(), POLLIN, 0});
    if (poll(all.data(), all.size(), -1) < 0 && errno != EINTR) break;
    if (all[0].revents != 0) break;
    // What the sender said before another one came counts first.
    if (sender_.is_open() && all.back().revents != 0) read();
    if (listening_.is_open() && all[1].revents != 0) greet();
    if (!listening_.is_open() && !sender_.is_open()) break;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  ended_ = true;
  news_.notify_all();
}

/// Somebody connects.
void StreamReceiver::greet() {
  auto [sender, name] = accept_from(listening_);
  if (!sender.is_open()) return;
  const double silent = std::chrono::duration<double>(Clock::now() - heard_).count();
  if (sender_.is_open() && silent < options_.silence_s) {
    const std::string why = address_ + ": " + name + " is refused, " + sender_name_ + " is sending";
    refusals_.warn(why);
    send(sender.value(), (why + "\n").data(), why.size() + 1, MSG_NOSIGNAL | MSG_DONTWAIT);
    return;
  }
  if (sender_.is_open()) leave(printed("has been silent for %.1f s, another one takes its place", silent));
  sender_ = std::move(sender);
  sender_name_ = name;
  heard_ = Clock::now();
  cutter_ = StreamCutter(options_.format);
  log::info(address_ + ": " + name + " sends");
}

void StreamReceiver::read() {
  std::array<char, kReadAtOnce> buffer;
  const ssize_t count = ::read(sender_.value(), buffer.data(), buffer.size());
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count < 0) return leave(std::string("is lost (") + std::strerror(errno) + ")");
  if (count == 0) return leave(cutter_.in_frame() ? "ended in the middle of a frame" : "has ended");
  heard_ = Clock::now();
  std::string_view bytes(buffer.data(), static_cast<size_t>(count));
  try {
    while (!bytes.empty()) {
      if (!cutter_.in_frame()) begun_ = heard_;
      bytes.remove_prefix(cutter_.push(bytes));
      if (auto frame = cutter_.take()) keep(std::move(*frame));
    }
  } catch (const Error& lie) {
    leave(std::string("says ") + lie.what() + ", and is closed; --stream says how clouds follow each other");
  } catch (const std::bad_alloc&) {
    leave("sends more than there is memory for, and is closed");
  }
}

void StreamReceiver::leave(const std::string& why) {
  partings_.warn(address_ + ": " + sender_name_ + " " + why +
                 (listening_.is_open() ? "; the next one is waited for" : ""));
  sender_ = Descriptor();
  cutter_ = StreamCutter(options_.format);
}

void StreamReceiver::keep(StreamFrame frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (newest_) ++dropped_;
  newest_ = ReceivedFrame{std::move(frame), begun_};
  news_.notify_all();
}

}  // namespace understudy
