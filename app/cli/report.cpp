#include "app/cli/report.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <set>

#include "app/cli/commands.hpp"
#include "app/cli/worst_frames.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables[] = {"baselines", "seen",      "contexts", "rotation", "extraction",
                                   "offsets",   "inbetween", "predict",  "sparse"};

/// Calls visit(key, member) for all that the file may have of a row and that its results follow from as it
/// is.
template <class Row, class Visit>
void each_result_key(Row& row, Visit visit) {
  auto& method = row.eval.how.method;
  visit("table", row.table);
  visit("name", row.name);
  visit("breakdown", row.breakdown);
  visit("engine", method.engine);
  visit("extractor", method.extractor);
  visit("offsets", method.offsets);
  for (const MethodSwitch& one : kSwitches) visit(MemberName(one.name, one.old_name), method.*one.on);
  visit("predict", method.predict);
  visit("oracle", row.eval.oracle);
  visit("baseline", row.eval.baseline);
  visit("fill", row.eval.fill);
  visit("context", row.eval.restart_every);
  visit("limit", row.eval.limit);
}

/// The same for all that the file may have of a row.
template <class Visit>
void each_key(ReportRow& row, Visit visit) {
  each_result_key(row, visit);
  visit("suite", row.suite);
  visit("budget", row.budget);
  visit("weights", row.eval.how.weights);
  visit("engine_weights", row.eval.how.engine_file);
  visit("extractor_weights", row.eval.how.extractor_file);
}

ReportRow row_from(const Json& json, const fs::path& folder) {
  ReportRow row;
  std::set<std::string> known;
  each_key(row, [&](const MemberName& key, const auto&) {
    known.insert(key.now);
    if (key.before != nullptr) known.insert(key.before);
  });
  for (const auto& item : json.items())
    US_CHECK(known.count(item.key()) > 0, "a row has \"", item.key(), "\", which is unknown");
  for (const char* key : {"table", "name", "suite"}) json.at(key);  // these must be there
  each_key(row, [&](const MemberName& key, auto& member) {
    for (const char* name : {key.before, key.now})
      if (name != nullptr && json.contains(name)) json.at(name).get_to(member);
  });
  US_CHECK(std::find(std::begin(kTables), std::end(kTables), row.table) != std::end(kTables),
           "there is no table \"", row.table, "\"");
  MethodOptions& how = row.eval.how;
  how.engine_is_asked = json.contains("engine");
  if (index_of(flat_engines(), how.method.engine) < 0)
    engine_named(how.method.engine);  // throws where none is
  extractor_named(how.method.extractor);
  motion_space_named(row.eval.fill);
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
  US_CHECK(!plan.rows.empty(), path, ": has no rows");
  return plan;
}

namespace {

struct ReportOptions {
  std::string cases, out, rows, weights, body, data;
  std::vector<std::string> tables;
  int limit = 0;       ///< cases a row; 0: as in the rows
  bool again = false;  ///< evaluate also what was evaluated before
};

/// A file's name and what is in it.
std::string marked(const std::string& file) {
  return fs::exists(file) ? file + ":" + checksum(file) : file;
}

/// When the newest of a suite's cases was written, in the file clock's ticks.
int64_t made(const std::string& cases) {
  int64_t newest = 0;
  for (const std::string& folder : case_folders(cases))
    for (const char* file : {"case.json", "truth.npz"})
      if (std::error_code missing; fs::exists(folder + "/" + file, missing))
        newest =
            std::max<int64_t>(newest, fs::last_write_time(folder + "/" + file).time_since_epoch().count());
  return newest;
}

/// What a row is, for recognising its results of an earlier run. Sorted: its keys compare in any order.
nlohmann::json identity(const ReportRow& row) {
  const EvalOptions& e = row.eval;
  nlohmann::json known = {{"cases", e.cases},
                          {"made", made(e.cases)},
                          {"weights", report_header(nn::weights_folder(network_options(e.how)))["weights"]},
                          {"files", {marked(e.how.engine_file), marked(e.how.extractor_file)}},
                          {"body", e.baseline == "fit" ? marked(e.body) : ""},
                          {"data", motion_space_named(e.fill).needs_clips ? e.data : ""}};
  each_result_key(row, [&](const char* key, const auto& member) { known[key] = member; });
  return known;
}

std::string file_of(const ReportOptions& options, const ReportRow& row) {
  std::string name = row.table + "_" + row.name + "_" + row.suite;
  if (row.eval.restart_every > 0) name += "_" + std::to_string(row.eval.restart_every);
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return options.out + "/rows/" + name + ".json";
}

Json read_json(const std::string& path) {
  return fs::exists(path) ? Json::parse(read_file(path), nullptr, false) : Json();
}

ReportResult result_of(const ReportOptions& options, ReportRow row) {
  ReportResult result{std::move(row), {}, ""};
  const std::string file = file_of(options, result.row);
  const Json before = read_json(file);
  const nlohmann::json known = identity(result.row);
  if (!options.again && before.is_object() && nlohmann::json(before.value("row", Json())) == known) {
    result.report = before;
    return result;
  }
  result.lost = failure_of([&] {
    const Evaluation evaluation = evaluate(result.row.eval, [](const CaseResult&) {});
    for (const CaseResult& one : evaluation.results) US_CHECK(one.error.empty(), one.name, ": ", one.error);
    result.report = report_of(result.row.eval, evaluation);
    result.report["row"] = known;
    if (result.row.breakdown) result.report["confidence_record"] = to_json(evaluation.breakdown.confidence());
    write_json(file, result.report);
    if (result.row.breakdown && !evaluation.breakdown.worst().empty()) {
      const std::string pictures = options.out + "/worst_" + result.row.suite;
      write_worst_frames(pictures, evaluation.breakdown.worst());
      fs::copy_file(pictures + "/worst.png", pictures + ".png", fs::copy_options::overwrite_existing);
    }
  });
  check_interrupt("in row " + result.row.name);
  return result;
}

ReportPlan chosen_rows(const ReportOptions& options) {
  nn::NetworkOptions weights;
  weights.weights = options.weights;
  const std::string path =
      options.rows.empty() ? nn::weights_folder(weights) + "/comparison.json" : options.rows;
  ReportPlan plan = read_report_plan(path);
  std::vector<ReportRow> chosen;
  for (ReportRow& row : plan.rows) {
    const bool wanted = options.tables.empty() || std::find(options.tables.begin(), options.tables.end(),
                                                            row.table) != options.tables.end();
    if (!wanted) continue;
    row.eval.cases = (fs::path(options.cases) / row.suite).string();
    row.eval.body = options.body;
    row.eval.data = options.data;
    if (row.eval.how.weights.empty()) row.eval.how.weights = options.weights;
    if (options.limit > 0)
      row.eval.limit = row.eval.limit > 0 ? std::min(row.eval.limit, options.limit) : options.limit;
    chosen.push_back(std::move(row));
  }
  US_CHECK(!chosen.empty(), "none of the rows belongs to these tables");
  return {std::move(plan.note), std::move(chosen)};
}

std::string command_of(const ReportOptions& options) {
  std::string command = "understudy report --cases CASES --out OUT";
  if (!options.rows.empty()) command += " --rows " + fs::path(options.rows).filename().string();
  if (!options.body.empty()) command += " --body BODY.npz";
  if (!options.data.empty()) command += " --data DATA";
  for (const std::string& table : options.tables)
    command += (&table == &options.tables[0] ? " --tables " : ",") + table;
  if (options.limit > 0) command += " --limit " + std::to_string(options.limit);
  return command;
}

int report(const ReportOptions& options) {
  US_CHECK(fs::is_directory(options.cases), options.cases, ": not a folder of suites");
  const ReportPlan plan = chosen_rows(options);
  fs::create_directories(options.out + "/rows");
  std::vector<ReportResult> results;
  for (const ReportRow& row : plan.rows) {
    results.push_back(result_of(options, row));
    std::printf("%s, %s, %s%s: %s\n", row.table.c_str(), row.suite.c_str(), row.name.c_str(),
                row.eval.restart_every > 0 ? (" " + std::to_string(row.eval.restart_every)).c_str() : "",
                results.back().lost.empty() ? "done" : results.back().lost.c_str());
    std::fflush(stdout);
    write_report_page(options.out, results, command_of(options), plan.note);
  }
  std::printf("wrote %s/report.md\n", options.out.c_str());
  return std::any_of(results.begin(), results.end(), [](const auto& result) { return !result.lost.empty(); })
             ? 1
             : 0;
}

}  // namespace

Action declare_report(CLI::App& command) {
  const auto options = std::make_shared<ReportOptions>();
  command
      .add_option("--cases", options->cases,
                  "folder of the suites that the rows name: naked/, captured/, ...")
      ->required();
  command.add_option("--out", options->out, "folder for report.md, its plots and the figures of each row")
      ->required();
  command.add_option("--rows", options->rows,
                     "JSON that lists the rows (default: comparison.json beside the weights)");
  command
      .add_option("--tables", options->tables,
                  "only these tables: baselines, seen, contexts, rotation, extraction, offsets, inbetween, "
                  "predict, sparse")
      ->delimiter(',');
  command.add_option("--weights", options->weights, "folder of the weights (default: beside the program)");
  command.add_option("--body", options->body, "the SMPL-format body that the baseline fits");
  command.add_option("--data", options->data,
                     "the folder of people and motions that rows filled by \"nearest\" look into");
  command.add_option("--limit", options->limit, "limit of cases per row")->check(CLI::NonNegativeNumber);
  command.add_flag("--again", options->again, "evaluates rows again that already have figures");
  return [options] { return report(*options); };
}

}  // namespace understudy::app
