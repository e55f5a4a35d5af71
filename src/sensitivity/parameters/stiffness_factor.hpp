// A modulus or a thickness of a region as a parameter: what multiplies elastic energies.
#pragma once

#include "sensitivity/parameters/parameter.hpp"

#include <memory>
#include <vector>

namespace coapt {

// Elements of one term, and how their energy goes with the parameter.
struct StiffnessPart {
  EnergyTerm* term = nullptr;
  double power = 1;  // 1: membranes and cables; 3: bending of a thickness; 2: a diameter of a cable

  // Whether the parameter is a size, thickness or diameter, that leaves stresses as they are, and no modulus.
  bool is_size = false;

  std::vector<int> elements = {};  // none: all
  // Of the stiffness of each of these, how much belongs to the parameter at its first value, in (0, 1]; the
  // rest stays: hinges between two regions. None: all of it.
  std::vector<double> shares = {};
};

// One number, with `value` to begin with, as Young's modulus [MPa] or a thickness [mm]: an element's energy
// goes with 1 - share + share (number/value)^power. Exact for every law that is linear in the number; of the
// laws with several moduli all are scaled. It must stay positive. Throws InputError, all defects in one pass:
// a term of no elastic elements, one with prestress, which the number does not multiply, an element out of
// range, a share out of range, a value that is not positive.
std::unique_ptr<Parameter> make_stiffness_factor(std::string name, std::vector<StiffnessPart> parts,
                                                 double value);

}  // namespace coapt
