// Texts of files that went through an accident: what reads them must accept or refuse each, and nothing else.
#pragma once

#include <functional>
#include <random>
#include <string>

namespace coapt {

// The text cut off behind every `step`-th byte.
inline void for_each_truncation(const std::string& text, size_t step,
                                const std::function<void(const std::string&)>& attempt) {
  for (size_t size = 0; size < text.size(); size += step) attempt(text.substr(0, size));
}

// 400 copies with `changes` bytes each, at random places of a fixed seed, replaced by some of `bytes`.
inline void for_each_damage(const std::string& text, int changes, const std::string& bytes, unsigned seed,
                            const std::function<void(const std::string&)>& attempt) {
  std::mt19937 random(seed);
  for (int k = 0; k < 400; ++k) {
    std::string damaged = text;
    for (int change = 0; change < changes; ++change) {
      const size_t place = random() % text.size();
      damaged[place] = bytes[random() % bytes.size()];
    }
    attempt(damaged);
  }
}

}  // namespace coapt
