#include "core/thread_team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <new>

namespace coapt {
namespace {

TEST(ThreadTeam, DoesEachPartOnceHoweverManyThreads) {
  for (const int threads : {-1, 0, 1, 2, 3, 8}) {
    ThreadTeam team(threads);
    EXPECT_EQ(team.size(), std::max(1, threads));
    for (const int count : {0, 1, 5, 1000})
      for (int again = 0; again < 20; ++again) {
        std::vector<int> calls(static_cast<size_t>(count), 0);
        std::atomic<bool> is_member = true;
        team.run(count, [&](int part, int thread) {
          ++calls[static_cast<size_t>(part)];
          if (thread < 0 || thread >= team.size()) is_member = false;
        });
        EXPECT_EQ(calls, std::vector<int>(static_cast<size_t>(count), 1)) << threads << " threads";
        EXPECT_TRUE(is_member);
      }
  }
}

TEST(ThreadTeam, CoversARangeOnce) {
  for (const int threads : {1, 2, 8})
    for (const size_t count : {size_t{0}, size_t{1}, size_t{5}, size_t{1000}}) {
      ThreadTeam team(threads);
      std::vector<int> calls(count, 0);
      team.run_ranges(count, 7, [&](size_t first, size_t last) {
        for (size_t k = first; k < last; ++k) ++calls[k];
      });
      EXPECT_EQ(calls, std::vector<int>(count, 1)) << threads << " threads";
    }
}

TEST(ThreadTeam, SharesItsParts) {
  ThreadTeam team(2);
  std::atomic<int> arrived = 0;  // two parts that wait for each other end only where two threads take them
  team.run(2, [&](int, int) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 2);
}

TEST(ThreadTeam, ThrowsInTheCallersThreadWhatWorkThrows) {
  ThreadTeam team(3);
  for (int again = 0; again < 20; ++again) {
    EXPECT_THROW(team.run(30,
                          [](int part, int) {
                            if (part % 10 == 7) throw std::bad_alloc();
                          }),
                 std::bad_alloc);
    std::atomic<int> calls = 0;
    team.run(30, [&](int, int) { ++calls; });
    EXPECT_EQ(calls, 30);
  }
}

TEST(ThreadTeam, OneThreadIsTheCallers) {
  ThreadTeam team;
  std::thread::id id;
  team.run(3, [&](int, int) { id = std::this_thread::get_id(); });
  EXPECT_EQ(id, std::this_thread::get_id());
}

TEST(ThreadTeam, ThereIsAProcessor) { EXPECT_GE(available_processors(), 1); }

}  // namespace
}  // namespace coapt
