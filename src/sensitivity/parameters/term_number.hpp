// A number that the data of elements are made from, however it enters their laws: Poisson's ratio, the strain
// at a knee, an exponent, a prestress.
#pragma once

#include "sensitivity/parameters/parameter.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

struct TermNumber {
  double value = 0;                // to begin with
  double scale = 0;                // over which the laws change noticeably, above 0; mostly |value|
  std::vector<EnergyTerm*> terms;  // whose elements change with it

  // The same terms, element by element, as another value makes them. Pre: defect(value) is empty.
  std::function<std::vector<std::unique_ptr<EnergyTerm>>(double value)> terms_at;

  // What is wrong with a value, as a sentence; empty: nothing.
  std::function<std::string(double value)> defect;

  // Told each new value, where several such numbers make the same terms. May be empty: then no other may.
  std::function<void(double value)> keep;
};

// One number, for terms of elastic elements of any law. What is made keeps the rest lengths that cables and
// tethers have by then; all other data are replaced, so that no other parameter but one of rest lengths, or
// another of this kind with which `keep` reconciles it, may change the same terms: an equilibrium refuses it.
// Derivatives are exact in the positions and by differences of fourth order of exact forces in the number,
// central ones or, at the end of its range, one-sided: to 1e-9 of the whole where the law is smooth in the
// number over 0.2 % of `scale`. Throws InputError for a term that is not of elastic elements, and a scale
// that is not positive.
std::unique_ptr<Parameter> make_term_number(std::string name, TermNumber number);

}  // namespace coapt
