#include "app/run/tempo_choice.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

/// None: "body".
std::optional<double> number_of(const TempoChoice& choice) {
  if (choice.tempo == "body") return std::nullopt;
  double length = 0;
  US_CHECK(parse_number(choice.tempo, length) && length >= static_cast<double>(kTempoLengths.low) &&
               length <= static_cast<double>(kTempoLengths.high),
           "--tempo ", choice.tempo, ": must be body, off, or how many times as long it lasts, ",
           kTempoLengths.low, " to ", kTempoLengths.high);
  return length;
}

}  // namespace

void check(const TempoChoice& choice) {
  if (choice.any()) number_of(choice);
  US_CHECK(choice.any() || choice.delay_s <= 0, "--delay is of a tempo: give --tempo, too");
}

TempoStream::TempoStream(const TempoChoice& choice, const Joints& rest, double fps)
    : choice_(choice), rest_(rest), step_(1 / fps) {
  check(choice_);
  if (choice_.any() && choice_.delay_s > 0) live_.emplace(static_cast<float>(choice_.delay_s));
}

double TempoStream::wanted_length() const {
  if (!choice_.any()) return 1;
  const std::optional<double> number = number_of(choice_);
  if (number || leg_source_.empty()) return number.value_or(1);
  return static_cast<double>(body_tempo(leg_length(rest_), leg_source_.value()));
}

PerformedFrame TempoStream::between(const PerformedFrame& before, const PerformedFrame& after,
                                    float share) const {
  PerformedFrame frame = share < 0.5f ? before : after;
  frame.pose = pose_between(before.pose, after.pose, share);
  frame.joints = forward_kinematics(rest_, frame.pose).joints;
  if (before.vertices.rows() == after.vertices.rows())
    frame.vertices = (1 - share) * before.vertices + share * after.vertices;
  return frame;
}

/// What lies so far behind the newest.
PerformedFrame TempoStream::shown(float behind_s) const {
  const double frames =
      std::max(0.0, static_cast<double>(ssize(last_) - 1) - static_cast<double>(behind_s) / step_);
  const auto before = static_cast<size_t>(frames);
  if (before + 1 >= last_.size()) return last_.back();
  return between(last_[before], last_[before + 1], static_cast<float>(frames - static_cast<double>(before)));
}

std::vector<PerformedFrame> TempoStream::push(const PerformedFrame& frame) {
  if (!frame.flagged) leg_source_.push(leg_length(source_joints(frame)));
  std::vector<PerformedFrame> out;
  if (live_) {
    last_.push_back(frame);
    const float behind =
        live_->push(frame.joints, static_cast<float>(step_), static_cast<float>(wanted_length()));
    out.push_back(shown(behind));
    const auto needed = static_cast<size_t>(static_cast<double>(behind) / step_) + 3;
    while (last_.size() > needed) last_.pop_front();
    return out;
  }
  if (!choice_.any() || last_.empty()) {
    out.push_back(frame);
    ++out_;
  } else {
    const double before = at_;
    at_ += step_ * wanted_length();
    for (; static_cast<double>(out_) * step_ <= at_ + 1e-9; ++out_)
      out.push_back(
          between(last_.back(), frame,
                  static_cast<float>((static_cast<double>(out_) * step_ - before) / (at_ - before))));
  }
  last_.assign(1, frame);
  return out;
}

std::vector<PerformedFrame> TempoStream::finish() {
  std::vector<PerformedFrame> left;
  if (last_.empty() || !choice_.any()) return left;
  if (!live_) {  // nothing is cut off at the end
    if (static_cast<double>(out_ - 1) * step_ < at_ - 1e-6) left.push_back(last_.back());
    return left;
  }
  while (live_->behind_s() > 0) left.push_back(shown(live_->finish(static_cast<float>(step_))));
  return left;
}

}  // namespace understudy::app
