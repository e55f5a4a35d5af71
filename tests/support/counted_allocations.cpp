#include "support/counted_allocations.hpp"

#include "support/sanitized.hpp"

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <malloc.h>

namespace {

std::atomic<long> blocks = 0, bytes = 0, live = 0, peak = 0;

// What was asked for stands at the end of each block, as what the allocator makes of it, some bytes more or
// less, depends on what else lies in the heap.
struct Asked {
  const void* block;  // tells blocks that were not counted
  size_t size;
};

[[maybe_unused]] constexpr size_t kAsked = sizeof(Asked);

[[maybe_unused]] void* place_of_asked(void* block) {
  return static_cast<char*>(block) + malloc_usable_size(block) - kAsked;
}

[[maybe_unused]] void* counted(void* block, size_t size) {
  if (!block) return block;
  const Asked asked = {block, size};
  std::memcpy(place_of_asked(block), &asked, kAsked);
  ++blocks;
  bytes += static_cast<long>(size);
  live += static_cast<long>(size);
  if (live > peak) peak = live.load();  // in tests of one thread
  return block;
}

[[maybe_unused]] void forget(void* block) {
  if (!block || malloc_usable_size(block) < kAsked) return;
  Asked asked;
  std::memcpy(&asked, place_of_asked(block), kAsked);
  if (asked.block == block) live -= static_cast<long>(asked.size);
}

}  // namespace

#if !COAPT_IS_SANITIZED
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* block, size_t size);
void __libc_free(void* block);

void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) { return counted(__libc_malloc(size + kAsked), size); }
void* calloc(size_t count, size_t size) {
  size_t all = 0;
  if (__builtin_mul_overflow(count, size, &all)) return nullptr;
  return counted(__libc_calloc(1, all + kAsked), all);
}
void* realloc(void* block, size_t size) {
  forget(block);
  return counted(__libc_realloc(block, size + kAsked), size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  return counted(__libc_memalign(alignment, size + kAsked), size);
}
void free(void* block) {
  forget(block);
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
