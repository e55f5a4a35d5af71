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

std::optional<ShownSolve> bench_shown(const BenchCourse& course, const SceneGeometry& ground,
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
    once.model = build(scene, ground);
    const bool has_page = wants_page(scene, options);
    SolvedRun solved = solve_run(scene, ground, once.model, setup, has_page);
    options.writes = false;
    once.report =
        measure_run(scene, setup, once.model, std::move(solved), {.has_page = has_page}, options.judge);
    if (once.report.result.status == Status::Converged)
      search_branches(scene, course.solvers, options, course.options.branches, once);
    found.branches = once.report.branches;
  } catch (const std::exception&) {  // the end of the method says why
    return std::nullopt;
  }
  ShownSolve shown = shown_solve(method + " on " + mesh_text(found.meshes.front()) + " to a residual of " +
                                     page_number(*options.tolerance) +
                                     ", solved once more beside the clock to keep its iterates.",
                                 once.model, once.report);
  shown.view.name = "benchmark";
  if (finer != nullptr)
    shown.view.fields.insert(shown.view.fields.begin(), mesh_error(once.model, once.report.fields.x, *finer));
  return shown;
}

}  // namespace coapt
