// How many threads a computation may have.
#pragma once

namespace understudy {

/// As many as the machine has cores, or fewer where limit_threads said so; at least 1.
int usable_threads();
/// For the whole process, from now on: where several processes share the machine, each keeps to its share.
void limit_threads(int most);

}  // namespace understudy
