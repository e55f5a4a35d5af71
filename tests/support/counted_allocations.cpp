#include "support/counted_allocations.hpp"

#include "support/sanitized.hpp"

#include <atomic>
#include <cstdlib>
#include <malloc.h>

namespace {

std::atomic<long> blocks = 0, bytes = 0, live = 0, peak = 0;

// The size that was asked for, and what the allocator made of it.
[[maybe_unused]] void* counted(void* block, size_t size) {
  ++blocks;
  bytes += static_cast<long>(size);
  live += static_cast<long>(malloc_usable_size(block));
  if (live > peak) peak = live.load();  // in tests of one thread
  return block;
}

}  // namespace

#if !COAPT_IS_SANITIZED
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* block, size_t size);
void __libc_free(void* block);

void* malloc(size_t size) { return counted(__libc_malloc(size), size); }
void* calloc(size_t count, size_t size) { return counted(__libc_calloc(count, size), count * size); }
void* realloc(void* block, size_t size) {
  live -= static_cast<long>(malloc_usable_size(block));
  return counted(__libc_realloc(block, size), size);
}
void free(void* block) {
  live -= static_cast<long>(malloc_usable_size(block));
  __libc_free(block);
}
}
#endif

namespace coapt {

Allocations allocations() { return {blocks, bytes, live, peak}; }

void forget_peak() { peak = live.load(); }

void CountedAllocations::SetUp() {
  const long before = blocks;
  void* volatile block = std::malloc(1000);  // volatile: a pair that nobody looks at may be removed
  std::free(block);
  if (blocks == before) GTEST_SKIP() << "the allocator cannot be replaced here (sanitizers)";
}

}  // namespace coapt
