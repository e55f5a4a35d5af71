// Whether an equilibrium is stable: the signs of the eigenvalues of its tangent.
#pragma once

#include "linear/factorisation.hpp"
#include "linear/free_directions.hpp"

#include <complex>
#include <functional>
#include <string_view>
#include <vector>

namespace coapt {

// Without a skew part the tangent is the Hessian of the energy; with one it is that of a load without
// potential, and stable is what comes back along the way that its forces drive it.
enum class Stability {
  NotKnown,        // not asked for, or not checked
  StrictMinimum,   // all eigenvalues of the (symmetric part of the) tangent are positive
  Stable,          // those of the symmetric part are not, yet all of the tangent have positive real parts
  Flat,            // none is negative, some are zero: to second order the shape is not unique
  Saddle,          // of an energy: some are negative
  Divergence,      // a real eigenvalue of the tangent is negative: the shape leaves along its mode
  Flutter,         // none but complex ones have negative real parts: the shape spirals away
  NotDecided,      // the symmetric part has negative eigenvalues, and the others could not be found
  NothingToCheck,  // no coordinate is free, or none that is has any stiffness
};

std::string_view stability_name(Stability stability);  // "strict_minimum", "flat", ...

// Whether the shape is known to leave the equilibrium.
bool is_unstable(Stability stability);

struct StabilityOptions {
  FactorisationFactory factorisation;  // empty: nothing is checked
  int modes = 0;                       // smallest eigenvalues wanted
  bool finds_descent = true;           // whether an unstable state gets its way out
  int most_unknowns = 30000;           // beyond these modes are not counted: that takes a slow factorisation
  std::function<void()> begins = {};   // told when the certificate of a result sets about it
};

struct StabilityReport {
  Stability verdict = Stability::NotKnown;

  // Of the Cholesky factor of a strict minimum: smallest over largest pivot (see Factorisation).
  double pivot_ratio = 0;

  // Numbers of eigenvalues that are zero and, of the symmetric part, negative; -1: not counted. Free
  // directions are left out of both.
  int zero_modes = 0, negative_modes = 0;

  // Directions of single nodes that cost nothing (free_directions.hpp). They are left out of everything
  // else here: the verdict is that of the rest. Loose nodes have no other directions.
  int free_directions = 0, loose_nodes = 0;

  // Blocks of three unknowns with free directions or that zero modes move, ascending: where they are is not
  // determined.
  std::vector<int> free_blocks;

  // Of a tangent with a skew part that was looked at as a whole: eigenvalues with a negative real part, and
  // of all that were found the one with the lowest [force/length]; others above -zero may be lower.
  bool is_tangent_checked = false;
  int unstable_modes = 0;
  std::complex<double> lowest;

  Vector smallest;   // eigenvalues, ascending [force/length]; empty: not asked for, or without Spectra
  Vector descent;    // the way out of a saddle or a divergence, unit length; empty: none was found
  double scale = 0;  // mean of the diagonal [force/length]
  int factorisations = 0;
};

// lower: the symmetric part of the tangent as Factorisation wants it, a unit row for each prescribed
// coordinate. skew: its other part; empty for an energy. is_prescribed: for each unknown. zero
// [force/length]: real parts of no greater magnitude count as zero, as do those that round-off hides. One
// factorisation where the symmetric part is positive definite.
StabilityReport classify_stability(const SparseMatrix& lower, const SkewProduct& skew,
                                   const std::vector<bool>& is_prescribed, double zero,
                                   const StabilityOptions& options);

}  // namespace coapt
