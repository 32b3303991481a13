// Where people stand in the views: the offset of a camera that follows one,
// and of those that stand side by side.
#pragma once

#include "app/session/session.hpp"
#include "retarget/editing/scan_edits.hpp"

namespace understudy::app {

/// What is added to the target of a camera: while View::follow is on, the place over the floor of the
/// person's pelvis in that frame, smoothed over half a second both ways; so a target of a following camera is
/// relative to the person. Zero where the view does not follow or the person is not known yet. pane: 0 the
/// source, k the take k - 1. Depends on the frame alone.
Vec3 follow_offset(const Session& session, int pane, int frame);

/// What is added to the target of a camera instead while the pane of a take, whose target is ready, shows
/// the T-pose: that is seen where the person would be. frame: the pane's.
Vec3 rest_offset(const Session& session, int pane, int frame);

/// How far a person stands from its place while the people of an overlay stand side by side, metres; zero in
/// other layouts. pane: 0 the source, k the take k - 1.
Vec3 spread_offset(const Session& session, int pane);

/// Bodies beside each other are so many of their widths apart, from middle to middle.
constexpr float kApart = 1.2f;
/// Of a body as it is seen from the front, and half its length.
float width_of(const Box& box);
/// How far the surface that is painted by bone is from the scan: BoneSurface::Beside to the right of it, by
/// more than its width, metres; else zero.
Vec3 painted_place(const Session& session);
/// How far the second body is from where it performs: to the right of the scan and of that surface, on the
/// found body's floor, metres.
Vec3 second_place(const Session& session);

/// The joints of the person of a pane in a frame, as shown; null where they are not there.
const Joints* pane_joints(const Session& session, int pane, int frame);

}  // namespace understudy::app
