// Documents to JSON and back, by the members that fields() lists beside each struct.
#include "app/session/document_file.hpp"

namespace understudy::app {
namespace {

constexpr JsonFileKind kKind{"understudy document", "an Understudy document", "documents", kDocumentVersion};

}  // namespace

Json to_json(const SavedDocument& saved, const std::string& folder) {
  Json json{{"format", kKind.format}, {"version", kKind.version}};
  FieldsWriter writer(json, folder, "");
  fields(writer, saved);
  return json;
}

SavedDocument from_json(const Json& json, const std::string& folder, const std::string& path) {
  check_kind(json, path, kKind);
  FieldsReader reader(json, folder, path + ": ");
  SavedDocument saved;
  fields(reader, saved);
  if (saved.view.cameras.empty()) saved.view.cameras.emplace_back();
  return saved;
}

}  // namespace understudy::app
