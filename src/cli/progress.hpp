// What a user sees and can do while a solve runs: a progress line on a terminal, and Ctrl-C.
#pragma once

#include "optim/solver.hpp"

namespace coapt::cli {

// From now on SIGINT and SIGTERM ask the run to stop; a second one ends the process at once.
void listen_for_interrupts();

// Writes a progress line to the standard error stream when that is a terminal, and cancels the run after
// an interrupt.
Observer make_observer();

// Clears the progress line.
void end_progress();

}  // namespace coapt::cli
