// What the selected target performs on: its own bones or the 22 joints, which bone is which joint, and what
// was decided when it was read.
// Sections: inspector.rig, inspector.bones. Marks: rig.choice (.0 automatic, .1 own, .2 the 22 joints),
// rig.joint.J (a row a joint), rig.bone (the list for the joint selected: .0 automatic, .1 none, then the
// bones), rig.bone.search, rig.reset.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

void draw_rig(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
