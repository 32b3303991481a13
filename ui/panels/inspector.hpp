// What is open and how it is done: the source, the takes, their target and method.
// Marks: inspector.source, .takes, .target, .method (sections); source.fps, source.units, source.up,
// source.yaw, source.floor, source.extractor, source.open, source.motion; take.K (its row), take.name,
// take.remove, take.add, take.replace; target.units, target.up, target.yaw, target.betas; method.engine,
// method.extractor, method.offsets, method.root, method.swaps, method.smooth, method.lengths, method.compare,
// work.pause, work.resume, work.restart.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

void draw_inspector(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
