// Every minimiser within bounds that the build has.
#pragma once

#include "optim/bounded_minimiser.hpp"

#ifdef COAPT_HAS_CERES
#include "optim/ceres/ceres_least_squares.hpp"
#endif
#ifdef COAPT_HAS_NLOPT
#include "optim/nlopt/nlopt_minimisers.hpp"
#endif

namespace coapt {

inline BoundedMinimiserTable minimisers() {
  BoundedMinimiserTable table = built_in_minimisers();
#ifdef COAPT_HAS_CERES
  add_ceres_minimiser(table);
#endif
#ifdef COAPT_HAS_NLOPT
  add_nlopt_minimisers(table);
#endif
  return table;
}

}  // namespace coapt
