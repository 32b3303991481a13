// Where a test's program was when it crashed: what fails once in a hundred runs, elsewhere, leaves no
// other trace.
#pragma once

namespace understudy::app {

/// From now on a fatal signal prints its name, the address it is about and the calls that led there (resolve
/// them by addr2line), and then ends the program as it would have. Sanitizers have their own: nothing then.
void tell_where_it_crashes();

}  // namespace understudy::app
