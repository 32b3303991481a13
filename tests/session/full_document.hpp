// A document in which nothing is as it is by default.
#pragma once

#include <string>

#include "app/session/document_file.hpp"

namespace understudy::app {

/// Every member set, paths under `folder`.
SavedDocument full_document(const std::string& folder);

}  // namespace understudy::app
