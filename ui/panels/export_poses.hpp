// Rows of the export dialog about pose pictures and 2D poses.
// Marks: export.as, export.camera, export.reference, export.canvas, export.rate, export.count, export.points,
// export.stick_width, export.hide_limbs, export.hide_face, export.face, export.pose_file, export.depth,
// export.normals, export.mask.
#pragma once

#include <array>

#include "ui/panels/export.hpp"

namespace understudy::ui {

/// What a flat take is written as, in the order of the choices: a film, pictures, ControlNet's JSON,
/// a table, an array.
constexpr std::array<const char*, 5> kFlatSuffixes = {".mp4", "", ".json", ".csv", ".npz"};

/// Of a take in space, through a camera. Opens the browser where the user wants to choose a reference.
void draw_pose_rows(const app::Session& session, PanelContext& context, ExportState& state,
                    FilesState& files);
/// Of a flat take. True when its suffix has changed.
bool draw_flat_rows(Ui& ui, ExportState& state);
/// What was chosen that is not usual, as words of export.run. is_flat: of a flat take.
app::Arguments pose_words(const app::ExportChoice& choice, bool is_flat);

}  // namespace understudy::ui
