#include "app/cli/report_rows.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables[] = {"baselines", "seen", "contexts", "rotation", "extraction", "offsets"};
/// Calls visit(key, member) for all that the file may have of a row.
template <class Visit>
void each_key(ReportRow& row, Visit visit) {
  MethodOptions& how = row.eval.how;
  visit("table", row.table);
  visit("name", row.name);
  visit("suite", row.suite);
  visit("budget", row.budget);
  visit("breakdown", row.breakdown);
  visit("engine", how.method.engine);
  visit("extractor", how.method.extractor);
  visit("weights", how.weights);
  visit("engine_weights", how.engine_file);
  visit("extractor_weights", how.extractor_file);
  visit("near", how.method.near);
  visit("offsets", how.method.offsets);
  visit("foot_lock", how.method.lock_feet);
  visit("oracle", row.eval.oracle);
  visit("baseline", row.eval.baseline);
  visit("context", row.eval.restart_every);
  visit("limit", row.eval.limit);
}

ReportRow row_from(const Json& json, const fs::path& folder) {
  ReportRow row;
  std::set<std::string> known;
  each_key(row, [&](const char* key, const auto&) { known.insert(key); });
  for (const auto& item : json.items())
    US_CHECK(known.count(item.key()) > 0, "a row has \"", item.key(), "\", which is not known");
  for (const char* key : {"table", "name", "suite"}) json.at(key);  // these must be there
  each_key(row, [&](const char* key, auto& member) {
    if (json.contains(key)) json.at(key).get_to(member);
  });
  US_CHECK(std::find(std::begin(kTables), std::end(kTables), row.table) != std::end(kTables),
           "there is no table \"", row.table, "\"");
  MethodOptions& how = row.eval.how;
  engine_named(how.method.engine);  // throw where there is none
  extractor_named(how.method.extractor);
  for (std::string* path : {&how.weights, &how.engine_file, &how.extractor_file})
    if (!path->empty()) *path = (folder / *path).lexically_normal().string();
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
