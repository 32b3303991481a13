#include "app/batch/processes.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr int kGlance_ms = 200;
constexpr int kCannotBegin = 70;  // exit code of a process whose begin() threw

/// One process, as its parent sees it.
struct Child {
  pid_t pid = -1;
  int line = -1;              // the parent's end
  std::optional<size_t> job;  // it is doing
};

std::string how_it_ended(int status) {
  if (!WIFSIGNALED(status)) return printed("its process ended by itself (exit code %d)", WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  std::string told = printed("its process was ended by signal %d (%s)", signal, ::strsignal(signal));
  if (signal == SIGKILL) told += "; there may have been too little memory";
  return told;
}

/// Does jobs until the parent closes the line.
void serve(int line, const ProcessPool& pool) {
  const auto work = pool.begin();
  uint64_t job = 0;
  for (;;) {
    const ssize_t got = ::recv(line, &job, sizeof job, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got != sizeof job) return;
    const JobEnd end = work(static_cast<size_t>(job));
    if (::send(line, &end, sizeof end, MSG_NOSIGNAL) != sizeof end || end == JobEnd::Stopped) return;
  }
}

class Pool {
 public:
  Pool(const std::vector<size_t>& jobs, const ProcessPool& pool) : jobs_(jobs), pool_(pool) {}
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  void run();

 private:
  void start();
  void hand_out(Child& child);
  void hear(Child& child);
  void leave(Child& child);
  void ask_to_stop();

  const std::vector<size_t>& jobs_;
  const ProcessPool& pool_;
  size_t next_ = 0;
  bool stopping_ = false;
  std::vector<Child> children_;
};

Pool::~Pool() {  // by an exception: nobody is left to tell
  for (Child& child : children_) {
    ::kill(child.pid, SIGKILL);
    ::close(child.line);
    ::waitpid(child.pid, nullptr, 0);
  }
}

void Pool::start() {
  int ends[2] = {-1, -1};
  US_CHECK(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) == 0,
           "no further process can be started (", std::strerror(errno), ")");
  std::fflush(nullptr);
  const pid_t parent = ::getpid(), pid = ::fork();
  if (pid == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(0);
    ::close(ends[0]);
    for (const Child& other : children_) ::close(other.line);  // or those never see their line end
    const std::string problem = failure_of([&] { serve(ends[1], pool_); });
    if (!problem.empty()) std::fprintf(stderr, "understudy: %s\n", problem.c_str());
    std::fflush(nullptr);
    ::_exit(problem.empty() ? 0 : kCannotBegin);
  }
  const int why = errno;
  ::close(ends[1]);
  if (pid < 0) ::close(ends[0]);
  US_CHECK(pid > 0, "no further process can be started (", std::strerror(why), ")");
  children_.push_back({pid, ends[0], std::nullopt});
  hand_out(children_.back());
}

/// The next job; where there is none its line is closed, and it ends.
void Pool::hand_out(Child& child) {
  child.job.reset();
  if (stopping_ || next_ >= jobs_.size()) {
    ::shutdown(child.line, SHUT_WR);
    return;
  }
  const uint64_t job = jobs_[next_];
  if (::send(child.line, &job, sizeof job, MSG_NOSIGNAL) != sizeof job) return;  // it is dead: hear() tells
  child.job = jobs_[next_++];
}

void Pool::hear(Child& child) {
  JobEnd end{};
  const ssize_t got = ::recv(child.line, &end, sizeof end, 0);
  if (got < 0 && errno == EINTR) return;
  if (got != sizeof end || !child.job) return leave(child);
  const size_t job = *child.job;
  if (end == JobEnd::Stopped) stopping_ = true;  // who was told to end speaks for all
  pool_.ended(job, end);
  hand_out(child);
}

/// It closed its line: it has ended, or is about to.
void Pool::leave(Child& child) {
  int status = 0;
  while (::waitpid(child.pid, &status, 0) < 0 && errno == EINTR) {
  }
  ::close(child.line);
  const Child gone = child;
  children_.erase(children_.begin() + (&child - children_.data()));
  const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  US_CHECK(!(WIFEXITED(status) && WEXITSTATUS(status) == kCannotBegin), "a process of the batch cannot work");
  if (gone.job && !stopping_)
    pool_.crashed(*gone.job, how_it_ended(status));
  else
    US_CHECK(good || stopping_, "a process of the batch has gone: ", how_it_ended(status));
}

void Pool::ask_to_stop() {
  stopping_ = true;
  for (const Child& child : children_) ::kill(child.pid, SIGTERM);
}

void Pool::run() {
  bool asked = false;
  for (;;) {
    if (!asked && (pool_.stopped() || stopping_)) ask_to_stop(), asked = true;
    while (!stopping_ && next_ < jobs_.size() && children_.size() < static_cast<size_t>(pool_.processes))
      start();
    if (children_.empty()) return;
    std::vector<pollfd> lines;
    for (const Child& child : children_) lines.push_back({child.line, POLLIN, 0});
    if (::poll(lines.data(), lines.size(), kGlance_ms) <= 0) continue;
    for (size_t i = lines.size(); i-- > 0;)  // backwards: who leaves is taken out of the list
      if (lines[i].revents != 0) hear(children_[i]);
  }
}

}  // namespace

void run_in_processes(const std::vector<size_t>& jobs, const ProcessPool& pool) {
  Pool(jobs, pool).run();
}

}  // namespace understudy::app
