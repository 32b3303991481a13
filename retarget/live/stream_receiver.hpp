// Takes a live stream in on a thread of its own, and keeps the newest frame alone.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "retarget/base/log.hpp"
#include "retarget/live/socket.hpp"
#include "retarget/live/stream_format.hpp"

namespace understudy {

/// "-": standard input. "tcp://HOST:PORT": senders connect there.
bool is_live_address(const std::string& address);
/// "tcp://HOST:PORT" in full: this machine, port 9000, where they are left out. Throws Error where it is
/// none.
Address listen_address(const std::string& text);

struct ReceiverOptions {
  std::string address;
  StreamFormat format = StreamFormat::Auto;
  double silence_s = 2;  ///< after which another sender may take the place of one that is still connected
};

/// A frame, and when its first byte was here.
struct ReceivedFrame {
  StreamFrame frame;
  std::chrono::steady_clock::time_point captured;
};

/// One sender at a time: another one is told in a sentence that it is refused, unless the first is silent. A
/// sender that goes, or whose lengths cannot be, is closed, which is logged, and the next one is waited for.
/// Any thread.
class StreamReceiver {
 public:
  using Moment = std::chrono::steady_clock::time_point;
  /// "tcp://" alone listens at this machine's port 9000, for this machine alone.
  /// Throws Error naming the address where it cannot be listened at.
  explicit StreamReceiver(const ReceiverOptions& options);
  ~StreamReceiver();
  StreamReceiver(const StreamReceiver&) = delete;
  StreamReceiver& operator=(const StreamReceiver&) = delete;

  /// The newest frame that nobody took yet, waited for until then; none: none came.
  std::optional<ReceivedFrame> newest(Moment until);
  /// Whether none will come any more: standard input has ended.
  bool ended() const;
  /// Frames that came and were overtaken by newer ones before anybody took them.
  int64_t dropped() const;
  /// With the port that was taken for port 0.
  const std::string& address() const { return address_; }

 private:
  void run();
  void listen();
  void greet();
  void read();
  void leave(const std::string& why);
  void keep(StreamFrame frame);

  ReceiverOptions options_;
  std::string address_;
  Descriptor listening_, sender_, stop_, stopped_;  // the last two: ends of a pipe that wakes the thread
  std::string sender_name_;
  // The thread's own:
  StreamCutter cutter_;
  Moment begun_{}, heard_{};  // the frame that is read, and the last byte
  log::Tally refusals_, partings_;
  // Shared:
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::optional<ReceivedFrame> newest_;
  int64_t dropped_ = 0;
  bool ended_ = false;
  std::thread thread_;  // last: it uses all others
};

}  // namespace understudy
