#include "app/session/child_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

/// What was written into a file, its end where that is long.
std::string text_in(int file) {
  constexpr off_t kMost = 1 << 16;
  const off_t size = ::lseek(file, 0, SEEK_END), from = size > kMost ? size - kMost : 0;
  std::string text(static_cast<size_t>(size > from ? size - from : 0), '\0');
  const ssize_t got = ::pread(file, text.data(), text.size(), from);
  text.resize(static_cast<size_t>(got > 0 ? got : 0));
  return text;
}

std::string last_line(std::string text) {
  const size_t end = text.find_last_not_of(" \r\n\t");
  text.resize(end == text.npos ? 0 : end + 1);
  const size_t line = text.find_last_of('\n');
  return line == text.npos ? text : text.substr(line + 1);
}

/// Starts it with its words written into `out` and `err`; 0, or what is wrong.
int spawn(const std::vector<std::string>& command, int out, int err, pid_t& pid) {
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, out, 1);
  ::posix_spawn_file_actions_adddup2(&files, err, 2);
  ::posix_spawn_file_actions_addclosefrom_np(&files, 3);
  const int failed = ::posix_spawn(&pid, words[0], &files, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  return failed;
}

}  // namespace

ChildProgram::ChildProgram(const std::vector<std::string>& command)
    : out_(::memfd_create("out", MFD_CLOEXEC)), err_(::memfd_create("err", MFD_CLOEXEC)) {
  const int failed = out_ < 0 || err_ < 0 ? errno : spawn(command, out_, err_, pid_);
  if (failed == 0) return;
  ::close(out_), ::close(err_);
  throw Error(command.front() + ": cannot be started (" + std::strerror(failed) + ")");
}

ChildProgram::~ChildProgram() {
  stop();
  ::close(out_), ::close(err_);
}

std::optional<ChildProgram::End> ChildProgram::end() {
  int status = 0;
  if (!status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
  if (!status_) return std::nullopt;
  End end;
  if (WIFEXITED(*status_)) end.code = WEXITSTATUS(*status_);
  end.out = last_line(text_in(out_));
  end.err = last_line(text_in(err_));
  return end;
}

void ChildProgram::stop() {
  if (end()) return;
  ::kill(pid_, SIGTERM);
  for (int i = 0; i < 100; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (end()) return;
  }
  ::kill(pid_, SIGKILL);
  int status = 0;
  if (::waitpid(pid_, &status, 0) == pid_) status_ = status;
}

}  // namespace understudy::app
