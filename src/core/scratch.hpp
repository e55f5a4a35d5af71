// Memory for numbers that are written before they are read.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace coapt {

// Patterns of matrices in contact grow a little from one to the next: what is there is neither cleared nor
// copied as memory grows, and there is some to spare from the second time on.
class Scratch {
 public:
  // Room for `size` numbers, with any values.
  void need(size_t size) {
    if (size <= size_) return;
    const size_t wanted = size_ == 0 ? size : size + size / 4;
    numbers_.reset();
    numbers_.reset(allocate(wanted * sizeof(double)));
    size_ = wanted;
  }
  double* data() { return numbers_.get(); }
  const double* data() const { return numbers_.get(); }

 private:
  static constexpr size_t kLargePage = 2 << 20;
  static constexpr size_t kLarge = 2 * kLargePage;

  struct Free {
    void operator()(double* numbers) const { std::free(numbers); }
  };

  // Where the system gives large pages on request it clears a factor in tens of pieces, not in thousands.
  static double* allocate(size_t bytes) {
    const bool is_large = bytes >= kLarge;
    const size_t whole = is_large ? (bytes + kLargePage - 1) / kLargePage * kLargePage : bytes;
    void* memory = is_large ? std::aligned_alloc(kLargePage, whole) : std::malloc(whole);
    if (!memory) throw std::bad_alloc();
#ifdef __linux__
    if (is_large) madvise(memory, whole, MADV_HUGEPAGE);
#endif
    return static_cast<double*>(memory);
  }

  std::unique_ptr<double[], Free> numbers_;
  size_t size_ = 0;
};

}  // namespace coapt
