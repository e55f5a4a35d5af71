// What a user sees and can do while a solve runs: its progress, and Ctrl-C.
#pragma once

#include "cli/session.hpp"
#include "solve/run_options.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace coapt::cli {

// From now on SIGINT and SIGTERM ask the run to stop; a second one ends the process at once. One that whoever
// started the process had it ignore stays ignored: a shell without job control starts `coapt ... &` that way
// with SIGINT. Such a signal is otherwise lost or heeded depending on whether it comes before or after this
// call. A run that does not ask is_interrupted() within two minutes of the signal is ended all the same.
void listen_for_interrupts();

// Whether such a signal has come; whoever asks is about to stop.
bool is_interrupted();

// Shows on the standard error how far a run is: its phase, step, iterations, residual and the one that is
// wanted, where that is known, time since this call, and what is left by estimate. On a terminal in one line,
// elsewhere as a line every five seconds, none for --quiet, for --verbose a line at every iterate. Asks the
// run to stop after an interrupt.
void show_progress(const Session& session, RunOptions& options);

// The same of jobs that go on beside each other, to be called again and again with how many have ended since
// this call: "2 of 5 points, 14.0 s, about 21 s left".
std::function<void(std::size_t ended)> make_job_progress(const Session& session, std::string jobs,
                                                         std::size_t count);

// Takes the line of a terminal away.
void end_progress();

// A line that stays, unless --quiet.
void show_stage(const Session& session, const std::string& line);

}  // namespace coapt::cli
