#include "cli/adapters.hpp"
#include "cli/modules/module.hpp"

#include <initializer_list>
#include <string>

namespace coapt::cli {
namespace {

// Under each name a factory that asks for the one of the module.
template <typename Table>
void add(Table& table, void (*Module::*fill)(Table&), std::initializer_list<std::string> names) {
  for (const std::string& name : names)
    table[name] = [fill, name](const auto&... options) {
      Table adapted;
      (loaded_module(COAPT_ADAPTERS_FILE).*fill)(adapted);
      return adapted.at(name)(options...);
    };
}

}  // namespace

void add_adapters([[maybe_unused]] SolverTable& solvers) {
#ifdef COAPT_HAS_CERES
  add(solvers, &Module::add_solvers, {"ceres"});
#endif
#ifdef COAPT_HAS_NLOPT
  add(solvers, &Module::add_solvers, {"nlopt"});
#endif
}

void add_adapters([[maybe_unused]] FactorisationTable& factorisations) {
#ifdef COAPT_HAS_CHOLMOD
  add(factorisations, &Module::add_factorisations, {"cholmod"});
#endif
}

void add_adapters([[maybe_unused]] BoundedMinimiserTable& minimisers) {
#ifdef COAPT_HAS_CERES
  add(minimisers, &Module::add_minimisers, {"ceres"});
#endif
#ifdef COAPT_HAS_NLOPT
  add(minimisers, &Module::add_minimisers, {"slsqp", "mma", "lbfgs", "cobyla"});
#endif
}

}  // namespace coapt::cli
