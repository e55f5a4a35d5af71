#include "solve/peak_memory.hpp"

#include <fstream>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace coapt {
namespace {

// A line of /proc/self/status such as "VmHWM:  9324 kB" [MB].
std::optional<double> status_mb(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
    if (double kilobytes = 0; word == name + ":" && status >> kilobytes) return kilobytes / 1024;
  return std::nullopt;
}

// Makes the peak that the system counts the present size.
bool forget_peak() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

}  // namespace

PeakMemory::PeakMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  if (forget_peak()) start_mb_ = status_mb("VmRSS");
}

std::optional<double> PeakMemory::risen_mb() const {
  const std::optional<double> peak = status_mb("VmHWM");
  if (!start_mb_ || !peak) return std::nullopt;
  return *peak - *start_mb_;
}

}  // namespace coapt
