// How a motion is performed: a stage from skeleton to skeleton, before anything of the target is asked (paper
// 4).
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "retarget/base/fields.hpp"
#include "retarget/pipeline/joint_filter.hpp"
#include "retarget/pipeline/observation.hpp"

namespace understudy {

constexpr Within<float> kStyleStrengths{0, 1.5f};

/// A style, and how much of it.
struct StyleChoice {
  std::string name;      ///< of a style that comes with the program; empty: none, or a file's
  std::string file;      ///< path of a style's file; empty: none
  float strength = 1;    ///< 0: the source as it is, 1: the style, in kStyleStrengths
  float posture = 1;     ///< shares of the strength: how the body is held,
  float size = 1;        ///< how far it moves,
  float liveliness = 1;  ///< how it sways, bounces and looks about
  /// Whether anything is changed.
  bool any() const { return (!name.empty() || !file.empty()) && strength > 0; }
  /// What it is called in commands and reports; empty: none.
  const std::string& called() const { return file.empty() ? name : file; }
  /// A name, or a path: what has a slash or ends in ".json" or ".weights".
  void choose(const std::string& word);
};
template <class V, class S>
FieldsOf<S, StyleChoice> fields(V& visit, S& style) {
  visit("name", style.name);
  visit("file", style.file, FilePath{});
  visit("strength", style.strength, kStyleStrengths);
  visit("posture", style.posture, kStyleStrengths);
  visit("size", style.size, kStyleStrengths);
  visit("liveliness", style.liveliness, kStyleStrengths);
}

/// Changes how the source moves. Frame t stays frame t; where frames are looked at together it comes later.
/// One thread at a time.
class MotionStyle {
 public:
  virtual ~MotionStyle() = default;
  /// The source starts anew.
  virtual void reset() = 0;
  /// A frame that is believed, repaired and smoothed, dt seconds after the one before. Throws Error where it
  /// cannot be styled; there is then no frame for it.
  virtual void push(const Extraction& seen, float dt) = 0;
  /// The next styled frame in the order of push(): exact, and its confidence, visibility and soles go along;
  /// none: it needs more frames, or finish().
  virtual std::optional<Extraction> pop() = 0;
  /// No more frames come: pop() gives all that are left.
  virtual void finish() = 0;
  /// Seconds by which a frame comes later; 0: at once.
  virtual float lag_s() const = 0;
  /// What a file that is made in it has to say of rights; empty where there is nothing to be said.
  const std::string& rights() const { return rights_; }
  void set_rights(std::string rights) { rights_ = std::move(rights); }

 private:
  std::string rights_;
};

/// An observation, dt seconds after the one before.
struct TimedObservation {
  Observation seen;
  float dt = 0;
};

/// One person's observations on their way to a performer: as they came where there is no style, else
/// repaired, smoothed and styled. None is lost, none overtakes another; what is not believed passes as it
/// came. Where nobody is believed for longer than the style's lag it begins anew, and what it held back
/// comes.
class StyledStream {
 public:
  /// `style` may be null. The filter's options are those of the performer.
  explicit StyledStream(std::shared_ptr<MotionStyle> style = nullptr, const JointFilterOptions& filter = {});
  void restart();
  void push(const Observation& seen, float dt);
  std::optional<TimedObservation> pop();
  void finish();
  float lag_s() const { return style_ ? style_->lag_s() : 0; }
  /// The style's.
  std::string rights() const { return style_ ? style_->rights() : ""; }

 private:
  struct Waiting : TimedObservation {
    bool is_styled = false;  // a frame of the style's belongs to it
  };
  std::shared_ptr<MotionStyle> style_;
  UnseenLimbs unseen_;
  JointFilter filter_;
  void settle();

  std::deque<Waiting> waiting_;
  float waited_ = 0;  // seconds since the last frame that the style was given
};

}  // namespace understudy
