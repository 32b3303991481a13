// Runs the shipped program as a user would, for tests.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace understudy::tests {

struct ProgramOptions {
  std::string program;                   ///< another than ours: a path, or a name to look for
  long file_size_limit = -1;             ///< bytes a file may grow to, as on a full disk; -1: no limit
  bool obey_permissions = false;         ///< take root's right to open every file and port away
  std::vector<std::string> environment;  ///< "NAME=VALUE" on top of the test's own
  double patience_s = 100;               ///< killed after this long
};

struct Finished {
  int code = -1;  ///< exit code, or 128 + signal
  std::string out, err;
};

/// The program while it runs.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments, ProgramOptions options = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  /// Waits until stdout and stderr together hold the text; false when the program ended or patience did.
  bool wait_for(const std::string& text);
  void send(int signal);
  Finished finish();

 private:
  bool read_some(int timeout_ms);
  double elapsed_s() const;
  ProgramOptions options_;
  pid_t pid_ = -1;
  int out_ = -1, err_ = -1;
  double began_s_ = 0;
  Finished result_;
};

/// Runs it to the end.
Finished run_program(const std::vector<std::string>& arguments, ProgramOptions options = {});

/// Number of lines that are not empty.
int line_count(const std::string& text);
std::string read_bytes(const std::string& path);

/// A folder of its own that is removed at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  /// Names of all files in it, sorted, with folders inside.
  std::vector<std::string> files() const;

 private:
  std::string folder_;
};

}  // namespace understudy::tests
