// The elements of a term as lines between two nodes, whatever their law.
#pragma once

#include "energy/term_access.hpp"

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
  // Pre: access.has_rest_lengths(). Both must outlive it.
  LineAccess(const EnergyTerm& term, TermAccess& access) : term_(term), access_(access) {}

  double rest_length(int element) const { return access_.line(element).length; }  // 0: of constant force

  // Gives the elements other rest lengths, all else about them unchanged: sections, moduli, and the rounding
  // of the onset as a share of the length. Pre: all of them are positive, one for each element.
  void set_rest_lengths(const Vector& lengths);

  LineState at(int element, double l) const;

 private:
  const EnergyTerm& term_;
  TermAccess& access_;
};

// nullptr for a term that is not one of cables (linear or of any law) or tethers. The term must outlive it.
std::unique_ptr<LineAccess> line_access(EnergyTerm& term);

// Distance of the two nodes of an element [length].
double line_length(const EnergyTerm& term, int element, const Points& x);

}  // namespace coapt
