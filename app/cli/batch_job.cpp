#include "app/cli/batch_job.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>

#include "app/cli/commands.hpp"
#include "app/cli/flat_job.hpp"
#include "app/run/exports.hpp"
#include "app/run/fields_json.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/version.hpp"
#include "app/session/document_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/base/threads.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// A subcommand, and what only it can say of itself.
struct BatchVerb {
  const char* name;
  Action (*declare)(CLI::App& command);
  bool takes_many;
};
constexpr BatchVerb kVerbs[] = {{"retarget", declare_retarget, false}, {"export", declare_export, true}};

/// What a line says elsewhere, and what no job of a batch can be: endless, or without a file.
const std::set<std::string>& no_options_of_lines() {
  static const std::set<std::string> names = {"source", "target", "help", "follow", "print-map",
                                              "listen", "stream", "wait", "send"};
  return names;
}

/// The report that a job writes where its line wants none: it is read and removed.
constexpr const char* kHiddenReport = ".report.json";

BatchOption batch_option(const CLI::Option& option) {
  BatchOption out;
  out.is_flag = option.get_expected_max() == 0;
  if (option.get_type_name() == kReadPath) out.path = BatchOption::Path::Read;
  if (option.get_type_name() == kWrittenPath) out.path = BatchOption::Path::Written;
  return out;
}

const BatchVerb& verb_of(const BatchJob& job) {
  return *std::find_if(std::begin(kVerbs), std::end(kVerbs),
                       [&](const BatchVerb& verb) { return verb.name == job.command; });
}

/// The options of the line's command, parsed as the command line's are.
class ParsedLine {
 public:
  explicit ParsedLine(const BatchJob& job) : app_("", job.command), action_(verb_of(job).declare(app_)) {}
  BatchOption::Path path_of(const std::string& option) const {
    return batch_option(*app_.get_option("--" + option)).path;
  }
  /// Throws Error.
  int run(std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    try {
      app_.parse(std::move(arguments));
    } catch (const CLI::ParseError& error) {
      throw Error(error.what());
    }
    return action_();
  }

 private:
  CLI::App app_;
  Action action_;
};

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

bool wants(const BatchJob& job, const char* option) {
  return job.options.contains(option) && job.options[option] != false;
}

/// What the job's file is called where its line does not say.
std::string default_output(const BatchJob& job) {
  JobOptions flat;
  if (!job.targets.empty()) flat.target.path = job.targets[0];
  if (job.command == kVerbs[0].name && is_flat_job(flat)) return job.id + ".json";
  if (wants(job, "all-takes")) return job.id;  // a folder
  if (!job.options.contains("format")) return job.id + ".glb";
  const ExportFormat& format = export_format(text_of(job.options["format"]), job.id);
  return format.is_pictures ? job.id : job.id + format.suffix;
}

/// As a user would write them, with outputs in `folder`.
std::vector<std::string> arguments_of(const BatchJob& job, const ParsedLine& line,
                                      const std::string& folder) {
  std::vector<std::string> arguments;
  if (!job.document.empty()) arguments.push_back(fs::absolute(job.document).string());
  for (const std::string& path : job.sources) arguments.push_back("--source=" + path);
  for (const std::string& path : job.targets) arguments.push_back("--target=" + path);
  bool writes = false;
  for (const auto& item : job.options.items()) {
    const std::string option = "--" + item.key() + "=";
    const Json& value = item.value();
    const bool is_written = line.path_of(item.key()) == BatchOption::Path::Written;
    writes = writes || is_written;
    if (!value.is_array()) arguments.push_back(option + (is_written ? folder + "/" : "") + text_of(value));
    if (value.is_array())
      for (const Json& one : value) arguments.push_back(option + text_of(one));
  }
  if (!writes || (verb_of(job).takes_many && !wants(job, "out")))
    arguments.push_back("--out=" + folder + "/" + default_output(job));
  if (!wants(job, "report") && !wants(job, "all-takes"))
    arguments.push_back("--report=" + folder + "/" + kHiddenReport);
  return arguments;
}

/// Paths that a line reads, each once.
std::vector<std::string> paths_read_by(const BatchJob& job) {
  std::vector<std::string> paths = job.sources;
  paths.insert(paths.end(), job.targets.begin(), job.targets.end());
  if (!job.document.empty()) {
    paths.push_back(job.document);
    for (const std::string& path : files_read_by(read_document(job.document).document)) paths.push_back(path);
  }
  const ParsedLine line(job);
  for (const auto& item : job.options.items())
    if (line.path_of(item.key()) == BatchOption::Path::Read && item.key() != "weights" &&
        fs::exists(text_of(item.value())))  // else it is a word, or the job says that it is missing
      paths.push_back(text_of(item.value()));
  std::vector<std::string> once;
  for (const std::string& path : paths)
    if (!path.empty() && std::find(once.begin(), once.end(), path) == once.end()) once.push_back(path);
  return once;
}

/// Figures of one report of `retarget` or `export`.
Json result_of(const Json& report) {
  Json result = Json::object(), metrics = report.value("metrics", Json::object());
  const Json cost = report.value("cost", Json::object());
  const Json source = report.value("source", Json());
  const Json& counted = cost.contains("frames") ? cost : source.is_object() ? source : report;
  result["frames"] = counted.value("frames", Json());
  result["flagged"] = report.value("flagged", Json());
  result["doubt"] = report.value("doubt", Json::object());
  for (const auto& item : cost.items())
    if (item.key() != "frames") metrics["file_" + item.key()] = item.value();
  result["metrics"] = metrics;
  return result;
}

/// Of the report, or of one for each person: "report-2.json". Those that nobody asked for are removed.
Json read_results(const std::string& folder, const std::string& name) {
  const fs::path whole(name);
  const std::string stem = whole.stem().string() + "-", suffix = whole.extension().string();
  std::map<int64_t, std::string> reports;  // by person; 0: of the only one
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    int64_t person = 0;
    if (file == name) reports[0] = file;
    if (starts_with(file, stem) && ends_with(file, suffix) && file.size() > stem.size() + suffix.size() &&
        parse_integer(file.substr(stem.size(), file.size() - stem.size() - suffix.size()), person))
      reports[person] = file;
  }
  Json results = Json::array();
  for (const auto& [person, file] : reports) {
    Json result = Json::object();
    if (person > 0) result["person"] = person;
    result.update(result_of(read_json(folder + "/" + file)));
    results.push_back(result);
    if (name == kHiddenReport) fs::remove(folder + "/" + file);
  }
  return results;
}

/// A sentence without the folder that nobody will find any more.
std::string without(std::string text, const std::string& folder) {
  for (size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
    text.erase(at, folder.size());
  return text;
}

void be_silent() {
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {0, 1, 2}) ::dup2(nowhere, stream);
  ::close(nowhere);
}

}  // namespace

std::vector<BatchCommand> batch_commands() {
  std::vector<BatchCommand> commands;
  for (const BatchVerb& verb : kVerbs) {
    CLI::App app("", verb.name);
    const Action declared = verb.declare(app);
    BatchCommand command{verb.name, {}, verb.takes_many};
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames())
        if (no_options_of_lines().count(name) == 0) command.options[name] = batch_option(*option);
    commands.push_back(std::move(command));
  }
  return commands;
}

BatchWorker::BatchWorker(const Manifest& manifest, const ResultFolder& results)
    : manifest_(manifest), results_(results), work_(results) {
  only_remember(SIGTERM);
  only_remember(SIGINT);
  limit_threads(1);
  fs::current_path(manifest.folder);
  log::set_sink([this](log::Level level, const std::string& message) {
    if (level == log::Level::Warning) warnings_.push_back(message);
  });
  be_silent();
}

BatchWorker::~BatchWorker() {
  log::set_sink({});
}

JobEnd BatchWorker::run(size_t job) {
  if (interrupted()) return JobEnd::Stopped;
  const BatchJob& line = manifest_.jobs[job];
  warnings_ = Json::array();
  JobEnd end = JobEnd::Failed;
  const std::string problem = failure_of([&] { end = attempt(line); });
  if (problem.empty()) return end;
  if (interrupted()) return JobEnd::Stopped;
  results_.tell_failure(line, without(problem, work_.folder(line.id) + "/"), warnings_);
  return JobEnd::Failed;
}

JobEnd BatchWorker::attempt(const BatchJob& job) {
  const auto began = std::chrono::steady_clock::now();
  if (const auto before = read_done(results_.done_path(job.id)); before && is_done(job, *before)) {
    results_.forget_failure(job.id);
    return JobEnd::Skipped;
  }
  DoneRecord record = begin(job);
  const std::string folder = work_.begin(job.id);
  ParsedLine line(job);
  const int code = line.run(arguments_of(job, line, folder));
  US_CHECK(code == 0, warnings_.empty() ? std::string("it ended with an error") : text_of(warnings_.back()));
  if (!wants(job, "all-takes"))
    record.results =
        read_results(folder, wants(job, "report") ? text_of(job.options["report"]) : kHiddenReport);
  for (const Json& warning : warnings_) record.warnings.push_back(without(text_of(warning), folder + "/"));
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  work_.publish(std::move(record));
  return JobEnd::Done;
}

DoneRecord BatchWorker::begin(const BatchJob& job) {
  DoneRecord record;
  record.id = job.id;
  record.program = kProgram;
  record.job = to_json(job);
  for (const std::string& path : paths_read_by(job)) record.inputs.push_back(record_input(path));
  record.weights = weights_in(job);
  return record;
}

bool BatchWorker::is_done(const BatchJob& job, const DoneRecord& before) {
  if (before.program != kProgram || before.job != to_json(job) || before.weights != weights_in(job))
    return false;
  const std::vector<std::string> paths = paths_read_by(job);
  const auto same = [](const std::string& path, const InputRecord& record) {
    return path == record.path && is_as_recorded(record);
  };
  return std::equal(paths.begin(), paths.end(), before.inputs.begin(), before.inputs.end(), same) &&
         results_.has_outputs(before);
}

const std::string& BatchWorker::weights_in(const BatchJob& job) {
  nn::NetworkOptions options;
  if (job.options.contains("weights")) options.weights = text_of(job.options["weights"]);
  const std::string folder = nn::weights_folder(options);
  const auto [found, fresh] = weights_.try_emplace(folder);
  if (fresh) found->second = report_header(folder)["weights"].get<std::string>();
  return found->second;
}

}  // namespace understudy::app
