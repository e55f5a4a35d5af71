// Adapters whose libraries take long to load: the minimisers of Ceres and NLopt and the factorisation of
// CHOLMOD. The command loads them when one is first asked for (modules/loaded_adapters.cpp); other programs
// link them (modules/linked_adapters.cpp).
#pragma once

#include "optim/bounded_minimiser.hpp"
#include "optim/solver.hpp"

namespace coapt::cli {

// Those that the build has, by their names.
void add_adapters(SolverTable& solvers);
void add_adapters(FactorisationTable& factorisations);
void add_adapters(BoundedMinimiserTable& minimisers);

}  // namespace coapt::cli
