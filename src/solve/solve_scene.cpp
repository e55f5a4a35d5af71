#include "solve/solve_scene.hpp"

#include "core/error.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/build/build.hpp"
#include "scene/build/masses.hpp"
#include "scene/build/xpbd_body.hpp"
#include "scene/terms/term_types.hpp"
#include "xpbd/solver_xpbd.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kCollisionDistance = 0.3;  // of dynamics, over the mean edge length

FactorisationFactory named_factorisation(const FactorisationTable& table, const std::string& name) {
  if (name == "auto") return make_multifrontal_factorisation;
  if (const auto found = table.find(name); found != table.end()) return found->second;
  throw InputError("factorisation \"" + name +
                   "\" is not in this build; use \"auto\", \"multifrontal\" or \"eigen\"");
}

// Those made by it share one team of threads, one order and memory, as they work one after the other.
FactorisationFactory chosen_factorisation(const FactorisationTable& table, const SolverSpec& solver,
                                          const std::shared_ptr<LastFactor>& last) {
  return [make = named_factorisation(table, solver.factorisation),
          team = std::make_shared<ThreadTeam>(thread_count(solver)), last] {
    std::unique_ptr<Factorisation> factorisation = make();
    factorisation->use_threads(team);
    factorisation->share(last);
    return factorisation;
  };
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

// What the scene says of the method, and what the method may ask of the body that it moves.
SolverOptions solver_options(const SolverSpec& spec, const std::vector<TermSpec>& terms,
                             const FactorisationFactory& factorisation,
                             const std::shared_ptr<LastFactor>& last_factor, const Model& model) {
  SolverOptions options{static_cast<const MethodOptions&>(spec)};
  options.factorisation = factorisation;
  options.last_factor = last_factor;
  if (options.dynamic.collision_distance == 0 && model.mesh.triangle_count() > 0)
    options.dynamic.collision_distance =
        kCollisionDistance * mean_edge_length(model.mesh.vertices, model.mesh.triangles);
  options.surface = [&model] { return TriangleMesh{model.X, model.mesh.triangles, {}, {}}; };
  options.masses = [&model, density = spec.density] { return lumped_masses(model, density); };
  options.xpbd_body = [&model, terms] { return xpbd_body(model, terms); };
  options.membranes = [terms] {
    std::vector<std::string> names;
    for (const TermSpec& term : terms)
      if (is_membrane(term)) names.push_back("\"" + term.name + "\" (" + term.type + ")");
    return names;
  };
  return options;
}

StopRule stop_rule(const Scene& scene, const RunOptions& options) {
  StopRule stop = static_cast<const StopRule&>(scene.solver);
  stop.tolerance = options.tolerance.value_or(stop.tolerance);
  const double seconds = options.max_seconds.value_or(stop.max_seconds);
  stop.max_seconds = seconds > 0 ? seconds : kInfinity;
  if (!(stop.tolerance > 0 && stop.tolerance <= 1))
    throw InputError("--tolerance: must be above 0 and at most 1, a residual relative to the largest force");
  if (std::isnan(seconds)) throw InputError("--max-seconds: must be a number of seconds");
  return stop;
}

Continuation chosen_continuation(const Scene& scene, const RunOptions& options) {
  Continuation chosen = scene.solver.continuation;
  if (!options.damped_steps) return chosen;
  if (*options.damped_steps < 0)
    throw InputError("--damped-steps: must be a number of steps, or 0 for a solve at once");
  if (*options.damped_steps > 0 && std::max(chosen.load_steps, chosen.stiffness_steps) > 1)
    throw InputError("--damped-steps: raise the loads themselves, as do load_steps and stiffness_steps in " +
                     scene.file.string() + "; leave these out, or --damped-steps");
  chosen.damped_steps = *options.damped_steps;
  return chosen;
}

}  // namespace

SolverTable scene_solvers() {
  SolverTable solvers = built_in_solvers();
  add_xpbd_solver(solvers);
  return solvers;
}

SolveSetup solve_setup(const Scene& scene, const SolverTable& solvers, const RunOptions& options) {
  SolveSetup setup;
  setup.solver = options.solver.empty() ? scene.solver.type : options.solver;
  setup.last_factor = std::make_shared<LastFactor>();
  const FactorisationFactory factorisation =
      chosen_factorisation(options.factorisations, scene.solver, setup.last_factor);
  setup.make_solver = [make = chosen_solver(solvers, setup.solver), spec = scene.solver, terms = scene.terms,
                       factorisation, last = setup.last_factor](const Model& model) {
    return make(solver_options(spec, terms, factorisation, last, model));
  };
  setup.stop = stop_rule(scene, options);
  setup.continuation = chosen_continuation(scene, options);
  setup.factorisation = factorisation;
  setup.stability = {factorisation, options.modes.value_or(scene.solver.modes)};
  if (options.phase) setup.stability.begins = [phase = options.phase] { phase({.name = "certificate"}); };
  setup.observer = options.observer;
  setup.phase = options.phase;
  return setup;
}

namespace {

Result solved(const Problem& problem, const Model& model, const SolveSetup& setup) {
  if (setup.phase) setup.phase({.tolerance = setup.stop.tolerance});
  Result result = solve(*setup.make_solver(model), problem, setup.stop, setup.observer);
  *setup.last_factor = {};  // measuring takes as much memory, and the next solve begins as the first
  return result;
}

}  // namespace

CascadeOutcome solve_scene(const Scene& scene, const SceneGeometry& geometry, Model& model,
                           const SolveSetup& setup) {
  CascadeOutcome outcome;
  if (!scene.solver.cascade) {
    outcome.result =
        solved({*model.objective, model.q0, model.motion, setup.continuation, setup.stability}, model, setup);
    return outcome;
  }
  outcome = solve_cascade(scene, geometry, model, setup.make_solver, setup.stop, setup.continuation,
                          setup.observer, setup.stability, setup.phase);
  *setup.last_factor = {};
  return outcome;
}

Result solve_along_path(const Points& x, Model& model, const SolveSetup& setup) {
  Objective& objective = *model.objective;
  objective.prescribe(model.X);
  return solved({objective, objective.unknowns(x), model.motion, setup.continuation, setup.stability}, model,
                setup);
}

Result solve_again(const Points& x, Model& model, const SolveSetup& setup) {
  Problem problem = problem_at(x, model);
  problem.stability = setup.stability;
  return solved(problem, model, setup);
}

}  // namespace coapt
