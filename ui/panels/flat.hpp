// Sections of the inspector about 2D poses: the source's track, and the person in a picture who performs it.
// Marks: source.person, flat.ahead, flat.smoothing, flat.exchange, flat.edits_clear, flat.edit.K;
// inspector.proportions, inspector.manner (sections), flat.length.BONE, flat.lock.BONE, flat.bar.BONE,
// flat.smaller, flat.larger, flat.lengths_clear, flat.load, flat.save, flat.cure, flat.place, flat.touches,
// flat.engine, flat.reference.
#pragma once

#include <string>
#include <vector>

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// Of a source that is 2D poses, in place of what scans have.
void draw_flat_source(const app::Session& session, PanelContext& context);
/// Of the current take, which is flat.
void draw_flat_take(const app::Session& session, PanelContext& context);

/// "Frame 7: left wrist moved".
std::string edit_words(const TrackEdit& edit);

/// Which lengths of a person are uncertain and what would tell, a sentence each: "Forearms are uncertain:
/// seen end-on in the one picture. One in which they lie across the view would tell." Empty: none is.
std::vector<std::string> cures_of(const app::FlatReference& reference);

}  // namespace understudy::ui
