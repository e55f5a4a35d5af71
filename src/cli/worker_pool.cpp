#include "cli/worker_pool.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace coapt::cli {
namespace {

constexpr int kCrashed = 3;

[[noreturn]] void become_worker(size_t job, pid_t parent, const PoolCallbacks& callbacks) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  int code = kCrashed;
  // The parent may have gone before it could be asked to be told.
  if (getppid() == parent) try {
      code = callbacks.work(job);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "coapt: internal error: %s\n", error.what());
    }
  std::fflush(stdout);
  std::fflush(stderr);
  _exit(code);
}

}  // namespace

size_t run_jobs(size_t count, int processes, const PoolCallbacks& callbacks) {
  std::map<pid_t, size_t> running;
  size_t next = 0, ended = 0;
  bool is_stopping = false;
  const pid_t self = getpid();
  while (next < count || !running.empty()) {
    if (!is_stopping && callbacks.stops()) {
      is_stopping = true;
      next = count;
      for (const auto& [process, job] : running) kill(process, SIGTERM);
    }
    while (next < count && running.size() < static_cast<size_t>(processes)) {
      std::fflush(stdout);  // or the copy would print it again
      std::fflush(stderr);
      const pid_t process = fork();
      if (process == 0) become_worker(next, self, callbacks);
      if (process < 0) {
        if (!running.empty()) break;  // go on with those there are
        throw std::runtime_error(std::string("no process can be started: ") + std::strerror(errno));
      }
      running[process] = next++;
    }
    if (running.empty()) break;
    int status = 0;
    const pid_t process = waitpid(-1, &status, WNOHANG);
    if (process <= 0) {
      constexpr unsigned kPause = 10000;  // [us]: short beside any solve, and a signal is soon seen
      usleep(kPause);
      continue;
    }
    const auto found = running.find(process);
    if (found == running.end()) continue;
    const size_t job = found->second;
    running.erase(found);
    ++ended;
    callbacks.finished(job, WIFEXITED(status) ? WEXITSTATUS(status) : -1);
  }
  return ended;
}

}  // namespace coapt::cli
