#include "app/cli/report_rows.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "app/run/report.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables[] = {"peers", "contexts", "rotation", "extraction", "offsets"};
constexpr const char* kKeys[] = {"table",   "name",           "suite",
                                 "budget",  "engine",         "extractor",
                                 "weights", "engine_weights", "extractor_weights",
                                 "offsets", "foot_lock",      "oracle",
                                 "peer",    "context",        "limit"};

ReportRow row_from(const Json& json, const fs::path& folder) {
  for (const auto& item : json.items())
    US_CHECK(std::find(std::begin(kKeys), std::end(kKeys), item.key()) != std::end(kKeys), "a row has \"",
             item.key(), "\", which is not known");
  const auto file = [&](const char* key) {
    const std::string path = json.value(key, "");
    return path.empty() ? path : (folder / path).lexically_normal().string();
  };
  ReportRow row;
  row.table = json.at("table");
  row.name = json.at("name");
  row.suite = json.at("suite");
  US_CHECK(std::find(std::begin(kTables), std::end(kTables), row.table) != std::end(kTables),
           "there is no table \"", row.table, "\"");
  row.budget = json.value("budget", "");
  row.eval.networks.engine = json.value("engine", "copy");
  row.eval.networks.extractor = json.value("extractor", "dense");
  row.eval.networks.weights = file("weights");
  row.eval.networks.engine_file = file("engine_weights");
  row.eval.networks.extractor_file = file("extractor_weights");
  row.eval.networks.offsets = json.value("offsets", true);
  row.eval.retarget.lock_feet = json.value("foot_lock", true);
  row.eval.oracle = json.value("oracle", "");
  row.eval.peer = json.value("peer", "");
  row.eval.restart_every = json.value("context", 0);
  row.eval.limit = json.value("limit", 0);
  return row;
}

ReportRow row(const std::string& table, const std::string& name, const std::string& suite) {
  ReportRow made;
  made.table = table;
  made.name = name;
  made.suite = suite;
  return made;
}

}  // namespace

std::vector<ReportRow> read_report_rows(const std::string& path) {
  std::ifstream in(path);
  US_CHECK(in, path, ": cannot be read");
  const Json json = Json::parse(in, nullptr, false);
  US_CHECK(json.is_object() && json.contains("rows") && json["rows"].is_array(), path,
           ": not a JSON object with \"rows\"");
  std::vector<ReportRow> rows;
  try {
    for (const Json& one : json["rows"]) rows.push_back(row_from(one, fs::path(path).parent_path()));
  } catch (const std::exception& wrong) {
    throw Error(path + ": " + wrong.what());
  }
  US_CHECK(!rows.empty(), path, ": holds no row");
  return rows;
}

std::vector<ReportRow> standard_rows() {
  std::vector<ReportRow> rows;
  for (const char* suite : {"naked", "clothed", "captured"}) {
    for (const char* engine : {"copy", "paper", "hybrid"}) {
      rows.push_back(row("peers", engine, suite));
      rows.back().eval.networks.engine = engine;
    }
    rows.push_back(row("peers", "fit", suite));
    rows.back().eval.peer = "fit";
    rows.back().eval.limit = 2;
  }
  for (const char* engine : {"copy", "paper"})
    for (const int context : {5, 10, 15, 20, 30, 60}) {
      rows.push_back(row("contexts", engine, "naked"));
      rows.back().eval.networks.engine = engine;
      rows.back().eval.restart_every = context;
    }
  for (const char* suite : {"extraction", "captured"})
    for (const char* extractor : {"dense", "paper", "pointnet"}) {
      rows.push_back(row("extraction", extractor, suite));
      rows.back().eval.networks.extractor = extractor;
    }
  for (const bool offsets : {true, false}) {
    rows.push_back(row("offsets", offsets ? "on, true poses" : "off, true poses", "naked"));
    rows.back().eval.networks.offsets = offsets;
    rows.back().eval.oracle = "pose";
  }
  return rows;
}

}  // namespace understudy::app
