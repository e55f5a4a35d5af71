// The elements of a term as lines between two nodes, whatever their law.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/term.hpp"

#include <memory>

namespace coapt {

// W(l, r) of one element, l its present and r its rest length.
struct LineState {
  AxialLaw law;               // W, dW/dl, d2W/dl2
  double energy_by_rest = 0;  // dW/dr [force]
  double force_by_rest = 0;   // d2W/dl dr [force/length]
};

class LineAccess {
 public:
  virtual ~LineAccess() = default;

  virtual double rest_length(int element) const = 0;  // 0: of constant force [length]

  // Gives the elements other rest lengths, all else about them unchanged: sections, moduli, and the rounding
  // of the onset as a share of the length. Pre: all of them are positive, one for each element.
  virtual void set_rest_lengths(const Vector& lengths) = 0;

  virtual LineState at(int element, double l) const = 0;
};

// nullptr for a term that is not one of cables (linear or of any law) or tethers. The term must outlive it.
std::unique_ptr<LineAccess> line_access(EnergyTerm& term);

// Distance of the two nodes of an element [length].
double line_length(const EnergyTerm& term, int element, const Points& x);

}  // namespace coapt
