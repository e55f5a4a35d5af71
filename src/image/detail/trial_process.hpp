// Work that may end the program, tried in a process of its own first.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace coapt {

struct TrialLimits {
  unsigned seconds = 10;                           // of processor time; ten times as long by the clock
  std::uintmax_t bytes = std::uintmax_t(4) << 30;  // of memory, beyond what this process has
};

// Runs `work` in a copy of this process, which must neither start threads nor change files. Empty where it
// returned or threw InputError; else what ended the copy, in words: "an assertion", "a fault", "more than 10
// s", "more memory than there is". What it prints is lost. A copy that cannot be made is taken for one that
// returned.
std::string end_of_trial(const std::function<void()>& work, const TrialLimits& limits);

}  // namespace coapt
