#include "core/scratch.hpp"

#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace coapt {
namespace {

constexpr size_t kLargePage = 2 << 20;  // bytes
constexpr size_t kLarge = 2 * kLargePage;

}  // namespace

// Where the system gives large pages on request it clears a factor in tens of pieces, not in thousands.
double* Scratch::allocate(size_t size) {
  size_t bytes = size * sizeof(double);
  const bool is_large = bytes >= kLarge;
  if (is_large) bytes = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  void* memory = is_large ? std::aligned_alloc(kLargePage, bytes) : std::malloc(bytes);
  if (!memory) throw std::bad_alloc();
#ifdef __linux__
  if (is_large) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
  return static_cast<double*>(memory);
}

}  // namespace coapt
