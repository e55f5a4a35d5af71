#include "cli/solvers.hpp"

#include "solve/solve_scene.hpp"

#ifdef COAPT_HAS_CGAL
#include "mesh/cgal/intersections_cgal.hpp"
#endif
#ifdef COAPT_HAS_CERES
#include "optim/ceres/ceres_least_squares.hpp"
#include "optim/ceres/ceres_solver.hpp"
#endif
#ifdef COAPT_HAS_CHOLMOD
#include "optim/cholmod/cholmod_factorisation.hpp"
#endif
#ifdef COAPT_HAS_NLOPT
#include "optim/nlopt/nlopt_minimisers.hpp"
#include "optim/nlopt/nlopt_solver.hpp"
#endif

namespace coapt::cli {

SolverTable all_solvers() {
  SolverTable solvers = scene_solvers();
#ifdef COAPT_HAS_CERES
  add_ceres_solver(solvers);
#endif
#ifdef COAPT_HAS_NLOPT
  add_nlopt_solver(solvers);
#endif
  return solvers;
}

FactorisationTable all_factorisations() {
  FactorisationTable table = built_in_factorisations();
#ifdef COAPT_HAS_CHOLMOD
  table["cholmod"] = [] { return make_cholmod_factorisation(); };
#endif
  return table;
}

BoundedMinimiserTable all_minimisers() {
  BoundedMinimiserTable table = built_in_minimisers();
#ifdef COAPT_HAS_CERES
  add_ceres_minimiser(table);
#endif
#ifdef COAPT_HAS_NLOPT
  add_nlopt_minimisers(table);
#endif
  return table;
}

IntersectionChecker intersection_checker() {
#ifdef COAPT_HAS_CGAL
  return {"cgal", intersecting_pairs_cgal};
#else
  return {};
#endif
}

}  // namespace coapt::cli
