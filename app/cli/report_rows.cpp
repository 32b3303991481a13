#include "app/cli/report_rows.hpp"

#include <algorithm>
#include <filesystem>

#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables[] = {"baselines", "seen", "contexts", "rotation", "extraction", "offsets"};
constexpr const char* kKeys[] = {"table",
                                 "name",
                                 "suite",
                                 "budget",
                                 "engine",
                                 "extractor",
                                 "weights",
                                 "engine_weights",
                                 "extractor_weights",
                                 "offsets",
                                 "foot_lock",
                                 "oracle",
                                 "baseline",
                                 "context",
                                 "limit",
                                 "breakdown",
                                 "near"};

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
  row.breakdown = json.value("breakdown", false);
  row.eval.how.method.engine = engine_named(json.value("engine", engines().front().name)).name;
  row.eval.how.method.extractor = extractor_named(json.value("extractor", extractors().front().name)).name;
  row.eval.how.weights = file("weights");
  row.eval.how.engine_file = file("engine_weights");
  row.eval.how.extractor_file = file("extractor_weights");
  row.eval.how.method.near = json.value("near", true);
  row.eval.how.method.offsets = json.value("offsets", true);
  row.eval.how.method.lock_feet = json.value("foot_lock", true);
  row.eval.oracle = json.value("oracle", "");
  row.eval.baseline = json.value("baseline", "");
  row.eval.restart_every = json.value("context", 0);
  row.eval.limit = json.value("limit", 0);
  return row;
}

}  // namespace

ReportPlan read_report_plan(const std::string& path) {
  const Json json = Json::parse(read_file(path), nullptr, false);
  US_CHECK(json.is_object() && json.contains("rows") && json["rows"].is_array(), path,
           ": not a JSON object with \"rows\"");
  ReportPlan plan;
  try {
    plan.note = json.value("note", "");
    for (const Json& one : json["rows"]) plan.rows.push_back(row_from(one, fs::path(path).parent_path()));
  } catch (const std::exception& wrong) {
    throw Error(path + ": " + wrong.what());
  }
  US_CHECK(!plan.rows.empty(), path, ": holds no row");
  return plan;
}

}  // namespace understudy::app
