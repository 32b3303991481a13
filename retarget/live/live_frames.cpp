#include "retarget/live/live_frames.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/scan_frames.hpp"

namespace understudy {
namespace {

using Clock = std::chrono::steady_clock;
using Moment = Clock::time_point;

constexpr double kLate = 1, kEarly = 2;  // frames by which one may come so and keep its turn
constexpr int64_t kCatchUp = 15;         // frames in a row that are over before they are looked for
constexpr double kLook_s = 0.05;         // between two questions whether the stream is cancelled
constexpr double kMeasured_s = 5;        // after which the rate of a stream is known

Clock::duration seconds(double s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}
double seconds_since(Moment moment) {
  return std::chrono::duration<double>(Clock::now() - moment).count();
}

class LiveFrames final : public ScanSource::Frames {
 public:
  explicit LiveFrames(const LiveOptions& options)
      : options_(options),
        receiver_({options.address, options.format}),
        clock_(options.fps),
        heard_(Clock::now()) {}
  ~LiveFrames() override { problems_.finish(); }

  std::optional<ScanFrame> next() override {
    for (;;) {
      const bool waits = !started_ || pause_ >= kLongestGap;
      const Moment now = Clock::now(), look = now + seconds(kLook_s);
      if (!waits && now >= clock_.patience() && pause_ < kCatchUp) return missing();  // its time is over
      const auto received = receiver_.newest(waits ? look : std::min(look, clock_.patience()));
      if (received) {
        if (auto frame = framed(*received)) return frame;
      } else if (is_over()) {
        return {};
      } else if (!waits && Clock::now() >= clock_.patience()) {
        return missing();
      }
    }
  }
  std::optional<int64_t> count() const override { return {}; }
  void seek(int64_t) override { throw Error(receiver_.address() + ": what was live cannot be read again"); }

 private:
  bool is_over() const {
    const bool over = receiver_.ended() || (options_.cancelled && options_.cancelled());
    const bool late = options_.wait_s > 0 && seconds_since(heard_) >= options_.wait_s;
    US_CHECK(started_ || !over, receiver_.address(), ": ended before a frame came");
    US_CHECK(started_ || !late, receiver_.address(), ": no frame came within ", options_.wait_s, " s");
    return over || late;
  }

  ScanFrame missing() {
    ++pause_;
    return numbered(missing_frame(receiver_.address(), clock_.next()));
  }

  /// None: it is one too many.
  std::optional<ScanFrame> framed(const ReceivedFrame& received) {
    heard_ = Clock::now();
    if (!std::exchange(started_, true)) {
      clock_.start(heard_);
      first_ = heard_;
      dropped_before_ = receiver_.dropped();
    }
    tell_rate();
    const auto number = clock_.number_at(heard_);
    if (!number) {
      ++too_many_;
      return {};
    }
    if (*number > clock_.next()) gaps.push_back({clock_.next(), *number - 1});
    pause_ = 0;
    ScanFrame frame;
    frame.number = *number;
    frame.path = receiver_.address();
    take_scan(frame, [&] { return decode(received.frame, frame.path); });
    if (!frame.usable && !frame.is_empty) problems_.warn(frame.problem);
    frame.live = LiveMoment{received.captured, receiver_.dropped() + too_many_};
    return numbered(std::move(frame));
  }

  ScanFrame numbered(ScanFrame frame) {
    clock_.passed(frame.number);
    return frame;
  }

  /// The rate is not the stream's to say: a wrong one is told.
  void tell_rate() {
    ++came_;
    const double passed = seconds_since(first_);
    if (told_ || passed < kMeasured_s) return;
    told_ = true;
    const double rate = static_cast<double>(came_ - 1 + receiver_.dropped() - dropped_before_) / passed;
    if (std::abs(rate - options_.fps) > 0.1 * options_.fps)
      log::warn(receiver_.address() +
                printed(": comes at %.1f frames/s and is put on a clock of %g; --fps changes it", rate,
                        options_.fps));
  }

  LiveOptions options_;
  StreamReceiver receiver_;
  LiveClock clock_;
  Moment heard_, first_{};  // the last frame, and the first one
  bool started_ = false, told_ = false;
  int64_t dropped_before_ = 0;                   // the first one was asked for
  int64_t pause_ = 0, came_ = 0, too_many_ = 0;  // missing ones in a row; frames
  log::Tally problems_;
};

}  // namespace

double LiveClock::late_by(Moment now) const {
  return std::chrono::duration<double>(now - start_).count() * fps_ - static_cast<double>(next_);
}

std::optional<int64_t> LiveClock::number_at(Moment now) const {
  const double late = late_by(now);
  if (late < -kEarly) return {};
  return late > kLate ? next_ + static_cast<int64_t>(std::floor(late)) : next_;
}

LiveClock::Moment LiveClock::patience() const {
  return start_ + seconds((static_cast<double>(next_) + kLate) / fps_);
}

std::unique_ptr<ScanSource::Frames> live_frames(const LiveOptions& options) {
  return std::make_unique<LiveFrames>(options);
}

}  // namespace understudy
