#include "cli/adapters.hpp"

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

void add_adapters([[maybe_unused]] SolverTable& solvers) {
#ifdef COAPT_HAS_CERES
  add_ceres_solver(solvers);
#endif
#ifdef COAPT_HAS_NLOPT
  add_nlopt_solver(solvers);
#endif
}

void add_adapters([[maybe_unused]] FactorisationTable& factorisations) {
#ifdef COAPT_HAS_CHOLMOD
  factorisations["cholmod"] = [] { return make_cholmod_factorisation(); };
#endif
}

void add_adapters([[maybe_unused]] BoundedMinimiserTable& minimisers) {
#ifdef COAPT_HAS_CERES
  add_ceres_minimiser(minimisers);
#endif
#ifdef COAPT_HAS_NLOPT
  add_nlopt_minimisers(minimisers);
#endif
}

}  // namespace coapt::cli
