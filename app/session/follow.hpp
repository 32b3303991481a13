// Where people stand in the views: the offset of a camera that follows one,
// and of those that stand side by side.
#pragma once

#include "app/session/session.hpp"

namespace understudy::app {

/// What is added to the target of a camera: while View::follow is on, the place over the floor of the
/// person's pelvis in that frame, smoothed over half a second both ways; so a target of a following camera is
/// relative to the person. Zero where the view does not follow or the person is not known yet. pane: 0 the
/// source, k the take k - 1. Depends on the frame alone.
Vec3 follow_offset(const Session& session, int pane, int frame);

/// How far a person stands from its place while the people of an overlay stand side by side, metres; zero in
/// other layouts. pane: 0 the source, k the take k - 1.
Vec3 spread_offset(const Session& session, int pane);

/// The joints of the person of a pane in a frame, as shown; null where they are not there.
const Joints* pane_joints(const Session& session, int pane, int frame);

}  // namespace understudy::app
