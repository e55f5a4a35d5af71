// What a user sees and can do while a solve runs: a progress line on a terminal, and Ctrl-C.
#pragma once

#include "optim/solver.hpp"

namespace coapt::cli {

// From now on SIGINT and SIGTERM ask the run to stop; a second one ends the process at once. One that whoever
// started the process had it ignore stays ignored: a shell without job control starts `coapt ... &` that way
// with SIGINT. Such a signal is otherwise lost or heeded depending on whether it comes before or after this
// call.
void listen_for_interrupts();

// Whether such a signal has come.
bool is_interrupted();

// Writes a progress line to the standard error stream when that is a terminal, and cancels the run after
// an interrupt.
Observer make_observer();

// Clears the progress line.
void end_progress();

}  // namespace coapt::cli
