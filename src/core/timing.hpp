// Clocks, time by phase and peak memory. Always on: a reading costs some 50 ns.
#pragma once

#include <map>
#include <string>

namespace coapt {

double wall_seconds();    // monotonic clock [s]
double cpu_seconds();     // CPU time of the process [s]
double peak_memory_mb();  // largest resident size of the process so far [MB]

// Wall time by phase [s], summed over all visits.
class PhaseTimes {
 public:
  void add(const std::string& phase, double seconds) { seconds_[phase] += seconds; }
  const std::map<std::string, double>& seconds() const { return seconds_; }

 private:
  std::map<std::string, double> seconds_;
};

// Adds the wall time between its construction and its destruction to one phase.
class PhaseTimer {
 public:
  PhaseTimer(PhaseTimes& times, std::string phase)
      : times_(times), phase_(std::move(phase)), start_(wall_seconds()) {}
  ~PhaseTimer() { times_.add(phase_, wall_seconds() - start_); }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  PhaseTimes& times_;
  std::string phase_;
  double start_;
};

}  // namespace coapt
