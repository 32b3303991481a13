// Input events as lines of a script, and back: the lines of a recording.
#pragma once

#include "app/session/commands.hpp"
#include "render/camera.hpp"
#include "render/context/input_event.hpp"

namespace understudy::app {

/// A finite number. Throws Error when the text is not one.
float number_of(const std::string& text);
/// "1920x1080". Throws Error when the text is no such size.
render::PixelSize size_of(const std::string& text);

/// "move 12 30", "button left down 12 30 ctrl shift", "scroll 0 -1 12 30", "key Z down ctrl", "char 97",
/// "focus off", "drop 12 30 /a/scan"; empty for sizes and closing, which are the recorder's.
Arguments event_words(const render::InputEvent& event);
/// Throws Error saying what is wrong with them.
render::InputEvent event_of_words(const Arguments& words);

}  // namespace understudy::app
