#include "app/studio/window_commands.hpp"

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {

void add_window_commands(Commands& commands, ui::Workspace& workspace) {
  commands.add(
      {"dialog.open", "Open dialog",
       "open|open_scan|open_motion|open_target|replace_target|open_document|save_as|export|csv|picture|"
       "video|compare|settings|about|keys|none"},
      [&workspace](Call& c) {
        US_CHECK(c.arguments.size() == 1, "dialog.open wants the name of a dialog");
        workspace.open_dialog(c.session, c.arguments[0]);
      });
  commands.add({"help.keys", "All keys"},
               [&workspace](Call& c) { workspace.open_dialog(c.session, "keys"); });
}

}  // namespace understudy::app
