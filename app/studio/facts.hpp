// What scripts and tests may ask the session: named values as text.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/session/session.hpp"

namespace understudy::app {

/// All of them: {"frames", "87"}, {"undo_label", "Drag left wrist"}, ...
std::vector<std::pair<std::string, std::string>> facts(const Session& session);
/// One of them. Throws Error when there is none of that name.
std::string fact(const Session& session, const std::string& key);
/// Whether a fact is what is wanted: "VALUE", or "= VALUE", "!= VALUE", ">= NUMBER", "<= NUMBER". Throws
/// Error for another comparison.
bool holds(const std::string& value, const std::string& comparison, const std::string& wanted);

}  // namespace understudy::app
