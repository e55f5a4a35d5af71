// Solves a scene: from its own start, or again from a shape near the equilibrium.
#pragma once

#include "linear/last_factor.hpp"
#include "solve/cascade.hpp"
#include "solve/run_options.hpp"

namespace coapt {

// The solvers that a scene may name without an adapter: built_in_solvers() and "xpbd".
SolverTable scene_solvers();

// Method, stop rule and certificate, as the scene and the options together want them.
struct SolveSetup {
  std::string solver;  // name
  SolverMaker make_solver;
  StopRule stop;
  Continuation continuation;
  FactorisationFactory factorisation;          // of the scene
  std::shared_ptr<LastFactor> last_factor;     // that its factorisations share; empty after a solve
  StabilityOptions stability;                  // the same, which tells `phase` of the certificate
  Observer observer;                           // may be empty
  std::function<void(const RunPhase&)> phase;  // likewise
};

// Throws InputError for a solver that is not in the table (listing those that are), a factorisation that is
// not in the build, a stop rule without meaning, or damped steps that are negative or that the scene's own
// continuation does not go with.
SolveSetup solve_setup(const Scene& scene, const SolverTable& solvers, const RunOptions& options);

// From the scene's own start, by the cascade where the scene wants one; levels are empty where it does not.
// geometry, model: of the scene's own mesh.
CascadeOutcome solve_scene(const Scene& scene, const SceneGeometry& geometry, Model& model,
                           const SolveSetup& setup);

// Along the model's own motion and the continuation of the setup on this mesh alone, from the free
// coordinates of x (3 x node_count) and the supports where their motion begins.
Result solve_along_path(const Points& x, Model& model, const SolveSetup& setup);

// From x (3 x node_count), with the supports where their motion ends.
Result solve_again(const Points& x, Model& model, const SolveSetup& setup);

}  // namespace coapt
