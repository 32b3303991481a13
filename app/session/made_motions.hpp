// Which further motions of the found body are shown, when and where; whether more can be made.
#pragma once

#include "app/session/session.hpp"

namespace understudy::app {

/// Throws Error where such motions cannot be made now, one sentence. between: frames of the source.
void check_making(const Session& session, const GenerationOptions& how);

/// One that is drawn in the view.
struct ShownMotion {
  std::shared_ptr<const GeneratedMotion> made;
  int clip = -1;                  ///< of the document; -1: it is offered
  const RigPose* pose = nullptr;  ///< in the frame shown, the playhead's rounds counted
  Vec3 place = Vec3::Zero();      ///< how far it is from where it goes: to the left of the scan
  uint64_t seed() const { return made->seed; }
};
/// Those that are offered and were not kept, after the document's clips. frame: of the source. Nothing where
/// that is none of the found rig's, or View::made_motions is off.
std::vector<ShownMotion> shown_motions(const Session& session, int frame);

/// The kept clip that the second body performs; null: it performs what was found, or the clip is not made.
std::shared_ptr<const GeneratedMotion> performed_clip(const Session& session);
/// Which of its poses the second body has in a frame of the source; of a clip as ShownMotion::pose. -1: none.
int second_pose(const Session& session, int frame);

/// The clip that was kept of such a motion; -1: none was.
int clip_of(const Document& document, const GenerationOptions& how);

}  // namespace understudy::app
