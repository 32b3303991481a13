#include "tests/app/program.hpp"

#include <fcntl.h>
#include <linux/capability.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "retarget/base/error.hpp"

namespace understudy::tests {
namespace fs = std::filesystem;
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Reads what is there; false at the end of the stream.
bool drain(int& stream, std::string& into) {
  char buffer[4096];
  const ssize_t count = read(stream, buffer, sizeof buffer);
  if (count > 0) into.append(buffer, static_cast<size_t>(count));
  if (count > 0) return true;
  close(stream);
  stream = -1;
  return false;
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, ProgramOptions options)
    : options_(std::move(options)), began_s_(now_s()) {
  if (options_.program.empty()) options_.program = US_PROGRAM;
  std::vector<char*> argv{options_.program.data()};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  int out[2], err[2];
  US_CHECK(pipe2(out, O_CLOEXEC) == 0 && pipe2(err, O_CLOEXEC) == 0, "no pipe");
  pid_ = fork();
  US_CHECK(pid_ >= 0, "no process");
  if (pid_ == 0) {
    dup2(out[1], 1);
    dup2(err[1], 2);
    for (const std::string& variable : options_.environment) putenv(const_cast<char*>(variable.c_str()));
    if (options_.file_size_limit >= 0) {
      const rlimit limit{static_cast<rlim_t>(options_.file_size_limit),
                         static_cast<rlim_t>(options_.file_size_limit)};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (options_.obey_permissions)  // fails for who is not root and has none of them anyway
      for (const int right : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH, CAP_NET_BIND_SERVICE})
        prctl(PR_CAPBSET_DROP, right);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  close(out[1]);
  close(err[1]);
  out_ = out[0];
  err_ = err[0];
}

Program::~Program() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (out_ >= 0) close(out_);
  if (err_ >= 0) close(err_);
}

double Program::elapsed_s() const {
  return now_s() - began_s_;
}

bool Program::read_some(int timeout_ms) {
  pollfd streams[2] = {{out_, POLLIN, 0}, {err_, POLLIN, 0}};
  if (poll(streams, 2, timeout_ms) <= 0) return true;
  if (out_ >= 0 && streams[0].revents) drain(out_, result_.out);
  if (err_ >= 0 && streams[1].revents) drain(err_, result_.err);
  return out_ >= 0 || err_ >= 0;
}

bool Program::wait_for(const std::string& text) {
  const auto seen = [&] {
    return result_.out.find(text) != std::string::npos || result_.err.find(text) != std::string::npos;
  };
  while (!seen() && elapsed_s() < options_.patience_s)
    if (!read_some(50) && !seen()) return false;
  return seen();
}

void Program::send(int signal) {
  kill(pid_, signal);
}

Finished Program::finish() {
  while (elapsed_s() < options_.patience_s && read_some(50)) {
  }
  if (elapsed_s() >= options_.patience_s) kill(pid_, SIGKILL);
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  result_.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result_;
}

Finished run_program(const std::vector<std::string>& arguments, ProgramOptions options) {
  return Program(arguments, std::move(options)).finish();
}

int line_count(const std::string& text) {
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);) count += !line.empty();
  return count;
}

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  US_CHECK(file, path, ": cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

ScratchFolder::ScratchFolder() {
  std::string name = (fs::temp_directory_path() / "understudy-XXXXXX").string();
  US_CHECK(mkdtemp(name.data()), "no scratch folder");
  folder_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::vector<std::string> ScratchFolder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder_).string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace understudy::tests
