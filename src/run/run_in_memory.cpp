#include "core/error.hpp"
#include "run/run_parts.hpp"
#include "scene/build/build.hpp"
#include "scene/build/build_parts.hpp"

namespace coapt {

Points relative_start(const Eigen::Map<const Points>& start, const Model& model) {
  if (start.cols() != model.X.cols())
    throw InputError("start: has " + std::to_string(start.cols()) + " nodes; the scene has " +
                     std::to_string(model.X.cols()));
  if (!start.allFinite()) throw InputError("start: holds a coordinate that is not finite");
  return start.colwise() - model.origin;
}

SolveSetup given_setup(const Scene& scene, const Given& given, const SolverTable& solvers,
                       const RunOptions& options) {
  if (given.terms && scene.solver.cascade)
    throw InputError(scene.file.string() +
                     ": solver.cascade: the terms that are given know the scene's own mesh alone; leave the "
                     "cascade out");
  SolveSetup setup = solve_setup(scene, solvers, options);
  if (!given.has_hessians) setup.stability = {};
  return setup;
}

SceneGeometry given_geometry(const Scene& scene, Given& given) {
  return given.mesh ? scene_geometry(scene, std::move(*given.mesh)) : scene_geometry(scene);
}

RunReport run(const Scene& scene, Given given, const SolverTable& solvers, const RunOptions& options) {
  SolveSetup setup = given_setup(scene, given, solvers, options);
  const SceneGeometry geometry = given_geometry(scene, given);
  RunReport run;
  run.model = build(scene, geometry, given.terms);
  if (given.observer) setup.observer = given.observer(run.model);
  std::optional<Points> start;
  if (given.start) start = relative_start(*given.start, run.model);
  run.folder = open_result_folder(scene, options);
  run.report =
      run_built(scene, geometry, std::move(setup), options, run.model, run.folder, start ? &*start : nullptr);
  return run;
}

}  // namespace coapt
