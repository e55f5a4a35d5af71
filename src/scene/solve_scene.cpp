#include "scene/solve_scene.hpp"

#include "core/error.hpp"
#include "scene/build.hpp"
#include "scene/suggestion.hpp"

#include <cmath>

namespace coapt {
namespace {

FactorisationFactory chosen_factorisation(const FactorisationTable& table, const std::string& name) {
  if (name == "auto") return table.contains("cholmod") ? table.at("cholmod") : make_eigen_factorisation;
  if (const auto found = table.find(name); found != table.end()) return found->second;
  throw InputError("factorisation \"" + name + "\" is not in this build; use \"auto\" or \"eigen\"");
}

SolverFactory chosen_solver(const SolverTable& solvers, const std::string& name) {
  const auto found = solvers.find(name);
  if (found == solvers.end()) {
    std::vector<std::string> known;
    for (const auto& [key, factory] : solvers) known.push_back(key);
    throw InputError("solver \"" + name + "\" is not known" + suggestion(name, known) +
                     "; this build has: " + listed(known));
  }
  return found->second;
}

StopRule stop_rule(const Scene& scene, const RunOptions& options) {
  StopRule stop;
  stop.tolerance = options.tolerance.value_or(scene.solver.tolerance);
  stop.max_iterations = scene.solver.max_iterations;
  const double seconds = options.max_seconds.value_or(scene.solver.max_seconds);
  stop.max_seconds = seconds > 0 ? seconds : kInfinity;
  if (!(stop.tolerance > 0 && stop.tolerance <= 1))
    throw InputError("--tolerance: must be above 0 and at most 1, a residual relative to the largest force");
  if (std::isnan(seconds)) throw InputError("--max-seconds: must be a number of seconds");
  return stop;
}

}  // namespace

SolveSetup solve_setup(const Scene& scene, const SolverTable& solvers, const RunOptions& options) {
  SolveSetup setup;
  setup.solver = options.solver.empty() ? scene.solver.type : options.solver;
  const FactorisationFactory factorisation =
      chosen_factorisation(options.factorisations, scene.solver.factorisation);
  const SolverOptions solver_options{scene.solver.memory, scene.solver.is_preconditioned,
                                     scene.solver.globalisation, factorisation};
  setup.make_solver = [factory = chosen_solver(solvers, setup.solver), solver_options] {
    return factory(solver_options);
  };
  setup.stop = stop_rule(scene, options);
  setup.stability = {factorisation, options.modes.value_or(scene.solver.modes)};
  setup.observer = options.observer;
  return setup;
}

CascadeOutcome solve_scene(const Scene& scene, const Groundwork& ground, Model& model,
                           const SolveSetup& setup) {
  if (scene.solver.cascade)
    return solve_cascade(scene, ground, model, setup.make_solver, setup.stop, setup.observer,
                         setup.stability);
  CascadeOutcome outcome;
  outcome.result =
      solve(*setup.make_solver(),
            {*model.objective, model.q0, model.motion, scene.solver.continuation, setup.stability},
            setup.stop, setup.observer);
  return outcome;
}

Result solve_again(const Points& x, Model& model, const SolveSetup& setup) {
  Problem problem = problem_at(x, model);
  problem.stability = setup.stability;
  return solve(*setup.make_solver(), problem, setup.stop, setup.observer);
}

}  // namespace coapt
