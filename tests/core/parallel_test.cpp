#include "core/parallel.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

TEST(InParallel, CallsEachIndexOnceHoweverManyThreads) {
  for (const int threads : {-1, 0, 1, 2, 3, 8})
    for (const size_t count : {size_t{0}, size_t{1}, size_t{5}, size_t{1000}}) {
      std::vector<int> calls(count, 0);
      in_parallel(threads, count, [&](size_t first, size_t last) {
        for (size_t k = first; k < last; ++k) ++calls[k];
      });
      EXPECT_EQ(calls, std::vector<int>(count, 1)) << threads << " threads";
    }
}

TEST(InParallel, OneThreadIsTheCallers) {
  std::thread::id id;
  in_parallel(1, 3, [&](size_t, size_t) { id = std::this_thread::get_id(); });
  EXPECT_EQ(id, std::this_thread::get_id());
}

}  // namespace
}  // namespace coapt
