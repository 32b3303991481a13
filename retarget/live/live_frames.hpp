// A live stream as a sequence of scans on a regular clock that goes on while nothing comes.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "retarget/formats/scan_source.hpp"
#include "retarget/live/stream_receiver.hpp"

namespace understudy {

struct LiveOptions {
  std::string address;
  StreamFormat format = StreamFormat::Auto;
  double fps = 30;                  ///< of the clock
  double wait_s = 0;                ///< the stream ends when no frame came for so long; 0: never
  std::function<bool()> cancelled;  ///< asked several times a second; true ends the stream
};

/// The clock of a stream: which frame of a regular sequence one is that comes at some moment. Frames that
/// come a little early or late keep their turn, so that jitter makes no gaps.
class LiveClock {
 public:
  using Moment = std::chrono::steady_clock::time_point;
  explicit LiveClock(double fps) : fps_(fps) {}
  /// The frame that one is that comes now; none: the stream is ahead of the clock, and it is too many.
  std::optional<int64_t> number_at(Moment now) const;
  /// That frame was handed out, or one that is missing.
  void passed(int64_t number) { next_ = number + 1; }
  /// The next frame counts as missing when nothing came until then.
  Moment patience() const;
  /// The first frame comes now.
  void start(Moment now) { start_ = now; }
  int64_t next() const { return next_; }

 private:
  double late_by(Moment now) const;

  double fps_;
  Moment start_{};
  int64_t next_ = 0;
};

/// Frames as they come, the newest one at once. What is overtaken while nobody asks is dropped, its time
/// passes. While no frame comes missing ones are handed out in their time, up to kLongestGap of them; then it
/// is waited for the next one. Throws Error where the address cannot be listened at, and from next() where
/// the stream ends before its first frame.
std::unique_ptr<ScanSource::Frames> live_frames(const LiveOptions& options);

}  // namespace understudy
