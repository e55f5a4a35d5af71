// What a reader of a result must know before its figures.
#pragma once

#include "results/results.hpp"

#include <string>
#include <vector>

namespace coapt {

// Whole sentences: the warnings of the solve; why its stability is in doubt; that other equilibria were found
// near by; how many nodes have no determined place.
std::vector<std::string> result_warnings(const Report& report);

// The first line of a result.
struct Headline {
  std::string text;  // the message of the solve and, of an equilibrium, whether it may not be the only one
  bool is_in_doubt = false;  // of an equilibrium: its stability, or whether it is the only one near by
};

Headline headline(const Report& report);

}  // namespace coapt
