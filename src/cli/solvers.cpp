#include "cli/solvers.hpp"

#include "cli/adapters.hpp"
#include "solve/solve_scene.hpp"

#ifdef COAPT_HAS_CGAL
#include "mesh/cgal/intersections_cgal.hpp"
#endif

namespace coapt::cli {

SolverTable all_solvers() {
  SolverTable solvers = scene_solvers();
  add_adapters(solvers);
  return solvers;
}

FactorisationTable all_factorisations() {
  FactorisationTable table = built_in_factorisations();
  add_adapters(table);
  return table;
}

BoundedMinimiserTable all_minimisers() {
  BoundedMinimiserTable table = built_in_minimisers();
  add_adapters(table);
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
