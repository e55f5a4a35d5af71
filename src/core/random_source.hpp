// Random numbers that are the same on every platform: the standard's distributions are not.
#pragma once

#include <cmath>
#include <cstdint>

namespace coapt {

// SplitMix64 (Steele, Lea, Flood 2014). Streams of one seed are independent of each other.
class RandomSource {
 public:
  explicit RandomSource(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mixed(seed + kStep) ^ mixed(~stream)) {}

  // In [0, 1), a multiple of 2^-53.
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  // Each factor as likely as any other. Pre: 0 < low <= high.
  double log_between(double low, double high) { return low * std::pow(high / low, unit()); }
  // One of 0 ... count - 1. Pre: count > 0.
  int below(int count) { return static_cast<int>(unit() * count); }
  int whole(int low, int high) { return low + below(high - low + 1); }  // both included
  bool chance(double probability) { return unit() < probability; }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;
  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  std::uint64_t next() { return mixed(state_ += kStep); }

  std::uint64_t state_;
};

}  // namespace coapt
