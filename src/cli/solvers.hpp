// The solvers and judges of this build of the command.
#pragma once

#include "mesh/distance/intersections.hpp"
#include "optim/bounded_minimiser.hpp"
#include "optim/solver.hpp"

namespace coapt::cli {

SolverTable all_solvers();
FactorisationTable all_factorisations();
BoundedMinimiserTable all_minimisers();

// The most independent one of this build: CGAL where it is in.
IntersectionChecker intersection_checker();

}  // namespace coapt::cli
