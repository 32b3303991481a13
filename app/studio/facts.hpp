// Named values of the session, as text, for scripts and tests.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/session/session.hpp"

namespace understudy::app {

/// All of them: {"frames", "87"}, {"undo_label", "Drag left wrist"}, ...
std::vector<std::pair<std::string, std::string>> facts(const Session& session);
/// One of them. Throws Error when none has that name.
std::string fact(const Session& session, const std::string& key);
/// The sentences of dialogs, notices and the log.
std::vector<std::string> shown_texts(const Session& session);
/// Whether a fact fulfils a condition: "VALUE", or "= VALUE", "!= VALUE", ">= NUMBER", "<= NUMBER". Throws
/// Error for another comparison.
bool holds(const std::string& value, const std::string& comparison, const std::string& wanted);

}  // namespace understudy::app
