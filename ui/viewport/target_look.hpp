// The parts of a target's look that do not depend on its pose: made once, in the background.
#pragma once

#include <future>
#include <list>
#include <memory>

#include "app/session/frame_cache.hpp"
#include "render/scene.hpp"

namespace understudy::ui {

struct TargetLook {
  render::SharedValues ambient;                   ///< light from all around, in the T-pose; empty for a cloud
  bool closed = false;                            ///< its inside is never visible
  float spacing = 0;                              ///< of a cloud's points, metres
  bool shaded = false;                            ///< `ambient` is made, too
  std::shared_ptr<const app::PosedPicture> rest;  ///< the T-pose as a picture
};

/// Whether a picture of one can be shown as the other: vertices of one number and order, the same faces.
bool same_surface(const Target* a, const Target* b);

/// The looks of the shown targets, each made in a thread of its own. Use from one thread.
class TargetLooks {
 public:
  /// Null at first, then the plain one, then all of it. A target of which only the joints are others has the
  /// look that it had.
  std::shared_ptr<const TargetLook> of(const std::shared_ptr<const Target>& target);
  /// The same for a mesh shown only briefly: it stays plain.
  std::shared_ptr<const TargetLook> plain_of(const std::shared_ptr<const Target>& target);
  /// Drops all but those that are still being made.
  void forget();
  /// Waits for all requested looks.
  void wait();
  /// Grows with every finished look: then there is something new to draw.
  int64_t arrived() const;

 private:
  using Look = std::shared_ptr<const TargetLook>;
  struct Entry {
    std::shared_ptr<const Target> target;
    Look look;
    std::future<Look> plain, shaded;  // still coming
  };
  Entry& entry_of(const std::shared_ptr<const Target>& target);
  void take_in(Entry& entry, bool wait);
  std::list<Entry> entries_;  // the last asked for first
  int64_t taken_in_ = 0;
};

}  // namespace understudy::ui
