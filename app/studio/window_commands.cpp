#include "app/studio/window_commands.hpp"

#include "retarget/base/error.hpp"

namespace understudy::app {

void add_window_commands(Commands& commands, ui::Workspace& workspace) {
  commands.add(
      {"dialog.open", "Open dialog",
       "open|open_scan|open_motion|open_target|replace_target|open_document|save_as|export|csv|picture|"
       "video|compare|settings|about|keys|none",
       "", false, false, [&workspace](Studio& studio, const Arguments& arguments) {
         US_CHECK(arguments.size() == 1, "dialog.open wants the name of a dialog");
         workspace.open_dialog(studio.session(), arguments[0]);
       }});
  commands.add(
      {"help.keys", "All keys", "", "", false, false,
       [&workspace](Studio& studio, const Arguments&) { workspace.open_dialog(studio.session(), "keys"); }});
}

}  // namespace understudy::app
