// Ctrl-C: remembered by the signal handler, asked for between frames, so that nothing is left half written.
#pragma once

#include <string>

namespace understudy::app {

/// From now on Ctrl-C and a termination request are only remembered. The second one ends the process at once.
void catch_interrupts();
/// From now on this signal is remembered however often it comes: schedulers send it to every process of a
/// job, some more than once.
void only_remember(int signal);
bool interrupted();
/// Throws Error, "interrupted after frame 12; nothing was written", once Ctrl-C was pressed.
void check_interrupt(const std::string& where);

}  // namespace understudy::app
