#include "cli/progress.hpp"

#include <csignal>
#include <cstdio>
#include <memory>
#include <unistd.h>

namespace coapt::cli {
namespace {

// The one global of the program: a signal handler can reach nothing else.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
volatile std::sig_atomic_t interrupted = 0;

void on_interrupt(int) { interrupted = 1; }

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

bool is_interrupted() { return interrupted != 0; }

Observer make_observer() {
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  const auto last_shown = std::make_shared<double>(-1.0);
  return [is_terminal, last_shown](const Iteration& it, const Vector&) {
    if (is_terminal && it.seconds - *last_shown > 0.1) {
      *last_shown = it.seconds;
      std::fprintf(stderr, "\r  iteration %d   residual %.2e   energy %.8g mJ   %.1f s\033[K", it.iteration,
                   it.residual, it.energy, it.seconds);
      std::fflush(stderr);
    }
    return !is_interrupted();
  };
}

void end_progress() {
  if (isatty(STDERR_FILENO) == 1) std::fputs("\r\033[K", stderr);
}

}  // namespace coapt::cli
