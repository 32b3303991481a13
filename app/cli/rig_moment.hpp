// A rig in one of its poses, as contact sheets show it.
#pragma once

#include "render/contact_sheet.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy::app {

/// Its skeleton, and the surface painted by its bones; no scan.
render::SheetMoment rig_moment(const RiggedMotion& performed, int frame);

}  // namespace understudy::app
