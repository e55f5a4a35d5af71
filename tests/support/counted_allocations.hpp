// What was allocated so far. Only for executables that list counted_allocations.cpp among their sources: it
// puts itself in front of the C library's allocator, which serves Eigen and CHOLMOD alike.
#pragma once

#include <gtest/gtest.h>

namespace coapt {

struct Allocations {
  long count = 0;  // blocks asked for
  long bytes = 0;  // asked for in all
  long live = 0;   // bytes that are held now
  long peak = 0;   // the most of these since forget_peak()
};

Allocations allocations();
void forget_peak();

// Skips where the allocator cannot be replaced, under the sanitizers.
class CountedAllocations : public testing::Test {
 protected:
  void SetUp() override;
};

}  // namespace coapt
