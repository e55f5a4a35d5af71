// How many threads the dense kernels use, for the length of a scope.
#pragma once

namespace coapt::detail {

class BlasThreads {
 public:
  explicit BlasThreads(int count);
  ~BlasThreads();
  BlasThreads(const BlasThreads&) = delete;
  BlasThreads& operator=(const BlasThreads&) = delete;
};

}  // namespace coapt::detail
