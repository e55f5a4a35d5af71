// Random choices that are the same on every machine and in every run. Private to this room.
#pragma once

#include "core/types.hpp"

#include <random>

namespace coapt {

// The distributions of the standard library differ from one library to the next; its engines do not.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  int integer(int low, int high) {  // both included
    return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
  }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }
  Vec3 on_grid() {  // in [-1, 1]^3, whole multiples of 1/1024
    const int x = integer(-1024, 1024), y = integer(-1024, 1024), z = integer(-1024, 1024);
    return Vec3(x, y, z) / 1024;
  }

 private:
  std::mt19937 random_;
};

}  // namespace coapt
