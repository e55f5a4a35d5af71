#include "core/timing.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace coapt {
namespace {

TEST(Timing, PhasesAddUpOverTheirVisits) {
  PhaseTimes times;
  times.add("assembly", 0.5, 0.25);
  times.add("line search", 1, 2);
  times.add("assembly", 0.25, 0.25);
  EXPECT_EQ(times.wall(), (std::map<std::string, double>{{"assembly", 0.75}, {"line search", 1}}));
  EXPECT_EQ(times.cpu(), (std::map<std::string, double>{{"assembly", 0.5}, {"line search", 2}}));
}

TEST(Timing, ATimerAddsBothTimesOfItsScope) {
  PhaseTimes times;
  const double before = wall_seconds();
  {
    const PhaseTimer timer(times, "pause");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_GE(times.wall().at("pause"), 0.02);
  EXPECT_LE(times.wall().at("pause"), wall_seconds() - before);
  EXPECT_LT(times.cpu().at("pause"), 0.02);
}

TEST(Timing, APhaseIsEnteredAtItsStart) {  // the end of a timer must not ask for memory
  PhaseTimes times;
  const PhaseTimer timer(times, "factorisation");
  EXPECT_EQ(times.wall().count("factorisation"), 1U);
  EXPECT_EQ(times.cpu().count("factorisation"), 1U);
}

TEST(Timing, WaitingTakesNoCpuTimeAndWorkDoes) {
  const double before = cpu_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LT(cpu_seconds() - before, 0.1);
  const double start = cpu_seconds();
  while (cpu_seconds() - start < 0.01) {
  }
  EXPECT_GE(cpu_seconds() - before, 0.01);
}

TEST(Timing, PeakMemoryRemembersWhatWasFreed) {
  const double wanted = 100;
  {
    const std::vector<char> memory(static_cast<size_t>(wanted * 1024 * 1024), 1);
    const volatile char* read = memory.data();  // else a compiler may leave all of it out
    EXPECT_EQ(read[memory.size() - 1], 1);
  }
  EXPECT_GE(peak_memory_mb(), wanted);
  EXPECT_LT(peak_memory_mb(), 1e5);  // megabytes, not kilobytes
}

}  // namespace
}  // namespace coapt
