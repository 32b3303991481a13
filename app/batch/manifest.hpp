// The list of a batch's jobs: JSON Lines, a job a line, all of it checked before the first one begins.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/run/report.hpp"

namespace understudy::app {

/// What a line may say of one option of a subcommand.
struct BatchOption {
  enum class Path { None, Read, Written };
  bool is_flag = false;    ///< true or false; others are a text, a number or a list of them
  Path path = Path::None;  ///< Read: from the manifest's folder on; Written: a plain name
};

/// A subcommand whose jobs a manifest may list.
struct BatchCommand {
  std::string name;
  std::map<std::string, BatchOption> options;  ///< by long name without dashes; source and target are none
  bool takes_many = false;                     ///< several sources, several targets, or a document
};

struct BatchJob {
  std::string id;
  int line = 0;  ///< in the manifest, from 1
  std::string command;
  std::vector<std::string> sources, targets;
  std::string document;           ///< in place of sources and targets
  Json options = Json::object();  ///< by name, sorted; values as the line has them
};

struct Manifest {
  std::string path, folder;  ///< folder: that its relative paths start from
  std::vector<BatchJob> jobs;
};

/// Whether it can be a file's name and nothing else: no folder, not hidden, no control character, no option.
bool is_plain_name(const std::string& name);

/// The lines of a manifest; blank ones are none. Throws Error that names file and line: no JSON, an unknown
/// key or option (with the nearest that is known), a value of another kind, an id twice or none that can name
/// a file, an output that would lie elsewhere than in the job's folder, nothing to do.
std::vector<BatchJob> parse_manifest(const std::string& text, const std::string& path,
                                     const std::vector<BatchCommand>& commands);
Manifest read_manifest(const std::string& path, const std::vector<BatchCommand>& commands);

/// What a job does, in one order of members whatever the line's: what records and comparisons go by.
Json to_json(const BatchJob& job);

}  // namespace understudy::app
