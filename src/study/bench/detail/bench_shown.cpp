#include "study/bench/detail/bench_shown.hpp"

#include "run/run_parts.hpp"
#include "scene/build/build.hpp"
#include "study/bench/benchmark_summary.hpp"
#include "study/detail/method_list.hpp"

namespace coapt {
namespace {

double tightest_reached(const Benchmark& found) {
  double tolerance = found.tolerances.front();
  for (const BenchRun& run : found.runs)
    if (run.method == 0 && run.mesh == 0 && run.status == Status::Converged) tolerance = run.tolerance;
  return tolerance;
}

ViewField mesh_error(const Model& model, const Points& x, const TriangleMesh& finer) {
  Vector distance;
  reference_distance(surface_at(model, x), finer, distance);
  return {.title = "Distance to the equilibrium on " + mesh_text({.triangles = finer.triangle_count()}),
          .unit = "mm",
          .values = {distance}};
}

}  // namespace

std::optional<ShownSolve> bench_shown(const BenchCourse& course, const SceneGeometry& geometry,
                                      const TriangleMesh* finer, Benchmark& found) {
  const std::string& method = found.methods.front().name;
  RunOptions options = course.run;
  options.solver = method;
  options.tolerance = tightest_reached(found);
  options.writes_page = true;
  RunReport once;
  try {
    const Scene scene = scene_of(method, course.scene);
    const SolveSetup setup = solve_setup(scene, course.solvers, options);
    once.model = build(scene, geometry);
    once.report = run_built(scene, geometry, setup, options, once.model, {});
    if (once.report.result.status == Status::Converged)
      once.report = with_branches(scene, course.solvers, options, course.options.branches, once.model,
                                  std::move(once.report), {});
    found.branches = once.report.branches;
  } catch (const std::exception&) {  // the end of the method says why
    return std::nullopt;
  }
  ShownSolve shown = shown_solve(method + " on " + mesh_text(found.meshes.front()) + " to a residual of " +
                                     page_number(*options.tolerance) +
                                     ", solved once more beside the clock to keep its iterates.",
                                 once.model, once.report);
  shown.view.name = "benchmark";
  if (finer != nullptr) shown.view.fields.push_back(mesh_error(once.model, once.report.fields.x, *finer));
  return shown;
}

}  // namespace coapt
