// Resident memory that a stretch of work takes at most.
#pragma once

#include <optional>

namespace coapt {

// Watches from its construction on. What the heap keeps of earlier work is given back first, so that it is
// not taken for free. One at a time: the system counts one peak for the whole process.
class PeakMemory {
 public:
  PeakMemory();

  // The greatest resident size since then less that at the start [MB]; nothing where the system does not tell
  // (it takes /proc/self/clear_refs of Linux).
  std::optional<double> risen_mb() const;

 private:
  std::optional<double> start_mb_;
};

}  // namespace coapt
