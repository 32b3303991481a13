// What of a target's looks does not change with its pose: made once, in the background.
#pragma once

#include <future>
#include <list>
#include <memory>

#include "app/session/frame_cache.hpp"
#include "render/scene.hpp"

namespace understudy::ui {

struct TargetLook {
  render::SharedValues ambient;  ///< light from all around, in the T-pose; empty for a cloud
  bool closed = false;           ///< its inside is never seen
  float spacing = 0;             ///< of a cloud's points, metres
  app::PosedPicture rest;        ///< the T-pose as a picture
};

/// Whether every edge has a face on either side, so that the inside cannot be seen.
bool is_closed(const Faces& faces);
/// All of it; takes about a quarter of a second for 13,000 vertices.
TargetLook look_of(const Target& target);

/// Whether a picture of one can be shown as the other: vertices of one number and order, the same faces.
bool same_surface(const Target* a, const Target* b);

/// The looks of the targets shown, each made on a thread of its own. Use from one thread.
class TargetLooks {
 public:
  /// Null while it is being made. A target of which only the joints are others has the look that it had.
  std::shared_ptr<const TargetLook> of(const std::shared_ptr<const Target>& target);
  /// Waits for all that were asked for.
  void wait();

 private:
  struct Entry {
    std::shared_ptr<const Target> target;
    std::shared_ptr<const TargetLook> look;
    std::future<std::shared_ptr<const TargetLook>> coming;
  };
  static void take_in(Entry& entry, bool wait);
  std::list<Entry> entries_;  // the last asked for first
};

}  // namespace understudy::ui
