// picture.save and video.save: jobs that draw apart from the window.
#pragma once

#include "app/session/studio.hpp"

namespace understudy::app {

void add_picture_commands(Commands& commands);

}  // namespace understudy::app
