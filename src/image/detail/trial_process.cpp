#include "image/detail/trial_process.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <csignal>
#include <exception>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace coapt {
namespace {

constexpr unsigned kClockShare = 10;  // seconds by the clock for one of processor time: of a crowded machine

// How the copy ended, as the one byte that it sends, or the lack of it.
enum class TrialEnd : char { Returned = 'r', NoMemory = 'm', Threw = 't' };

void limit(int resource, rlim_t value) {
  rlimit now{};
  if (getrlimit(resource, &now) != 0) return;
  if (now.rlim_max != RLIM_INFINITY && value > now.rlim_max) return;
  now.rlim_cur = value;
  setrlimit(resource, &now);
}

// Address space of this process [bytes]; 0 where it is not told.
std::uintmax_t address_space() {
  std::uintmax_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void become_trial(const std::function<void()>& work, const TrialLimits& limits, int pipe_end) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM, SIGXCPU, SIGTERM})
    std::signal(signal, SIG_DFL);  // what the host program made of them is not wanted here
  std::signal(SIGINT, SIG_IGN);    // the process that waits answers it
  if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.seconds);
  alarm(kClockShare * limits.seconds);
  if (const std::uintmax_t now = address_space(); now > 0) limit(RLIMIT_AS, now + limits.bytes);
  TrialEnd end = TrialEnd::Returned;
  try {
    work();
  } catch (const InputError&) {  // the process that waits will throw it too
  } catch (const std::bad_alloc&) {
    end = TrialEnd::NoMemory;
  } catch (...) {
    end = TrialEnd::Threw;
  }
  const ssize_t sent = write(pipe_end, &end, 1);
  _exit(sent == 1 ? 0 : 1);
}

// Empty where the status says that the process ended by itself.
std::string words_of(int status, const TrialLimits& limits) {
  if (!WIFSIGNALED(status)) return "an exit of its own";
  switch (WTERMSIG(status)) {
    case SIGABRT:
      return "an assertion";
    case SIGXCPU:
    case SIGALRM:
      return "more than " + std::to_string(limits.seconds) + " s";
    case SIGKILL:
      return "more memory or time than it may take";
    default:
      return "a fault";
  }
}

}  // namespace

std::string end_of_trial(const std::function<void()>& work, const TrialLimits& limits) {
  int ends[2];
  if (pipe(ends) != 0) return "";
  for (const int end : ends) fcntl(end, F_SETFD, FD_CLOEXEC);
  const pid_t process = fork();
  if (process == 0) become_trial(work, limits, ends[1]);
  close(ends[1]);
  char sent = 0;
  ssize_t count = 0;
  if (process > 0) do
      count = read(ends[0], &sent, 1);
    while (count < 0 && errno == EINTR);
  close(ends[0]);
  if (process < 0) return "";
  int status = 0;
  pid_t ended = 0;
  do ended = waitpid(process, &status, 0);
  while (ended < 0 && errno == EINTR);
  if (count == 1)
    return sent == static_cast<char>(TrialEnd::Returned)   ? ""
           : sent == static_cast<char>(TrialEnd::NoMemory) ? "more memory than it may take"
                                                           : "an exception";
  return ended == process ? words_of(status, limits) : "a fault";  // where the host lets nobody wait
}

}  // namespace coapt
