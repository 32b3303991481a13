// The commands picture.save and video.save: jobs that draw off screen.
#pragma once

#include "app/session/studio.hpp"

namespace understudy::app {

void add_picture_commands(Commands& commands);

}  // namespace understudy::app
