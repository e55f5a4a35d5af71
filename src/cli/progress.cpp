#include "cli/progress.hpp"

#include "cli/progress_estimate.hpp"
#include "core/number_text.hpp"
#include "core/timing.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <unistd.h>
#include <utility>

namespace coapt::cli {
namespace {

// The one global of the program: a signal handler can reach nothing else.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
volatile std::sig_atomic_t interrupted = 0;

constexpr double kLogPause = 5;         // [s] between lines where nobody watches
constexpr double kTerminalPause = 0.1;  // [s] on a terminal

// What show_progress() has shown.
struct ShownProgress {
  double start = wall_seconds(), last = start;
  ProgressEstimate estimate;
  RunPhase phase;     // the last that is a solve
  std::string other;  // what goes on since then that is none; empty: nothing
};

constexpr unsigned kIterateTime = 120;  // [s] that an iterate may still take after a signal

// A library that waits for memory may never come back to an iterate: then the alarm ends the process.
void on_interrupt(int) {
  interrupted = 1;
  alarm(kIterateTime);
}

}  // namespace

void listen_for_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  // The first signal restores the default action; interrupted system calls go on.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM}) {
    struct sigaction inherited = {};
    sigaction(number, nullptr, &inherited);
    if (inherited.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
}

bool is_interrupted() {
  if (interrupted == 0) return false;
  alarm(0);
  return true;
}

namespace {

// On a terminal over the line before.
void show_line(const std::string& line, bool is_terminal) {
  std::fprintf(stderr, is_terminal ? "\r  %s\033[K" : "  %s\n", line.c_str());
  std::fflush(stderr);
}

// What is no solve has no figures of its own.
void show_other(ShownProgress& shown, bool is_terminal) {
  shown.last = wall_seconds();
  show_line(shown.other + ", " + fixed_text(shown.last - shown.start, 1) + " s", is_terminal);
}

}  // namespace

void show_progress(const Session& session, RunOptions& options) {
  if (session.is_quiet && !session.is_verbose) {
    options.observer = [](const Iteration&, const Vector&) { return !is_interrupted(); };
    return;
  }
  const bool is_terminal = isatty(STDERR_FILENO) == 1 && !session.is_verbose;
  const double pause = session.is_verbose ? 0 : is_terminal ? kTerminalPause : kLogPause;
  const auto shown = std::make_shared<ShownProgress>();
  options.phase = [=](const RunPhase& phase) {
    shown->other.clear();
    if (phase.tolerance > 0) {
      shown->phase = phase;
      return;
    }
    shown->other = phase.name;
    if (is_terminal || wall_seconds() - shown->last >= pause) show_other(*shown, is_terminal);
  };
  options.observer = [=](const Iteration& now, const Vector& q) {
    const bool is_question = now.evaluations == 0 && now.residual == 0;
    if (is_question) {
      if (!shown->other.empty() && wall_seconds() - shown->last >= std::max(pause, kTerminalPause))
        show_other(*shown, is_terminal);
      return !is_interrupted();
    }
    shown->estimate.see(now);
    if (wall_seconds() - shown->last >= pause) {
      shown->last = wall_seconds();
      const std::optional<double> wanted =
          shown->phase.tolerance > 0 ? std::optional(shown->phase.tolerance) : std::nullopt;
      show_line(progress_line(shown->phase.name, now, q.size() / 3, wanted, shown->last - shown->start,
                              wanted ? shown->estimate.seconds_left(*wanted) : std::nullopt),
                is_terminal);
    }
    return !is_interrupted();
  };
}

std::function<void(std::size_t)> make_job_progress(const Session& session, std::string jobs,
                                                   std::size_t count) {
  if (session.is_quiet) return [](std::size_t) {};
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  const double pause = is_terminal ? 1 : kLogPause, start = wall_seconds();
  return [=, jobs = std::move(jobs), last = start](std::size_t ended) mutable {
    const double now = wall_seconds(), elapsed = now - start;
    if (now - last < pause) return;
    last = now;
    show_line(job_progress_line(jobs, ended, count, elapsed), is_terminal);
  };
}

void end_progress() {
  if (isatty(STDERR_FILENO) == 1) std::fputs("\r\033[K", stderr);
}

void show_stage(const Session& session, const std::string& line) {
  if (session.is_quiet) return;
  end_progress();
  show_line(line, false);
}

}  // namespace coapt::cli
