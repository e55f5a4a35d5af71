// Jobs in parallel processes.
#pragma once

#include <cstddef>
#include <functional>

namespace coapt::cli {

struct PoolCallbacks {
  std::function<int(size_t job)> work;                      // in a process of its own; gives its exit code
  std::function<void(size_t job, int exit_code)> finished;  // here, once it has ended; -1: by a signal
  std::function<bool()> stops;                              // whether to start no more
};

// Runs jobs 0 .. count - 1 in up to `processes` processes at a time, each a copy of this one. When `stops`
// turns true, running jobs are asked to end (SIGTERM) and waited for. Jobs end with this process, however it
// ends. Returns the number of jobs that ended. Pre: this process has one thread. Throws std::runtime_error
// where no process can be made.
size_t run_jobs(size_t count, int processes, const PoolCallbacks& callbacks);

}  // namespace coapt::cli
