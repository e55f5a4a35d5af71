// Whether an equilibrium is a minimum: the signs of the eigenvalues of its Hessian.
#pragma once

#include "optim/factorisation.hpp"

#include <string_view>
#include <vector>

namespace coapt {

enum class Stability {
  NotKnown,       // not asked for, or not judged
  StrictMinimum,  // all eigenvalues are positive
  Flat,           // none is negative, some are zero: to second order the shape is not unique
  Saddle,         // some are negative
  NothingToJudge  // no coordinate is free, or none that is has any stiffness
};

std::string_view stability_name(Stability stability);  // "strict_minimum", "flat", ...

struct StabilityOptions {
  FactorisationFactory factorisation;  // empty: nothing is judged
  int modes = 0;                       // smallest eigenvalues wanted
  bool finds_descent = true;           // whether a saddle gets its way down
  int most_unknowns = 30000;           // beyond these modes are not counted: that takes a slow factorisation
};

struct StabilityReport {
  Stability verdict = Stability::NotKnown;

  // Of the Cholesky factor of a strict minimum: smallest over largest pivot (see Factorisation).
  double pivot_ratio = 0;

  // Numbers of eigenvalues that are zero and negative; -1: not counted.
  int zero_modes = 0, negative_modes = 0;

  // Nodes on which nothing acts and that resist nothing, such as junctions of slack chords. They are left
  // out of everything else here.
  int loose_nodes = 0;

  Vector smallest;   // eigenvalues, ascending [force/length]; empty: not asked for, or without Spectra
  Vector descent;    // of a saddle: a direction of negative curvature, unit length; empty: none was found
  double scale = 0;  // mean of the diagonal [force/length]
  int factorisations = 0;
};

// lower: the Hessian as Factorisation wants it, a unit row for each prescribed coordinate.
// is_prescribed: for each unknown. noise [force/length]: eigenvalues below count as zero, as do those below
// 1e-11 of the mean of the diagonal. One factorisation where the Hessian is positive definite.
StabilityReport judge_stability(const SparseMatrix& lower, const std::vector<bool>& is_prescribed,
                                double noise, const StabilityOptions& options);

}  // namespace coapt
