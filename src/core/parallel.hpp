// A loop on several threads whose result does not depend on how many there are.
#pragma once

#include <cstddef>
#include <thread>
#include <vector>

namespace coapt {

// Calls work(first, last) for `threads` equal parts of [0, count), side by side, and returns when all are
// done. work may write only what belongs to its part and must not throw. threads <= 1: in the caller's
// thread.
template <typename Work>
void in_parallel(int threads, size_t count, const Work& work) {
  const size_t parts = threads < 1 ? 1 : static_cast<size_t>(threads);
  std::vector<std::jthread> others;  // join when they go out of scope
  for (size_t k = 1; k < parts; ++k)
    others.emplace_back([&work, k, parts, count] { work(count * k / parts, count * (k + 1) / parts); });
  work(size_t{0}, count / parts);
}

}  // namespace coapt
