// What a written GLB or glTF file shows, as a contact sheet.
#pragma once

#include <string>
#include <vector>

#include "app/run/exports.hpp"

namespace understudy::app {

/// Six moments of the first clip as the file has them, and how all who perform in it stand in the T-pose, as
/// a PNG. by: who performs, for its title. Throws Error.
void write_file_preview(const std::string& preview, const std::string& file,
                        const std::vector<ExportInput>& performers, const std::string& by);

}  // namespace understudy::app
