// Clocks, time by phase and peak memory. Always on: a reading costs some 300 ns.
#pragma once

#include <map>
#include <string>

namespace coapt {

double wall_seconds();    // monotonic clock [s]
double cpu_seconds();     // CPU time of the process [s]
double peak_memory_mb();  // largest resident size of the process so far [MB]

// Time by phase [s], summed over all visits.
class PhaseTimes {
 public:
  void add(const std::string& phase, double wall, double cpu) {
    wall_[phase] += wall;
    cpu_[phase] += cpu;
  }
  const std::map<std::string, double>& wall() const { return wall_; }
  const std::map<std::string, double>& cpu() const { return cpu_; }

 private:
  std::map<std::string, double> wall_, cpu_;
};

// Adds the time between its construction and its destruction to one phase: by the clock and of the processor.
// The phase is entered at the start, as a destructor that asks for memory would end a process short of it.
class PhaseTimer {
 public:
  PhaseTimer(PhaseTimes& times, std::string phase)
      : times_(times), phase_(std::move(phase)), wall_(wall_seconds()), cpu_(cpu_seconds()) {
    times_.add(phase_, 0, 0);
  }
  ~PhaseTimer() { times_.add(phase_, wall_seconds() - wall_, cpu_seconds() - cpu_); }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  PhaseTimes& times_;
  std::string phase_;
  double wall_, cpu_;
};

}  // namespace coapt
