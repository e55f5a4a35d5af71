// Memory for numbers that are written before they are read.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

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
    size_ = 0;
    numbers_.reset(allocate(wanted));
    size_ = wanted;
  }
  double* data() { return numbers_.get(); }
  const double* data() const { return numbers_.get(); }

 private:
  struct Free {
    void operator()(double* numbers) const { std::free(numbers); }
  };

  // Of so many numbers; throws std::bad_alloc.
  static double* allocate(size_t size);

  std::unique_ptr<double[], Free> numbers_;
  size_t size_ = 0;
};

}  // namespace coapt
