// A small study for tests; its files need not be there.
#pragma once

#include "app/study/study.hpp"

namespace understudy::tests {

/// Two methods and one set of files ("guest"), two motions, three targets, a question of each kind.
app::Study made_study(const std::string& folder);

}  // namespace understudy::tests
