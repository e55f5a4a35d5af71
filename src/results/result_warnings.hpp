// What a reader of a result must know before its figures.
#pragma once

#include "results/results.hpp"

#include <string>
#include <vector>

namespace coapt {

// Whole sentences: the warnings of the solve; why its stability is in doubt; that other equilibria were found
// near by; how many nodes have no determined place.
std::vector<std::string> result_warnings(const Report& report);

// Of an equilibrium: whether it is no closed shape to rely on, as facets pass through each other, or it is
// not stable or that could not be decided.
bool is_in_doubt(const Report& report);

// The first line of a result.
struct Headline {
  // The message of the solve and, of an equilibrium, facets that pass through each other and whether it may
  // not be the only one.
  std::string text;
  bool is_in_doubt = false;  // of an equilibrium: see is_in_doubt(), or whether it is the only one near by
};

Headline headline(const Report& report);

}  // namespace coapt
