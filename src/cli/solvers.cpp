#include "cli/solvers.hpp"

#ifdef COAPT_HAS_CERES
#include "optim/ceres/ceres_solver.hpp"
#endif
#ifdef COAPT_HAS_NLOPT
#include "optim/nlopt/nlopt_solver.hpp"
#endif

namespace coapt::cli {

SolverTable all_solvers() {
  SolverTable solvers = built_in_solvers();
#ifdef COAPT_HAS_CERES
  add_ceres_solver(solvers);
#endif
#ifdef COAPT_HAS_NLOPT
  add_nlopt_solver(solvers);
#endif
  return solvers;
}

}  // namespace coapt::cli
