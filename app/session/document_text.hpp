// What documents and their autosaved copies share: JSON to readable text and back.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace understudy::app {

/// Indented, but for lists of numbers.
std::string document_text(const nlohmann::ordered_json& json);
/// Throws Error, one sentence that names `path`: empty, damaged.
nlohmann::ordered_json parse_document(const std::string& text, const std::string& path);
/// Throws Error, one sentence: no such file, too large, damaged.
nlohmann::ordered_json read_document_json(const std::string& path);

}  // namespace understudy::app
